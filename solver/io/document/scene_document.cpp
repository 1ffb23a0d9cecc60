#include "solver/io/document/scene_document.h"

#include <utf8.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string_view>

// In every build type: a precondition of toml++ that a damaged text violates ends in an error, not in a
// crash. No other source includes it.
static constexpr void toml_assert(bool holds) {
  if (!holds) throw std::logic_error("toml++");
}
#undef NDEBUG
#define TOML_ASSERT(condition) toml_assert(static_cast<bool>(condition))
#include <toml++/toml.h>

#include "solver/io/common/digits.h"
#include "solver/io/common/errors.h"
#include "solver/io/document/toml_precheck.h"

namespace topple::io {
namespace {

Place place_of(const toml::source_region& source) {
  return {static_cast<int>(std::max<toml::source_index>(source.begin.line, 1)),
          static_cast<int>(std::max<toml::source_index>(source.begin.column, 1)), nullptr};
}

bool earlier(const Item& a, const Item& b) {
  if (a.key_place.line != b.key_place.line) return a.key_place.line < b.key_place.line;
  return a.key_place.column < b.key_place.column;
}

Node convert(const toml::node& source) {
  Node node;
  node.place = place_of(source.source());
  if (const auto* table = source.as_table()) {
    node.kind = Node::Kind::table;
    for (const auto& [key, value] : *table) {
      node.items.push_back({std::string(key.str()), place_of(key.source()), convert(value)});
    }
    // toml++ sorts by name; the first error is the first in the file
    std::stable_sort(node.items.begin(), node.items.end(), earlier);
  } else if (const auto* list = source.as_array()) {
    node.kind = Node::Kind::list;
    for (const toml::node& value : *list)
      node.items.push_back({{}, place_of(value.source()), convert(value)});
  } else if (const auto* text = source.as_string()) {
    node.kind = Node::Kind::text;
    node.text = text->get();
  } else if (const auto* integer = source.as_integer()) {
    node.kind = Node::Kind::integer;
    node.integer = integer->get();
    node.real = static_cast<double>(node.integer);
  } else if (const auto* real = source.as_floating_point()) {
    node.kind = Node::Kind::real;
    node.real = real->get();
  } else if (const auto* boolean = source.as_boolean()) {
    node.kind = Node::Kind::boolean;
    node.boolean = boolean->get();
  } else {
    node.kind = Node::Kind::date;
  }
  return node;
}

std::string without_control_characters(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", byte);
      line += escape;
    } else {
      line += c;
    }
  }
  return line;
}

std::string written_key(const std::string& key) {
  const auto bare = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !key.empty() && std::all_of(key.begin(), key.end(), bare) ? key : written_text(key);
}

std::string written_real(double value) {
  std::string result = shortest_digits(value);
  // TOML tells a real from an integer by these
  if (result.find_first_of(".en") == std::string::npos) result += ".0";
  return result;
}

std::string written(const Node& node) {
  switch (node.kind) {
    case Node::Kind::boolean:
      return node.boolean ? "true" : "false";
    case Node::Kind::integer:
      return std::to_string(node.integer);
    case Node::Kind::real:
      return written_real(node.real);
    case Node::Kind::text:
      return written_text(node.text);
    case Node::Kind::date:
      return "1970-01-01";  // no key takes one: a tree that passed the checks has none
    case Node::Kind::list:
    case Node::Kind::table:
      break;
  }
  const bool table = node.kind == Node::Kind::table;
  std::string result = table ? "{" : "[";
  for (const Item& item : node.items) {
    if (&item != &node.items.front()) result += ", ";
    if (table) result += written_key(item.key) + " = ";
    result += written(item.value);
  }
  return result + (table ? "}" : "]");
}

void write_keys(std::string& text, const Node& table) {
  for (const Item& item : table.items) text += written_key(item.key) + " = " + written(item.value) + "\n";
}

bool holds_tables(const Node& node) {
  return node.kind == Node::Kind::list && !node.items.empty() &&
         std::all_of(node.items.begin(), node.items.end(),
                     [](const Item& item) { return item.value.kind == Node::Kind::table; });
}

}  // namespace

std::string written_value(const Node& node) {
  return written(node);
}

std::string written_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", byte);
      result += escape;
    } else {
      result += c;
    }
  }
  return result + '"';
}

const Item* Node::find_item(std::string_view key) const {
  for (const Item& item : items) {
    if (item.key == key) return &item;
  }
  return nullptr;
}

const Node* Node::find(std::string_view key) const {
  const Item* item = find_item(key);
  return item ? &item->value : nullptr;
}

Item* Node::find_item(std::string_view key) {
  return const_cast<Item*>(static_cast<const Node&>(*this).find_item(key));
}

Node number_node(double value, const Place& place) {
  Node node;
  node.kind = Node::Kind::real;
  node.place = place;
  node.real = value;
  return node;
}

Node text_node(const std::string& text, const Place& place) {
  Node node;
  node.kind = Node::Kind::text;
  node.place = place;
  node.text = text;
  return node;
}

Node list_node(std::vector<Node> values, const Place& place) {
  Node node;
  node.kind = Node::Kind::list;
  node.place = place;
  for (Node& value : values) node.items.push_back({{}, place, std::move(value)});
  return node;
}

Node numbers_node(std::initializer_list<double> values, const Place& place) {
  std::vector<Node> nodes;
  for (const double value : values) nodes.push_back(number_node(value, place));
  return list_node(std::move(nodes), place);
}

void set_key(Node& table, std::string_view key, Node value) {
  if (Item* const item = table.find_item(key)) {
    item->key_place = value.place;
    item->value = std::move(value);
    return;
  }
  const Place place = value.place;
  table.items.push_back({std::string(key), place, std::move(value)});
}

void set_place(Node& node, const Place& place) {
  node.place = place;
  for (Item& item : node.items) {
    item.key_place = place;
    set_place(item.value, place);
  }
}

std::string error_line(const std::string& origin, const Place& place, const std::string& path,
                       const std::string& message) {
  std::string line = place.override_text
                         ? "--set " + *place.override_text
                         : (place.file ? *place.file : origin) + ":" + std::to_string(place.line) + ":" +
                               std::to_string(place.column);
  line += ": ";
  if (!path.empty()) line += path + ": ";
  return without_control_characters(line + message);
}

void fail(const std::string& origin, const Place& place, const std::string& path,
          const std::string& message) {
  throw SceneError(origin, place, path, message);
}

namespace {

// What a line of TOML that could not be read most often lacks; empty when it is not that.
std::string missing_quotes(std::string_view text, int line) {
  for (; line > 1 && text.find('\n') != text.npos; --line) text.remove_prefix(text.find('\n') + 1);
  text = text.substr(0, text.find_first_of("#\r\n"));
  const auto equals = text.find('=');
  if (equals == text.npos) return {};
  std::string value(text.substr(equals + 1));
  value.erase(0, value.find_first_not_of(' '));
  value.erase(value.find_last_not_of(' ') + 1);
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  if (std::none_of(value.begin(), value.end(), is_letter)) return {};
  if (value.find_first_of("\"'[{") != value.npos) return {};
  return "; a number with a unit, and text, stand in quotes: \"" + value + "\"";
}

}  // namespace

Node parse_toml(std::string_view text, const std::string& origin) {
  const std::optional<TomlFault> fault = find_toml_fault(text);
  const auto refuse_fault = [&] {
    fail(origin, {fault->line, fault->column, nullptr}, "",
         fault->message + missing_quotes(text, fault->line));
  };
  try {
    // the parser's error comes first when it stands before the fault
    Node root = convert(toml::parse(text.substr(0, fault ? fault->offset : text.npos)));
    if (fault) refuse_fault();
    return root;
  } catch (const toml::parse_error& error) {
    const Place place = place_of(error.source());
    if (fault && place.line >= fault->line) refuse_fault();
    fail(origin, place, "", std::string(error.description()) + missing_quotes(text, place.line));
  } catch (const std::logic_error&) {
    fail(origin, {1, 1, nullptr}, "", "is not TOML");
  }
}

std::string write_toml(const Node& root) {
  std::string text;
  for (const Item& item : root.items) {
    if (item.value.kind == Node::Kind::table || holds_tables(item.value)) continue;
    text += written_key(item.key) + " = " + written(item.value) + "\n";
  }
  for (const Item& item : root.items) {
    if (item.value.kind == Node::Kind::table) {
      text += "\n[" + written_key(item.key) + "]\n";
      write_keys(text, item.value);
    } else if (holds_tables(item.value)) {
      for (const Item& entry : item.value.items) {
        text += "\n[[" + written_key(item.key) + "]]\n";
        write_keys(text, entry.value);
      }
    }
  }
  return text;
}

std::string entry_label(const Node& list, std::size_t index) {
  const auto text = [&](std::size_t at, std::string_view key) {
    const Node* const node = list.items[at].value.find(key);
    return node && node->kind == Node::Kind::text ? node->text : std::string();
  };
  if (const std::string name = text(index, "name"); !name.empty()) return name;
  const std::string kind = text(index, "kind");
  if (kind.empty()) return std::to_string(index + 1);
  std::size_t same = 1;
  for (std::size_t k = 0; k < index; ++k) same += text(k, "name").empty() && text(k, "kind") == kind;
  return kind_stem(kind) + (same > 1 ? "-" + std::to_string(same) : "");
}

std::string kind_stem(const std::string& kind) {
  if (!kind.ends_with(".toml")) return kind;
  const std::size_t begin = kind.rfind('/') + 1;  // npos + 1: there is no folder
  return kind.substr(begin, kind.size() - begin - 5);
}

std::string entry_path(const Node& list, const std::string& key, std::size_t index) {
  const SourceEntry* const source = list.items[index].value.source.get();
  return source ? source->path : key + "." + entry_label(list, index);
}

std::string_view kind_name(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::boolean:
      return "true or false";
    case Node::Kind::integer:
      return "an integer";
    case Node::Kind::real:
      return "a number";
    case Node::Kind::text:
      return "text";
    case Node::Kind::date:
      return "a date or time";
    case Node::Kind::list:
      return "a list";
    case Node::Kind::table:
      return "a table";
  }
  return "";
}

std::string shown(const Node& node) {
  constexpr std::size_t k_longest = 60;
  if (node.kind == Node::Kind::table || node.kind == Node::Kind::list || node.kind == Node::Kind::date) {
    return std::string(kind_name(node.kind));
  }
  if (node.kind == Node::Kind::real) return shortest_digits(node.real);
  if (node.kind != Node::Kind::text || node.text.size() <= k_longest) {
    return node.kind == Node::Kind::text ? '"' + node.text + '"' : written(node);
  }
  const auto end =
      utf8::find_invalid(node.text.begin(), node.text.begin() + k_longest);  // no letter is split
  return '"' + std::string(node.text.begin(), end) + "...\"";
}

}  // namespace topple::io
