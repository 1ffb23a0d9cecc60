// What stands in a room, as its scene says it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::app {

/// Where a piece stands in plan.
struct Spot {
  Vec2 at = Vec2::Zero();  ///< m, middle of the footprint
  double yaw = 0;          ///< rad, of its front from +x
  bool operator==(const Spot&) const = default;
};

/// A body of a room, and the entry of the scene that it was built from.
struct RoomPiece {
  std::string name;                 ///< of the body
  std::string kind;                 ///< of a [[furniture]]: "bookshelf"; else empty
  std::string table;                ///< "furniture", "cabinet", "frame" or "block"
  std::string becomes;              ///< "cabinet", "frame" or "block"
  std::size_t number = 1;           ///< of the entry in its table, from 1
  std::optional<std::size_t> copy;  ///< of its `copies`, from 0; absent: it has none
  std::size_t body = 0;             ///< index in the model
  Spot spot;
  double floor = 0;               ///< m, height that it stands on
  Vec2 half = Vec2::Zero();       ///< m, half of its depth and width, outer
  Vec3 size = Vec3::Zero();       ///< m, outer depth, width and height
  double mass = 0, contents = 0;  ///< kg; of furniture alone
  bool upright = true;            ///< it does not lie
};

/// All but floors and walls of members, in the order of the bodies. Throws InputError where `scene` does not
/// load.
std::vector<RoomPiece> pieces_of(const io::Scene& scene);

}  // namespace topple::app
