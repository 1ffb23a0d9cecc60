#include "app/study/broadcast_scene.h"

#include <algorithm>

namespace topple::app {

std::vector<std::string> broadcast_parts(const io::Scene& scene) {
  std::vector<std::string> parts{scene.name, scene.text};
  for (const io::SceneFile& file : scene.files) parts.insert(parts.end(), {file.name, file.bytes});
  return parts;
}

io::Scene scene_from(const std::vector<std::string>& parts) {
  const auto read = [&parts](const std::string& name) {
    for (std::size_t k = 2; k + 1 < parts.size(); k += 2)
      if (parts[k] == name) return parts[k + 1];
    throw io::InputError(name + ": is not among the files of the scene");
  };
  io::Scene scene = io::parse_scene(parts[1], parts[0], {}, read);
  scene.name = parts[0];
  for (std::size_t k = 2; k + 1 < parts.size();
       k += 2)  // records of an ensemble, which the text does not name
    if (std::ranges::find(scene.files, parts[k], &io::SceneFile::name) == scene.files.end())
      scene.files.push_back({parts[k], parts[k + 1]});
  return scene;
}

}  // namespace topple::app
