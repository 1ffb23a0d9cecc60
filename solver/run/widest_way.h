// The widest disc that can move from a point of a room to beyond a door of it.
#pragma once

#include <vector>

#include "solver/model/room.h"
#include "solver/run/footprint.h"

namespace topple {

/// Faces of the room's walls beside the doors, as lines that reach beyond the room.
std::vector<Convex> faces(const Room& room);
/// Of one of them.
std::vector<Convex> faces(const Room& room, std::size_t wall);

struct WidestWay {
  double width;  ///< m; infinite: nothing is in the way
  std::vector<int>
      bottleneck;  ///< that a wider disc would have to pass between: indices of obstacles, in order
};

/// Exact: the least width at which obstacles with gaps of less than a width, chained from wall to wall or
/// around, part `from` from the door. A chain does where it crosses a line from one to the other an odd
/// number of times, and the union of the obstacles, each grown by half of the width, has no other holes than
/// those such chains run around (nerve theorem: grown convex shapes are convex). All that lies behind the
/// walls is one obstacle. Whether the disc has space at `from` itself is not asked.
WidestWay widest_way(const Room& room, const std::vector<Convex>& faces,
                     const std::vector<Footprint>& obstacles, const Vec2& from, const Room::Door& door);

}  // namespace topple
