#include "solver/run/place_hits.h"

#include <algorithm>
#include <optional>

#include "solver/run/footprint.h"

namespace topple {

void observe_hits(const Room& room, const Model& model, std::span<const Vec3> position, double time,
                  std::vector<PlaceOutcome>& places) {
  const double radius = room.person / 2;
  for (int b = 0; b < model.furniture_total(); ++b) {
    const Body& body = model.bodies[b];
    const Vec2 somewhere = position[body.first_node].head<2>();
    std::optional<Footprint> print;
    for (std::size_t p = 0; p < places.size(); ++p) {
      const Vec2& at = room.places[p].at;
      std::vector<PlaceOutcome::Hit>& hits = places[p].hits;
      if ((somewhere - at).norm() > 2 * body.reach + radius + 1) continue;  // deformed and fat by a metre
      if (std::ranges::find(hits, b, &PlaceOutcome::Hit::body) != hits.end()) continue;
      if (!print) print = footprint(model, position, b, k_person_height);
      if (!print) break;
      if (print->distance(at) < radius) hits.push_back({b, time});
    }
  }
}

}  // namespace topple
