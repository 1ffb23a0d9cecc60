#include "solver/run/place_hits.h"

#include <algorithm>
#include <optional>

#include "solver/math/ranges.h"
#include "solver/run/footprint.h"

namespace topple {

namespace {

/// Whether no node of a body comes nearer to a point than this, m, along x or along y.
bool is_far(std::span<const Vec3> position, const Body& body, const Vec2& at, double distance) {
  Vec2 least = position[body.first_node].head<2>(), most = least;
  for (const Vec3& x : position.subspan(body.first_node, body.node_count)) {
    least = least.cwiseMin(x.head<2>());
    most = most.cwiseMax(x.head<2>());
  }
  return (least.array() > at.array() + distance).any() || (most.array() < at.array() - distance).any();
}

double greatest_width(const Model& model) {
  double width = 0;
  for (const Section& section : model.sections) width = std::max(width, section.width);
  return width;
}

}  // namespace

void observe_hits(const Room& room, const Model& model, std::span<const Vec3> position, double time,
                  std::vector<PlaceOutcome>& places) {
  const double radius = room.person / 2, far = radius + greatest_width(model) / 2;
  for (int b = 0; b < model.furniture_total(); ++b) {
    std::optional<Footprint> print;
    for (std::size_t p = 0; p < places.size(); ++p) {
      const Vec2& at = room.places[p].at;
      std::vector<PlaceOutcome::Hit>& hits = places[p].hits;
      if (b == room.places[p].on || is_far(position, model.bodies[b], at, far)) continue;
      if (ranges::find(hits, b, &PlaceOutcome::Hit::body) != hits.end()) continue;
      if (!print) print = footprint(model, position, b, k_person_height);
      if (!print) break;
      if (print->distance(at) < radius) hits.push_back({b, time});
    }
  }
}

}  // namespace topple
