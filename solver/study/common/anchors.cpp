#include "solver/study/common/anchors.h"

#include <algorithm>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_file.h"

namespace topple::study {
namespace {

constexpr const char* k_keys[] = {"anchor", "fixing"};

}  // namespace

std::optional<io::Scene> without_anchors(const io::Scene& scene) {
  const auto is_in_place = [](bool in_place) { return in_place; };
  if (std::ranges::none_of(scene.setup.wedges, &Wedge::in_place) &&
      std::ranges::none_of(scene.setup.parameters.anchors, is_in_place))
    return std::nullopt;
  io::Node root = io::parse_toml(scene.text, scene.name);
  std::erase_if(root.items,
                [](const io::Item& item) { return std::ranges::find(k_keys, item.key) != std::end(k_keys); });
  io::Scene rest = io::parse_scene(io::write_toml(root), scene.name, {}, io::kept_files(scene));
  rest.name = scene.name;
  rest.setup.parameters.contact = scene.setup.parameters.contact;  // defaults follow what leans on what
  return rest;
}

}  // namespace topple::study
