// Kinds of furniture: files of one body, its materials and sections, and [kind].
#pragma once

#include <string>
#include <vector>

#include "solver/io/scene/scene_content.h"
#include "solver/io/scene/scene_document.h"
#include "solver/math/types.h"

namespace topple::io {

/// A kind as its file has it.
struct FurnitureKind {
  std::string name;   ///< "bookshelf": of the file without folder and extension
  std::string title;  ///< of the file
  std::string source;
  std::string table;                      ///< of the body: "cabinet", "frame" or "block"
  Node body;                              ///< without name
  std::vector<Node> materials, sections;  ///< of the file, named "bookshelf/post"; the body calls them so
  Vec3 size;                              ///< m, outer depth, width and height
  double mass;                            ///< kg, empty
  double contents_mass;                   ///< kg
  Vec3 contents_cg;                       ///< m, from the middle of the outer base
};

/// The kinds of the library, in alphabetical order.
const std::vector<FurnitureKind>& furniture_kinds();

/// A kind of the library, or, where `name` ends in ".toml", one that `read` gives, whose errors name the file
/// beside `origin`; it is kept in `files`. Throws InputError; what is wrong with the name is blamed on
/// `place` and `path`, of the key that has it.
FurnitureKind furniture_kind(const std::string& name, const std::string& origin, const Place& place,
                             const std::string& path, const ReadSceneFile& read,
                             std::vector<SceneFile>& files);

}  // namespace topple::io
