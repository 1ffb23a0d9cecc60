// The way out: whether people can still reach a door.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/run/run.h"
#include "solver/run/shortest_way.h"

namespace topple {

/// m: what lies higher is walked under.
inline constexpr double k_head_height = 1.8;

/// What lies in a room, in plan below k_head_height.
struct RoomPlan {
  std::vector<Footprint> lying;
  std::vector<int> body;  ///< of each
};
/// Of the furniture that is not behind a wall. position: per node of the model, m, floor's frame.
RoomPlan room_plan(const Room& room, const Model& model, std::span<const Vec3> position);

/// From a place to the door that serves it: that with the shortest way of those that are open, else that with
/// the widest.
struct Way {
  int door = -1;      ///< of the room; -1: it has none
  bool open = false;  ///< for a person
  double widest = 0;  ///< m, of the disc that passes, at most the door's width
  /// Closed: bodies that a wider disc would have to pass between, or that lie where the person stands.
  std::vector<int> blocked_by = {};
  bool caught = false;  ///< they lie where the person stands
};

/// From each place.
std::vector<Way> ways(const Room& room, const RoomPlan& plan);

/// Of a way that is open: the shortest one of a person.
std::optional<ShortestWay> shortest_way(const Room& room, const RoomPlan& plan, int place, int door);

/// Where a run stands: whether each of the Room::ways() is open.
std::vector<bool> open_ways(const Run& run);

}  // namespace topple
