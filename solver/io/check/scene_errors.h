// All that is wrong with a scene, not just the first of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/io/scene/scene_file.h"

namespace topple::io {

struct CheckedScene {
  std::optional<Scene> scene;       ///< where nothing is wrong
  std::vector<std::string> errors;  ///< a line each, ready to print, in the order of the file
};

/// Reads the scene again and again, each time without the key or entry that was wrong, until nothing is.
/// Errors that follow from what was left out are not told: of a required key, of what names an entry, of keys
/// that belong to a choice. A text that is no TOML, and a file that is missing, end it.
CheckedScene check_whole_scene(const SceneSource& source, const std::vector<std::string>& overrides = {});

}  // namespace topple::io
