// Files that scenes name.
#pragma once

#include <string>

#include "solver/io/scene/scene_content.h"

namespace topple::io {

/// Files of at most 256 MiB beside `origin`, else built-in records.
ReadSceneFile files_beside(const std::string& origin);

/// Built-in records, else files in the working folder.
ReadSceneFile builtin_files();

/// Those that a scene keeps, which must outlive it.
ReadSceneFile kept_files(const Scene& scene);

/// Of a file that a scene names; read once and kept in `files`.
const std::string& bytes_of(const std::string& name, const ReadSceneFile& read,
                            std::vector<SceneFile>& files);

}  // namespace topple::io
