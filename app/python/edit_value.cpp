#include "app/python/edit_value.h"

#include <algorithm>

#include "solver/io/document/scene_document.h"
#include "solver/io/edit/edit_text.h"

namespace topple::python {
namespace {

[[noreturn]] void refuse(const std::string& key, const io::Node& node, const std::string& what) {
  throw io::InputError(key + ": " + io::shown(node) + " " + what);
}

double quantity(const std::string& name, const io::Key& key, const io::Node& node) {
  if (node.is_number()) return node.real;
  if (node.kind != io::Node::Kind::text)
    refuse(name, node, "is " + std::string(io::kind_name(node.kind)) + ", expected a number");
  const io::Quantity read = io::parse_quantity(node.text, key.dimension);
  if (!read.si) refuse(name, node, read.problem);
  return *read.si;
}

/// Of a choice, or a list of choices.
double choice(const std::string& name, const io::Key& key, const io::Node& node) {
  const auto found = std::ranges::find(key.choices, node.text);
  if (node.kind == io::Node::Kind::text && found != key.choices.end())
    return key.numbers.empty() ? static_cast<double>(found - key.choices.begin())
                               : key.numbers[static_cast<std::size_t>(found - key.choices.begin())];
  std::string words;
  for (const std::string_view word : key.choices) words += (words.empty() ? "" : ", ") + std::string(word);
  refuse(name, node, "is not one of " + words);
}

Vec3 value_of(const std::string& name, const io::Key& key, const io::Node& node) {
  const bool list = node.kind == io::Node::Kind::list;
  switch (key.type) {
    case io::KeyType::boolean:
      if (node.kind != io::Node::Kind::boolean) refuse(name, node, "is not true or false");
      return Vec3(node.boolean, 0, 0);
    case io::KeyType::choice:
      return Vec3(choice(name, key, node), 0, 0);
    case io::KeyType::choices: {
      double last = 0;
      if (!list) refuse(name, node, "is not a list");
      for (const io::Item& item : node.items) last = std::max(last, choice(name, key, item.value));
      return Vec3(last, 0, 0);
    }
    default: {
      const auto most = static_cast<std::size_t>(key.type == io::KeyType::numbers ? key.count : 0);
      const std::size_t least = key.least_count > 0 ? 1 : most;
      if (!list && least <= 1) return Vec3(quantity(name, key, node), 0, 0);
      Vec3 value = Vec3::Zero();
      if (!list || node.items.size() < least || node.items.empty() || node.items.size() > most)
        refuse(name, node, most > 0 ? "is not a list of " + std::to_string(most) : "is not a number");
      for (std::size_t k = 0; k < node.items.size(); ++k)
        value[static_cast<Eigen::Index>(k)] = quantity(name, key, node.items[k].value);
      return value;
    }
  }
}

}  // namespace

Edit read_edit(const std::string& key, const std::string& value, const Parameters& parameters,
               const Model& model) {
  std::optional<Edit> edit = io::parse_edit_key(key);
  if (!edit) {
    std::string known;
    for (const auto& [one, index] : editable(model, parameters))
      known += (known.empty() ? "" : ", ") + io::edit_key({.key = one, .index = index});
    throw io::InputError(key + ": cannot be changed while it runs; what can: " + known + ", node.N.pull");
  }
  io::Node written;
  io::apply_override(written, "value=" + value);
  edit->value = value_of(key, io::key_of(edit->key), written.items.front().value);
  io::check_edit(*edit, parameters, model);
  return *edit;
}

}  // namespace topple::python
