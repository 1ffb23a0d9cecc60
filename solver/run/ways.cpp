#include "solver/run/ways.h"

#include <algorithm>
#include <limits>

#include "solver/math/ranges.h"

namespace topple {
namespace {

constexpr double k_touch = 1e-9;  // m, by which what touches may seem to overlap

/// Nobody walks behind a wall.
bool is_behind_a_wall(const Room& room, const Footprint& print) {
  return ranges::any_of(room.walls, [&](const Room::Wall& wall) {
    return ranges::all_of(print.core,
                          [&](const Vec2& corner) { return Room::before(wall, corner) < -print.radius; });
  });
}

/// Diameter of the widest disc around a point, m.
double space_at(const std::vector<Convex>& walls, const RoomPlan& plan, const Vec2& at) {
  double radius = std::numeric_limits<double>::infinity();
  for (const Convex& wall : walls) radius = std::min(radius, distance(wall, at));
  for (const Footprint& print : plan.lying) radius = std::min(radius, print.distance(at));
  return 2 * radius;
}

/// A person who is squeezed where they are gets away from there.
Way way_to(const Room& room, const std::vector<Convex>& walls, const RoomPlan& plan, const Vec2& from,
           int door) {
  const WidestWay widest =
      widest_way(room, walls, plan.lying, from, room.doors[static_cast<std::size_t>(door)]);
  const double space = std::max(space_at(walls, plan, from), room.person);
  Way way{door, widest.width >= room.person - k_touch, std::min(widest.width, space), {}};
  if (!way.open)
    for (const int k : widest.bottleneck) way.blocked_by.push_back(plan.body[static_cast<std::size_t>(k)]);
  return way;
}

/// On whom something lies goes nowhere.
void hold(const Room& room, const RoomPlan& plan, const Vec2& at, Way& way) {
  std::vector<int> on_him;
  for (std::size_t k = 0; k < plan.lying.size(); ++k) {
    const double space = 2 * plan.lying[k].distance(at);
    if (space >= room.person - k_touch) continue;
    on_him.push_back(plan.body[k]);
    way.widest = std::min(way.widest, space);
  }
  if (on_him.empty()) return;
  way.open = false;
  way.caught = true;
  way.blocked_by = std::move(on_him);
}

/// What may be in the way from a place.
RoomPlan around(const RoomPlan& plan, const Room::Place& place) {
  RoomPlan out;
  for (std::size_t k = 0; k < plan.lying.size(); ++k) {
    if (plan.body[k] == place.on) continue;
    out.lying.push_back(plan.lying[k]);
    out.body.push_back(plan.body[k]);
  }
  return out;
}

double length_of(const Room& room, const RoomPlan& plan, std::size_t place, const Way& way) {
  const auto line = shortest_way(room, plan, static_cast<int>(place), way.door);
  return line ? line->length : std::numeric_limits<double>::infinity();
}

}  // namespace

RoomPlan room_plan(const Room& room, const Model& model, std::span<const Vec3> position) {
  RoomPlan plan;
  for (int b = 0; b < model.furniture_total(); ++b) {
    std::optional<Footprint> print = footprint(model, position, b, k_head_height);
    if (!print || is_behind_a_wall(room, *print)) continue;
    plan.lying.push_back(*std::move(print));
    plan.body.push_back(b);
  }
  return plan;
}

std::vector<Way> ways(const Room& room, const RoomPlan& plan) {
  const std::vector<Convex> walls = faces(room);
  std::vector<Way> all(room.places.size());
  for (std::size_t p = 0; p < all.size(); ++p) {
    Way& best = all[p];
    const RoomPlan own = around(plan, room.places[p]);
    for (int d = 0; d < static_cast<int>(room.doors.size()); ++d) {
      const Way way = way_to(room, walls, own, room.places[p].at, d);
      const bool better = best.door < 0           ? true
                          : way.open != best.open ? way.open
                          : way.open ? length_of(room, plan, p, way) < length_of(room, plan, p, best)
                                     : way.widest > best.widest;
      if (better) best = way;
    }
    if (best.door >= 0) hold(room, own, room.places[p].at, best);
  }
  return all;
}

std::vector<bool> open_ways(const Run& run) {
  const Room& room = run.setup().room;
  std::vector<bool> open;
  if (room.ways() == 0) return open;
  for (const Way& way : ways(room, room_plan(room, run.setup().model, run.state().position)))
    open.push_back(way.open);
  return open;
}

std::optional<ShortestWay> shortest_way(const Room& room, const RoomPlan& plan, int place, int door) {
  const Room::Place& from = room.places[static_cast<std::size_t>(place)];
  return shortest_way(room, faces(room), around(plan, from).lying, from.at,
                      room.doors[static_cast<std::size_t>(door)], room.person);
}

}  // namespace topple
