#include "solver/run/footprint.h"

#include <algorithm>

namespace topple {

std::optional<Footprint> footprint(const Model& model, std::span<const Vec3> position, int body,
                                   double height) {
  const Body& of = model.bodies[body];
  std::vector<Vec2> points;
  double width = 0;
  for (int e = of.first_element; e < of.first_element + of.element_count; ++e) {
    const Element& element = model.elements[e];
    width = std::max(width, model.sections[model.members[element.member].section].width);
    Vec3 a = position[element.node[0]], b = position[element.node[1]];
    if (a.z() > b.z()) std::swap(a, b);
    if (a.z() > height) continue;
    if (b.z() > height) b = a + (height - a.z()) / (b.z() - a.z()) * (b - a);
    points.insert(points.end(), {a.head<2>(), b.head<2>()});
  }
  if (points.empty()) return std::nullopt;
  return Footprint{convex_hull(std::move(points)), width / 2};
}

}  // namespace topple
