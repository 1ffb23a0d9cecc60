// [[furniture]]: pieces of the library become bodies while a scene is read.
#pragma once

#include <string>
#include <vector>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_content.h"
#include "solver/math/types.h"

namespace topple::io {

/// Replaces each [[furniture]] of a checked scene by the [[cabinet]], [[frame]] or [[block]] that it becomes,
/// with the [[material]]s and [[section]]s of its kind; SourceEntry says which it was. Files of kinds come
/// from `read` and are kept in `files`. Throws InputError.
void expand_furniture(Node& root, const std::string& origin, const ReadSceneFile& read,
                      std::vector<SceneFile>& files);

/// What a [[furniture]] of a scene is, what it leaves to its kind included.
struct FurniturePiece {
  std::string name;
  std::string kind;      ///< "bookshelf", or a file
  std::string table;     ///< of the body that it becomes: "cabinet", "frame" or "block"
  std::size_t number;    ///< of the entry, from 1
  Vec3 size;             ///< m, outer
  Vec3 rocking_size;     ///< m, between the centre lines of its edges, about which it rocks
  double mass;           ///< kg, empty
  double contents_mass;  ///< kg
  Vec3 contents_cg;      ///< m, from the middle of the outer base
  Vec3 at;               ///< m, middle of the footprint
  double yaw;            ///< rad
};

/// The [[furniture]] of a scene, in its order.
std::vector<FurniturePiece> furniture_of(const Scene& scene);

/// The entry that bodies were built from.
struct BodyEntry {
  std::string table;               ///< "cabinet", "frame", "block" or "furniture"
  std::size_t number;              ///< from 1
  std::size_t first_body, bodies;  ///< itself and its copies
};

/// In the order of the bodies, floors and walls of members apart.
std::vector<BodyEntry> body_entries(const Scene& scene);

}  // namespace topple::io
