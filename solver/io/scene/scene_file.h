// Where a scene and the files that it names come from.
#pragma once

#include <string>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_content.h"

namespace topple::io {

/// The text of a scene.
struct SceneSource {
  std::string text;
  std::string origin;  ///< what error lines call it
  ReadSceneFile read;  ///< of the files that it names
};

/// Of a file, or of a built-in scene; a path wins when the file exists. Throws InputError.
SceneSource find_scene(const std::string& path_or_name);

/// What its tree means; `text`: what a recording keeps. Throws InputError, with a place SceneError.
Scene understand(Node root, const SceneSource& source, std::string text);

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
