#include "solver/io/scene/scene_entry.h"

#include <algorithm>

#include "solver/io/scene/scene_check.h"
#include "solver/io/scene/scene_keys.h"

namespace topple::io {
namespace {

double quantity(const Node& node, Dimension dimension) {
  return node.is_number() ? node.real : *parse_quantity(node.text, dimension).si;
}

Vec3 three(const Node& list, Dimension dimension) {
  return {quantity(list.items[0].value, dimension), quantity(list.items[1].value, dimension),
          quantity(list.items[2].value, dimension)};
}

}  // namespace

double Entry::number(std::string_view key) const {
  const Key& spec = *find_key(table_, key);
  const Node* node = find(key);
  return node ? quantity(*node, spec.dimension) : spec.fallback.at(0);
}

int Entry::integer(std::string_view key) const {
  return static_cast<int>(number(key));
}

bool Entry::flag(std::string_view key) const {
  const Node* node = find(key);
  return node ? node->boolean : find_key(table_, key)->fallback.at(0) != 0;
}

std::string Entry::text(std::string_view key) const {
  const Node* node = find(key);
  return node ? node->text : std::string();
}

std::vector<std::string> Entry::texts(std::string_view key) const {
  std::vector<std::string> values;
  if (const Node* node = find(key))
    for (const Item& item : node->items) values.push_back(item.value.text);
  return values;
}

std::string_view Entry::word(std::string_view key) const {
  const Key& spec = *find_key(table_, key);
  const Node* node = find(key);
  return node ? node->text : spec.choices.at(static_cast<std::size_t>(spec.fallback.at(0)));
}

bool Entry::is_word(std::string_view key) const {
  const Node* node = find(key);
  return node ? node->kind == Node::Kind::text : find_key(table_, key)->fallback.size() == 1;
}

bool Entry::names(std::string_view key, std::string_view word) const {
  const Node* node = find(key);
  return node && std::any_of(node->items.begin(), node->items.end(),
                             [&](const Item& item) { return item.value.text == word; });
}

std::vector<double> Entry::numbers(std::string_view key) const {
  const Key& spec = *find_key(table_, key);
  const Node* node = find(key);
  if (!node) return spec.fallback;
  if (node->kind != Node::Kind::list) return {quantity(*node, spec.dimension)};
  std::vector<double> values;
  for (const Item& item : node->items) values.push_back(quantity(item.value, spec.dimension));
  return values;
}

Vec3 Entry::vector(std::string_view key) const {
  const std::vector<double> values = numbers(key);
  return {values.at(0), values.at(1), values.at(2)};
}

Vec3 Entry::direction(std::string_view key) const {
  const Vec3 v = vector(key);
  const double length = v.stableNorm();
  if (!(length > 0)) fail(key, "a zero vector has no direction");
  return v / length;
}

std::vector<Vec3> Entry::vectors(std::string_view key) const {
  std::vector<Vec3> values;
  if (const Node* node = find(key)) {
    const Dimension dimension = find_key(table_, key)->dimension;
    for (const Item& item : node->items) values.push_back(three(item.value, dimension));
  }
  return values;
}

std::vector<int> Entry::integers(std::string_view key) const {
  std::vector<int> values;
  for (const double value : numbers(key)) values.push_back(static_cast<int>(value));
  return values;
}

std::vector<std::pair<double, double>> Entry::history(std::string_view key) const {
  std::vector<std::pair<double, double>> values;
  if (const Node* node = find(key)) {
    for (const Item& item : node->items) {
      values.emplace_back(quantity(item.value.items[0].value, Dimension::time),
                          quantity(item.value.items[1].value, Dimension::none));
    }
  }
  return values;
}

std::vector<Entry> Entry::entries(std::string_view key) const {
  std::vector<Entry> result;
  const Node* list = find(key);
  const std::string nested = (table_.empty() ? "" : table_ + ".") + std::string(key);
  const std::string path = (path_.empty() ? "" : path_ + ".") + std::string(key);
  for (std::size_t k = 0; list && k < list->items.size(); ++k) {
    const Node& node = list->items[k].value;
    result.emplace_back(origin_, nested, entry_path(*list, path, k), &node, node.place);
    result.back().name_ = entry_name(*list, key, k);
  }
  return result;
}

Entry Entry::entry(std::string_view key) const {
  const Node* node = find(key);
  const std::string nested = (table_.empty() ? "" : table_ + ".") + std::string(key);
  const std::string path = (path_.empty() ? "" : path_ + ".") + std::string(key);
  return {origin_, nested, path, node, node ? node->place : place_};
}

void Entry::fail(std::string_view key, const std::string& message, int part) const {
  const Node* node = find(key);
  std::string path = (path_.empty() ? "" : path_ + ".") + std::string(key);
  if (node && part >= 0 && node->kind == Node::Kind::list) {
    node = &node->items.at(static_cast<std::size_t>(part)).value;
    path += "." + std::to_string(part + 1);
  }
  io::fail(origin_, node ? node->place : place_, path, message);
}

std::string Entry::where(std::string_view key) const {
  const Node* node = find(key);
  return error_line(origin_, node ? node->place : place_, path_ + "." + std::string(key), "");
}

}  // namespace topple::io
