#include "solver/study/common/anchors.h"

#include "solver/io/scene/scene_document.h"
#include "solver/io/scene/scene_file.h"

namespace topple::study {
namespace {

constexpr const char* k_key = "anchor";

}  // namespace

int anchor_count(const io::Scene& scene) {
  const io::Node root = io::parse_toml(scene.text, scene.name);
  const io::Node* anchors = root.find(k_key);
  return anchors ? static_cast<int>(anchors->items.size()) : 0;
}

std::optional<io::Scene> without_anchors(const io::Scene& scene) {
  if (anchor_count(scene) == 0) return std::nullopt;
  io::Node root = io::parse_toml(scene.text, scene.name);
  std::erase_if(root.items, [](const io::Item& item) { return item.key == k_key; });
  io::Scene rest = io::parse_scene(io::write_toml(root), scene.name, {}, io::kept_files(scene));
  rest.name = scene.name;
  return rest;
}

}  // namespace topple::study
