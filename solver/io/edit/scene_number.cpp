#include "solver/io/edit/scene_number.h"

#include <utility>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_check.h"

namespace topple::io {
namespace {

bool takes_number(const Key& key) {
  return key.type == KeyType::number || (key.type == KeyType::numbers && key.least_count == 1);
}

std::optional<double> value_of(const Scene& scene, const Node* node, const Key& key) {
  if (!node) return value_left_out(scene, key);
  if (node->kind == Node::Kind::list)
    return node->items.size() == 1 ? value_of(scene, &node->items.front().value, key) : std::nullopt;
  if (node->is_number()) return node->real;
  return node->kind == Node::Kind::text ? parse_quantity(node->text, key.dimension).si : std::nullopt;
}

/// Looks for what an override put into `changed`, beside the tree as it was.
class Search {
 public:
  Search(const Scene& scene, const std::string& path) : scene_(scene), path_(path) {}

  /// `before`: the counterpart of `changed`, null where there was none.
  std::optional<SceneNumber> in(const Node& changed, const Node* before, const std::string& table) {
    for (std::size_t k = 0; k < changed.items.size(); ++k) {
      const Item& item = changed.items[k];
      const bool entries = changed.kind == Node::Kind::list;
      const Node* const old = !before                    ? nullptr
                              : !entries                 ? before->find(item.key)
                              : k < before->items.size() ? &before->items[k].value
                                                         : nullptr;
      if (entries && outermost_ < 0) outermost_ = static_cast<int>(k);
      const bool leaf = item.key_place.override_text && item.value.kind != Node::Kind::table &&
                        item.value.kind != Node::Kind::list;
      if (leaf) {
        const Key* const key = entries ? nullptr : find_key(table, item.key);
        if (!key || !takes_number(*key)) throw InputError(path_ + ": is no key that takes one number");
        return SceneNumber{key, outermost_, value_of(scene_, old, *key)};
      }
      const std::string inner = entries ? table : table.empty() ? item.key : table + "." + item.key;
      if (const auto found = in(item.value, old, inner)) return found;
      if (entries && outermost_ == static_cast<int>(k)) outermost_ = -1;
    }
    return std::nullopt;
  }

 private:
  const Scene& scene_;
  const std::string& path_;
  int outermost_ = -1;
};

}  // namespace

bool is_step_chosen(const Scene& scene, const Key& key) {
  return &key == find_key("run", "time_step") && scene.setup.parameters.adaptive;
}

std::optional<double> value_left_out(const Scene& scene, const Key& key) {
  static const std::pair<const Key*, double ContactLaw::*> k_chosen[] = {
      {find_key("contact", "alpha"), &ContactLaw::alpha},
      {find_key("contact", "member_share"), &ContactLaw::member_share}};
  for (const auto& [chosen, number] : k_chosen)
    if (&key == chosen) return scene.setup.parameters.contact.*number;
  if (is_step_chosen(scene, key)) return std::nullopt;
  return key.fallback.size() == 1 ? std::optional(key.fallback.front()) : std::nullopt;
}

SceneNumber number_in(const Scene& scene, const std::string& path) {
  const Node before = parse_toml(scene.text, scene.name);
  Node changed = before;
  try {
    apply_override(changed, path + "=0");
  } catch (const InputError& error) {
    const std::string line = error.what(), trial = "--set " + path + "=0: ";
    throw InputError(line.starts_with(trial) ? line.substr(trial.size()) : line);
  }
  const std::optional<SceneNumber> found = Search(scene, path).in(changed, &before, "");
  if (!found) throw InputError(path + ": is no key that takes one number");
  return *found;
}

}  // namespace topple::io
