// Kinds of furniture: files of one body, its materials and sections, and [kind].
#pragma once

#include <string>
#include <vector>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/furniture_piece.h"
#include "solver/io/scene/scene_content.h"

namespace topple::io {

/// The kinds of the library, in alphabetical order.
const std::vector<FurnitureKind>& furniture_kinds();

/// A kind of the library, or, where `name` ends in ".toml", one that `read` gives, whose errors name the file
/// beside `origin`; it is kept in `files`. Throws InputError; what is wrong with the name is blamed on
/// `place` and `path`, of the key that has it.
FurnitureKind furniture_kind(const std::string& name, const std::string& origin, const Place& place,
                             const std::string& path, const ReadSceneFile& read,
                             std::vector<SceneFile>& files);

}  // namespace topple::io
