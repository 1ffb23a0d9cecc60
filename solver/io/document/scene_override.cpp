// --set KEY=VALUE: changes of a scene's tree before it is checked.
#include <utf8.h>

#include "solver/io/common/errors.h"
#include "solver/io/document/scene_document.h"

namespace topple::io {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// A value that is not valid TOML is text: 50 kgf, rigid.
Node parse_value(const std::string& text, const Place& place) {
  Node value;
  bool understood = false;
  if (text.find('\n') == std::string::npos) {
    try {
      Node table = parse_toml("value = " + text, "");
      if (table.items.size() == 1) {
        value = std::move(table.items.front().value);
        understood = true;
      }
    } catch (const InputError&) {
    }
  }
  if (!understood) {
    value.kind = Node::Kind::text;
    value.text = text;
  }
  set_place(value, place);
  return value;
}

// The entry of the list `key` whose label `rest` begins with, and the label's length; names may contain dots,
// so the longest counts. One without a name is called "cabinet-2" in results.
Item* find_entry(Node& list, const std::string& key, const std::string& rest, std::size_t& length) {
  Item* found = nullptr;
  const auto consider = [&](const std::string& label, Item& entry) {
    const bool begins = rest.compare(0, label.size(), label) == 0 &&
                        (rest.size() == label.size() || rest[label.size()] == '.');
    if (begins && (!found || label.size() > length)) {
      found = &entry;
      length = label.size();
    }
  };
  for (std::size_t k = 0; k < list.items.size(); ++k) consider(entry_label(list, k), list.items[k]);
  for (const std::string& before : {std::string(), key + "-"})
    for (std::size_t k = 0; k < list.items.size() && !found; ++k)
      if (before.empty() || !list.items[k].value.find("name"))
        consider(before + std::to_string(k + 1), list.items[k]);
  return found;
}

std::string labels(const Node& list) {
  if (list.items.empty()) return "it has no entries";
  std::string text = "known: ";
  for (std::size_t k = 0; k < list.items.size(); ++k) text += (k ? ", " : "") + entry_label(list, k);
  return text;
}

}  // namespace

void apply_override(Node& root, const std::string& override_text) {
  const Place place{0, 0, std::make_shared<const std::string>(override_text)};
  if (!utf8::is_valid(override_text)) fail("", place, "", "is not UTF-8");
  const auto equals = override_text.find('=');
  std::string rest = trimmed(override_text.substr(0, equals));
  if (equals == std::string::npos || rest.empty()) {
    fail("", place, "", "expected KEY=VALUE, such as contact.friction=0.5");
  }

  Node value = parse_value(trimmed(override_text.substr(equals + 1)), place);
  Node* at = &root;
  std::string path;
  for (;;) {
    std::size_t length = rest.find('.');
    if (length == std::string::npos) length = rest.size();
    Item* next = nullptr;
    if (at->kind == Node::Kind::list) {
      next = find_entry(*at, path, rest, length);
      if (!next) fail("", place, path + "." + rest.substr(0, length), "no such entry; " + labels(*at));
    } else if (at->kind != Node::Kind::table) {
      fail("", place, path, "is " + std::string(kind_name(at->kind)) + " and has no keys");
    } else if (length == 0) {
      fail("", place, path, "expected KEY=VALUE with names between the dots");
    } else if (next = at->find_item(rest.substr(0, length)); !next) {
      Node table;
      table.place = place;
      at->items.push_back({rest.substr(0, length), place, std::move(table)});
      next = &at->items.back();
    }
    path += (path.empty() ? "" : ".") + rest.substr(0, length);
    if (length >= rest.size()) {
      if (at->kind == Node::Kind::list && next->value.kind == Node::Kind::table &&
          value.kind != Node::Kind::table) {
        fail("", place, path,
             "is a whole entry; set one of its keys, or all of them: " + path + "={ KEY = VALUE, ... }");
      }
      next->key_place = place;
      next->value = std::move(value);
      return;
    }
    at = &next->value;
    rest.erase(0, length + 1);
  }
}

void change(Node& root, const std::vector<std::string>& overrides) {
  const auto title = [&root]() -> std::string {
    const Node* const found = root.find("title");
    return found && found->kind == Node::Kind::text ? found->text : "";
  };
  const std::string before = title();
  for (const std::string& change : overrides) apply_override(root, change);
  if (!overrides.empty() && !before.empty() && title() == before && !before.ends_with(k_title_changed))
    root.find_item("title")->value.text += k_title_changed;
}

}  // namespace topple::io
