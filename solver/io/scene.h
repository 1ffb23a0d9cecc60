// Scene files: TOML text to Setup. Contract: interface 2.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "solver/run.h"

namespace topple::io {

/// Bad input. what() is one line, ready to print: "scene.toml:14:9: contact.friction: 2.4 is outside 0..1.5".
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A scene file understood.
struct Scene {
  std::string name;  ///< "paper-a": built-in name, or the file's name without folder and extension
  std::string title;
  std::string text;  ///< the TOML that describes it, overrides applied: what a recording keeps
  Setup setup;
};

/// Loads a built-in scene by name or a file by path; a path wins when the file exists. `overrides`:
/// "KEY=VALUE" as of --set. Throws InputError.
Scene load_scene(const std::string& path_or_name, const std::vector<std::string>& overrides = {});

/// The same from text; `origin` is what error lines call it.
Scene parse_scene(std::string_view text, const std::string& origin,
                  const std::vector<std::string>& overrides = {});

/// Name, title of each built-in scene, in alphabetical order.
struct BuiltinScene {
  std::string_view name;
  std::string_view text;
};
const std::vector<BuiltinScene>& builtin_scenes();

}  // namespace topple::io
