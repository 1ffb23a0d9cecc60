#include "solver/io/scene/scene_check.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "solver/io/common/nearest_name.h"
#include "solver/io/scene/scene_keys.h"

namespace topple::io {
namespace {

bool contains(const std::vector<std::string_view>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string joined(const std::vector<std::string_view>& words, std::string_view between = ", ") {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += between;
    text += word;
  }
  return text;
}

/// "; the nearest is law"; empty: none is near.
std::string nearest_in_words(std::string_view word, const std::vector<std::string_view>& known) {
  const std::string nearest = nearest_name(word, {known.begin(), known.end()});
  return nearest.empty() ? "" : "; the nearest is " + nearest;
}

std::string below(const std::string& path, std::string_view name) {
  return (path.empty() ? "" : path + ".") + std::string(name);
}

std::string expected_quantity(const Key& key) {
  std::string text = "expected " + std::string(dimension_name(key.dimension));
  if (key.dimension != Dimension::none) text += " (" + unit_list(key.dimension) + ")";
  if (!key.choices.empty()) text += " or one of " + joined(key.choices);
  return text;
}

class Checker {
 public:
  Checker(const Node& root, const std::string& origin) : origin_(origin) {
    const Key& key = *find_key("run", "analysis");
    const Node* run = root.find(key.table);
    analysis_ = chosen(key, run ? *run : Node{});
  }

  void table(const Node& node, std::string_view name, const std::string& path) const {
    for (const Item& item : node.items) {
      const Key& key = known(item, name, path);
      if (key.type == KeyType::choice) value(key, item.value, below(path, item.key));
    }
    for (const Item& item : node.items) value(*find_key(name, item.key), item.value, below(path, item.key));
    for (const Item& item : node.items)
      // what a body of furniture chose is known when its kind is
      if (const Key& key = *find_key(name, item.key); key.table == name) belongs(key, node, item, path);
    for (const Key& key : scene_keys()) {
      if (key.table != name || !key.required || node.find(key.name) || !applies(key, node)) continue;
      std::string message = "missing";
      if (!key.of.empty())
        message += "; " + std::string(key.of) + " = \"" + chosen(choice_of(key), node) + "\" needs it";
      fail(node.place, below(path, key.name), message + " (" + std::string(key.about) + ")");
    }
  }

 private:
  [[noreturn]] void fail(const Place& place, const std::string& path, const std::string& message) const {
    io::fail(origin_, place, path, message);
  }

  const Key& known(const Item& item, std::string_view table, const std::string& path) const {
    const Key* key = find_key(table, item.key);
    if (!key) {
      std::vector<std::string_view> names;
      for (const Key& other : scene_keys()) {
        if (other.table == table) names.push_back(other.name);
      }
      std::sort(names.begin(), names.end());
      std::vector<std::string_view> meant = names;
      if (table == "furniture")
        for (const std::string_view body : k_furniture_bodies)
          for (const Key& other : scene_keys())
            if (other.table == body) meant.push_back(other.name);
      fail(item.key_place, below(path, item.key),
           "unknown key; known: " + joined(names) +
               (table == "furniture" ? ", and keys of the body that it becomes" : "") +
               nearest_in_words(item.key, meant));
    }
    return *key;
  }

  // The word at which a choice stands, written or by default.
  static std::string chosen(const Key& choice, const Node& table) {
    if (const Node* node = table.find(choice.name)) return node->is_number() ? shown(*node) : node->text;
    if (choice.type == KeyType::number) return default_text(choice);
    return choice.fallback.empty()
               ? ""
               : std::string(choice.choices[static_cast<std::size_t>(choice.fallback[0])]);
  }

  static const Key& choice_of(const Key& key) { return *find_key(key.table, key.of); }

  static bool applies(const Key& key, const Node& table) {
    return key.of.empty() || contains(key.when, chosen(choice_of(key), table));
  }

  // A word that is no analysis is told where it stands.
  bool serves_analysis(const Key& key) const {
    return key.analyses.empty() || contains(key.analyses, analysis_) ||
           !contains(find_key("run", "analysis")->choices, analysis_);
  }

  void belongs(const Key& key, const Node& table, const Item& item, const std::string& path) const {
    if (!serves_analysis(key))
      fail(item.key_place, below(path, item.key),
           "belongs to analysis = " + joined(key.analyses, " or ") + ", but analysis is " + analysis_);
    if (applies(key, table)) return;
    const std::string word = chosen(choice_of(key), table);
    const std::string of(key.of);
    fail(item.key_place, below(path, item.key),
         "belongs to " + of + " = " + joined(key.when, " or ") + ", but " + of +
             (word.empty() ? " is missing" : " is " + word));
  }

  void value(const Key& key, const Node& node, const std::string& path) const {
    switch (key.type) {
      case KeyType::number:
        return number(key, node, path);
      case KeyType::integer:
        return integer(key, node, path);
      case KeyType::boolean:
        if (node.kind != Node::Kind::boolean)
          fail(node.place, path, "expected true or false, found " + shown(node));
        return;
      case KeyType::text:
        return text(node, path);
      case KeyType::texts:
        list(node, path, 1, key.count);
        for_entries(node, path, [&](const Node& entry, const std::string& p) { text(entry, p); });
        return;
      case KeyType::choice:
        return word(key, node, path);
      case KeyType::choices:
        return words(key, node, path);
      case KeyType::numbers:
        return numbers(key, node, path);
      case KeyType::vectors:
        return vectors(key, node, path);
      case KeyType::integers:
        list(node, path, key.count, key.count);
        for_entries(node, path, [&](const Node& entry, const std::string& p) { integer(key, entry, p); });
        return;
      case KeyType::history:
        return history(key, node, path);
      case KeyType::table:
        if (node.kind != Node::Kind::table) {
          fail(node.place, path, "expected a table [" + path + "], found " + shown(node));
        }
        return table(node, nested_name(key), path);
      case KeyType::tables:
        return tables(key, node, path);
    }
  }

  // What the table of keys calls a table within a table.
  static std::string nested_name(const Key& key) {
    return (key.table.empty() ? "" : std::string(key.table) + ".") + std::string(key.name);
  }

  template <typename F>
  void for_entries(const Node& node, const std::string& path, F&& f) const {
    for (std::size_t k = 0; k < node.items.size(); ++k)
      f(node.items[k].value, below(path, std::to_string(k + 1)));
  }

  void range(const Key& key, const Node& node, double si, const std::string& path) const {
    // conversion of units may round the end of a range outwards
    const double slack = node.kind == Node::Kind::text ? 1e-12 : 0;
    if (si < key.least - slack * std::abs(key.least) || si > key.most + slack * std::abs(key.most)) {
      const bool bare = node.kind != Node::Kind::text && key.dimension != Dimension::none;
      fail(node.place, path,
           shown(node) + (bare ? " " + std::string(si_unit(key.dimension)) : "") + " is outside " +
               range_text(key));
    }
  }

  void number(const Key& key, const Node& node, const std::string& path) const {
    if (node.kind == Node::Kind::text) {
      if (contains(key.choices, node.text)) return;
      const Quantity quantity = parse_quantity(node.text, key.dimension);
      if (!quantity.si) fail(node.place, path, shown(node) + " " + quantity.problem);
      range(key, node, *quantity.si, path);
    } else if (node.is_number()) {
      if (!std::isfinite(node.real)) fail(node.place, path, shown(node) + " is not a finite number");
      range(key, node, node.real, path);
    } else {
      fail(node.place, path, expected_quantity(key) + ", found " + shown(node));
    }
  }

  void integer(const Key& key, const Node& node, const std::string& path) const {
    if (node.kind != Node::Kind::integer) fail(node.place, path, "expected an integer, found " + shown(node));
    range(key, node, node.real, path);
  }

  void text(const Node& node, const std::string& path) const {
    if (node.kind != Node::Kind::text) fail(node.place, path, "expected text, found " + shown(node));
    if (node.text.empty()) fail(node.place, path, "is empty");
    for (const char c : node.text) {
      if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7f) {
        fail(node.place, path, "contains a control character");
      }
    }
  }

  void word(const Key& key, const Node& node, const std::string& path) const {
    if (node.kind != Node::Kind::text) {
      fail(node.place, path, "expected one of " + joined(key.choices) + ", found " + shown(node));
    }
    if (!contains(key.choices, node.text)) {
      fail(node.place, path,
           shown(node) + " is not one of " + joined(key.choices) + nearest_in_words(node.text, key.choices));
    }
  }

  void words(const Key& key, const Node& node, const std::string& path) const {
    if (node.kind != Node::Kind::list || node.items.empty()) {
      fail(node.place, path,
           "expected a list of some of " + joined(key.choices) + ", found " +
               (node.kind == Node::Kind::list ? "an empty list" : shown(node)));
    }
    std::vector<std::string_view> seen;
    for_entries(node, path, [&](const Node& entry, const std::string& p) {
      word(key, entry, p);
      if (contains(seen, entry.text)) fail(entry.place, p, shown(entry) + " stands there twice");
      seen.push_back(entry.text);
    });
  }

  void list(const Node& node, const std::string& path, int least, int most) const {
    const std::string size = (least == most ? "" : std::to_string(least) + " to ") + std::to_string(most) +
                             (most == 1 ? " value" : " values");
    if (node.kind != Node::Kind::list)
      fail(node.place, path, "expected a list of " + size + ", found " + shown(node));
    const int found = static_cast<int>(node.items.size());
    if (found < least || found > most) {
      fail(node.place, path, "expected a list of " + size + ", found " + std::to_string(found));
    }
  }

  void numbers(const Key& key, const Node& node, const std::string& path) const {
    if (node.kind == Node::Kind::text && !key.choices.empty()) {
      if (contains(key.choices, node.text)) return;
      fail(node.place, path,
           shown(node) + " is not one of " + joined(key.choices) + ", nor a list of " +
               std::to_string(key.count) + " values" + nearest_in_words(node.text, key.choices));
    }
    if (key.least_count == 1 && (node.kind == Node::Kind::text || node.is_number()))
      return number(key, node, path);
    list(node, path, key.least_count ? key.least_count : key.count, key.count);
    Key plain = key;
    plain.choices.clear();
    for_entries(node, path, [&](const Node& entry, const std::string& p) { number(plain, entry, p); });
  }

  void vectors(const Key& key, const Node& node, const std::string& path) const {
    if (node.kind != Node::Kind::list || node.items.empty()) {
      fail(node.place, path,
           "expected a list of [x, y, z], found " +
               (node.kind == Node::Kind::list ? "an empty list" : shown(node)));
    }
    for_entries(node, path, [&](const Node& vector, const std::string& p) {
      list(vector, p, 3, 3);
      for_entries(vector, p, [&](const Node& entry, const std::string& q) { number(key, entry, q); });
    });
  }

  void history(const Key& key, const Node& node, const std::string& path) const {
    if (node.kind != Node::Kind::list || node.items.empty()) {
      fail(node.place, path,
           "expected a list of [time, factor], found " +
               (node.kind == Node::Kind::list ? "an empty list" : shown(node)));
    }
    Key time = key;
    time.dimension = Dimension::time;
    time.unit = "s";
    time.least = 0;
    double before = -1;
    for_entries(node, path, [&](const Node& pair, const std::string& p) {
      list(pair, p, 2, 2);
      const Node& first = pair.items[0].value;
      number(time, first, below(p, "1"));
      number(key, pair.items[1].value, below(p, "2"));
      const double t = first.is_number() ? first.real : *parse_quantity(first.text, Dimension::time).si;
      if (t <= before) fail(first.place, below(p, "1"), "times must increase, " + shown(first) + " does not");
      before = t;
    });
  }

  void tables(const Key& key, const Node& node, const std::string& path) const {
    const bool nested = !key.table.empty();
    const std::string expected = nested ? "expected a list of tables" : "expected [[" + path + "]]";
    if (!nested && node.place.override_text) {
      fail(node.place, path, "an override cannot add or replace a [[" + path + "]]");
    }
    if (node.kind != Node::Kind::list) fail(node.place, path, expected + ", found " + shown(node));
    const std::string name = nested_name(key);
    for (std::size_t k = 0; k < node.items.size(); ++k) {
      const Node& entry = node.items[k].value;
      const std::string of_entry = entry_path(node, path, k);
      if (entry.kind != Node::Kind::table)
        fail(entry.place, of_entry, "expected a table, found " + shown(entry));
      table(entry, name, of_entry);
    }
  }

  const std::string& origin_;
  std::string analysis_;
};

// Names are unique among the entries of these kinds together.
void check_names(const Node& root, const std::string& origin, const std::vector<std::string_view>& kinds,
                 std::map<std::string, Place> used) {
  for (const std::string_view kind : kinds) {
    const Node* list = root.find(kind);
    for (std::size_t k = 0; list && k < list->items.size(); ++k) {
      const Node& entry = list->items[k].value;
      const Node* written = entry.find("name");
      const Place& place = written ? written->place : entry.place;
      const std::string name = entry_name(*list, kind, k);
      const auto [first, fresh] = used.emplace(name, place);
      if (fresh) continue;
      std::string where;
      if (first->second.line > 0) where = ", first in line " + std::to_string(first->second.line);
      fail(origin, place, entry_path(*list, std::string(kind), k) + ".name",
           "\"" + name + "\" is used twice" + where);
    }
  }
}

}  // namespace

std::string entry_name(const Node& list, std::string_view kind, std::size_t index) {
  const Node* name = list.items[index].value.find("name");
  return name ? name->text : std::string(kind) + "-" + std::to_string(index + 1);
}

void check_scene(const Node& root, const std::string& origin) {
  const Key& schema = *find_key("", "topple");
  const Node* version = root.find("topple");
  if (!version)
    fail(origin, root.place, "topple", "missing; a scene says topple = 1, the version of its schema");
  if (version->kind != Node::Kind::integer) {
    fail(origin, version->place, "topple", "expected an integer, found " + shown(*version));
  }
  if (version->real < schema.least || version->real > schema.most) {
    fail(origin, version->place, "topple",
         "schema " + shown(*version) + " is not supported by this version, which reads schema " +
             short_number(schema.most));
  }
  Checker(root, origin).table(root, "", "");
  const Node* floor = root.find("floor");
  check_names(root, origin, {"shake"}, {});
  check_names(root, origin, {"wall"},
              floor ? std::map<std::string, Place>{{"floor", floor->place}} : std::map<std::string, Place>{});
  check_names(root, origin, {"material"}, {});
  check_names(root, origin, {"section"}, {});
  check_names(root, origin, {"cabinet", "frame", "block"}, {});
  check_names(root, origin, {"anchor", "fixing"}, {});
  check_names(root, origin, {"probe"}, {});
  check_names(root, origin, {"door"}, {});
  check_names(root, origin, {"place"}, {});
  check_names(root, origin, {"expect"}, {});
}

}  // namespace topple::io
