// Scene files: TOML text to Setup. Contract: interface 2.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "solver/io/builtin/builtin.h"
#include "solver/io/scene/scene_content.h"

namespace topple::io {

/// Loads a built-in scene by name or a file by path; a path wins when the file exists. `overrides`:
/// "KEY=VALUE" as of --set. Throws InputError.
Scene load_scene(const std::string& path_or_name, const std::vector<std::string>& overrides = {});

/// The same from text; `origin` is what error lines call it. Without `read`, the files that the scene names
/// are sought beside `origin`, then among the built-in records.
Scene parse_scene(std::string_view text, const std::string& origin,
                  const std::vector<std::string>& overrides = {}, const ReadSceneFile& read = {});

}  // namespace topple::io
