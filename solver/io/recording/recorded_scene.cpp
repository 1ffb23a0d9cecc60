#include <algorithm>

#include "solver/io/common/errors.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/recording/recording.h"
#include "solver/io/recording/recording_format.h"
#include "solver/io/scene/scene.h"

namespace topple::io {
namespace {

/// The scene's text; of an older format in words that mean today what it meant then.
std::string text_for_today(const Recording& recording) {
  const auto format = std::ranges::find(formats(), recording.format(), &Format::version);
  const bool has_surfaces = format->has_field("panel_contact");
  if (format->on_corners && has_surfaces) return recording.scene_text();
  Node root = parse_toml(recording.scene_text(), recording.scene_name());
  if (!has_surfaces) apply_override(root, "contact.surfaces=false");
  Item* const cabinets = root.find_item("cabinet");
  if (!cabinets || format->on_corners) return write_toml(root);
  for (Item& cabinet : cabinets->value.items) {
    if (cabinet.value.find("base")) continue;
    Node edges;
    edges.kind = Node::Kind::text;
    edges.text = "edges";
    cabinet.value.items.push_back({"base", {}, edges});
  }
  return write_toml(root);
}

}  // namespace

Scene recorded_scene(const Recording& recording) {
  const auto read = [&recording](const std::string& name) {
    for (const SceneFile& file : recording.scene_files())
      if (file.name == name) return file.bytes;
    throw InputError(name + ": is not in the recording");
  };
  Scene scene = parse_scene(text_for_today(recording), recording.scene_name(), {}, read);
  scene.name = recording.scene_name();  // which may have a dot
  return scene;
}

}  // namespace topple::io
