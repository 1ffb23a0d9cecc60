#include "solver/io/scene/scene.h"

#include <filesystem>
#include <fstream>

#include "solver/io/builtin/stock.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/scene/furniture.h"
#include "solver/io/scene/scene_check.h"
#include "solver/io/scene/scene_file.h"
#include "solver/io/scene/scene_read.h"
#include "solver/reduced/elastic_basis.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_most_bytes = 4u << 20;

void refuse_large(std::size_t bytes, const std::string& origin) {
  if (bytes > k_most_bytes) {
    throw InputError(origin + ": larger than " + std::to_string(k_most_bytes >> 20) +
                     " MiB, which no scene is");
  }
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened");
  std::string text(k_most_bytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw InputError(path + ": cannot be read");
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.starts_with("\x89HDF\r\n"))
    throw InputError(path + ": is a recording (an HDF5 file), not a scene; topple info describes it");
  refuse_large(text.size(), path);
  return text;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& origin, const std::vector<std::string>& overrides,
                  const ReadSceneFile& read) {
  refuse_large(text.size(), origin);
  Node root = parse_toml(text, origin);
  for (const std::string& change : overrides) apply_override(root, change);
  return understand(root, {std::string(text), origin, read ? read : files_beside(origin)},
                    overrides.empty() ? std::string(text) : write_toml(root));
}

Scene understand(Node root, const SceneSource& source, std::string text) {
  const std::string& origin = source.origin;
  check_scene(root, origin);
  Scene scene;
  scene.name = fs::path(origin).stem().string();
  if (root.find("furniture")) {
    expand_furniture(root, origin, source.read, scene.files);
    check_scene(root, origin);
  }
  add_stock(root);
  const Entry entry(origin, "", "", &root, root.place);
  scene.title = entry.has("title") ? entry.text("title") : scene.name;
  scene.text = std::move(text);
  read_run(entry, scene.setup);
  read_shakes(entry, source.read, scene);
  read_contact(entry, scene.setup);
  read_planes(entry, scene.setup);
  read_materials_and_sections(entry, scene.setup);
  const std::vector<Entry> of_body = read_bodies(entry, scene.setup);
  read_anchors(entry, scene.setup);
  read_fixings(entry, scene.setup);
  for (int b = 0; b < scene.setup.model.furniture_total(); ++b)
    if (Body& body = scene.setup.model.bodies[b]; body.elastic)
      body.elastic = with_attachments(scene.setup.model, b);
  choose_alpha(entry, scene.setup);
  check_planar(entry, scene.setup);
  read_probes(entry, scene.setup);
  read_room(entry, scene.setup);
  read_control(entry, scene.setup);
  read_expectations(entry, scene);
  check_overlap(of_body, scene.setup);  // last: what is wrong besides does not depend on it
  return scene;
}

SceneSource find_scene(const std::string& path_or_name) {
  if (path_or_name.empty()) throw InputError("the name of the scene is empty");
  std::error_code status;
  if (fs::is_directory(path_or_name, status)) throw InputError(path_or_name + ": is a folder");
  if (fs::exists(path_or_name, status))
    return {read_text(path_or_name), path_or_name, files_beside(path_or_name)};
  const std::string origin = path_or_name + ".toml";
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (scene.name == path_or_name) return {std::string(scene.text), origin, builtin_files()};
    names += (names.empty() ? "" : ", ") + std::string(scene.name);
  }
  for (const auto* scenes : {&verification_scenes(), &study_scenes()})
    for (const BuiltinScene& scene : *scenes)
      if (scene.name == path_or_name) return {std::string(scene.text), origin, files_beside(origin)};
  throw InputError(path_or_name + ": no such file or built-in scene; built-in: " + names);
}

Scene load_scene(const std::string& path_or_name, const std::vector<std::string>& overrides) {
  const SceneSource source = find_scene(path_or_name);
  if (overrides.empty()) return parse_scene(source.text, source.origin, {}, source.read);
  refuse_large(source.text.size(), source.origin);
  Node root = parse_toml(source.text, source.origin);
  change(root, overrides);
  std::string text = write_toml(root);
  return understand(std::move(root), source, std::move(text));
}

}  // namespace topple::io
