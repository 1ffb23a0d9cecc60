#include "solver/study/common/anchors.h"

#include <algorithm>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_file.h"

namespace topple::study {
namespace {

constexpr const char* k_keys[] = {"anchor", "fixing"};

}  // namespace

int anchor_count(const io::Scene& scene) {
  const io::Node root = io::parse_toml(scene.text, scene.name);
  int count = 0;
  for (const char* const key : k_keys)
    if (const io::Node* const entries = root.find(key)) count += static_cast<int>(entries->items.size());
  return count;
}

std::optional<io::Scene> without_anchors(const io::Scene& scene) {
  if (anchor_count(scene) == 0) return std::nullopt;
  io::Node root = io::parse_toml(scene.text, scene.name);
  std::erase_if(root.items,
                [](const io::Item& item) { return std::ranges::find(k_keys, item.key) != std::end(k_keys); });
  io::Scene rest = io::parse_scene(io::write_toml(root), scene.name, {}, io::kept_files(scene));
  rest.name = scene.name;
  return rest;
}

}  // namespace topple::study
