#include "app/study/broadcast_scene.h"

namespace topple::app {

std::vector<std::string> told(const io::Scene& scene) {
  std::vector<std::string> parts{scene.name, scene.text};
  for (const io::SceneFile& file : scene.files) parts.insert(parts.end(), {file.name, file.bytes});
  return parts;
}

io::Scene scene_from(const std::vector<std::string>& told) {
  const auto read = [&told](const std::string& name) {
    for (std::size_t k = 2; k + 1 < told.size(); k += 2)
      if (told[k] == name) return told[k + 1];
    throw io::InputError(name + ": is not among the files of the scene");
  };
  io::Scene scene = io::parse_scene(told[1], told[0], {}, read);
  scene.name = told[0];
  return scene;
}

}  // namespace topple::app
