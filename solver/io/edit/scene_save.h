// A scene as it has become by edits.
#pragma once

#include <string>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::io {

/// Reads a file that `scene` names from what the scene keeps of it, else as builtin_files() (scene_file.h).
/// `scene` must outlive it.
ReadSceneFile files_of(const Scene& scene);

/// A scene that starts as another one was changed while it ran.
struct SavedScene {
  std::string text;                   ///< TOML that loads; comments of the original stay (scene_rewrite.h)
  std::vector<std::string> given_up;  ///< edit keys whose value no scene can state together with the others
};

/// `scene` with the values that `now` has where they can be edited. Shakes begin when they did in the scene;
/// a shake of another type has the keys of that type. Throws InputError where they cannot start a run, such
/// as copies of one entry that are computed differently.
SavedScene edited_scene(const Scene& scene, const Parameters& now);

/// `scene` with `files` as the record of its first shake, which it gains where it has none. Throws InputError
/// for files that are no accelerogram or do not go together.
Scene scene_with_record(const Scene& scene, const std::vector<std::string>& files);

}  // namespace topple::io
