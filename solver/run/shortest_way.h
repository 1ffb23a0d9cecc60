// The shortest way of a disc from a point of a room to a door of it.
#pragma once

#include <optional>
#include <vector>

#include "solver/run/widest_way.h"

namespace topple {

struct ShortestWay {
  double length;           ///< m
  std::vector<Vec2> line;  ///< of the disc's middle, from the point to the line of the door
};

/// Through the visibility graph of the obstacles grown by half of `width`, m, with arcs of polygons of 36
/// sides, cut by up to 1 % of the disc's radius: a length is right within 0.5 % of it. None: there is no way.
std::optional<ShortestWay> shortest_way(const Room& room, const std::vector<Convex>& faces,
                                        const std::vector<Footprint>& obstacles, const Vec2& from,
                                        const Room::Door& door, double width);

}  // namespace topple
