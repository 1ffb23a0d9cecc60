#include "solver/run/bearer.h"

#include <algorithm>

#include "solver/run/footprint.h"

namespace topple {
namespace {

Vec2 centre_in_plan(const Model& model, std::span<const Vec3> position, const Body& body) {
  Vec3 sum = Vec3::Zero();
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    sum += model.node_mass[i] * position[i];
  return sum.head<2>() / body.mass;
}

}  // namespace

Heights heights(const Model& model, std::span<const Vec3> position, int index) {
  const Body& body = model.bodies[index];
  Heights found;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const double half = model.sections[model.members[model.elements[e].member].section].width / 2;
    for (const int node : model.elements[e].node) {
      found.low = std::min(found.low, position[node].z() - half);
      found.high = std::max(found.high, position[node].z() + half);
    }
  }
  return found;
}

Below below(const Model& model, std::span<const Vec3> position, int index, bool floor) {
  constexpr double k_any_height = std::numeric_limits<double>::max();
  const double bottom = heights(model, position, index).low;
  const auto print = footprint(model, position, index, k_any_height);
  Below found;
  if (floor) found.top = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Heights of = heights(model, position, b);
    if (b == index || of.low > bottom || of.high < found.top - k_hangs) continue;
    const auto other = footprint(model, position, b, k_any_height);
    if (nearest_points(print->core, other->core).distance > print->radius + other->radius) continue;
    const bool one_of_two = of.high < found.top + k_hangs;
    found = {b, std::max(of.high, found.top),
             one_of_two ? 0 : other->distance(centre_in_plan(model, position, model.bodies[index]))};
  }
  return found;
}

int bearer_of(const Model& model, std::span<const Vec3> position, int index) {
  const double bottom = heights(model, position, index).low;
  if (bottom < k_top_of) return -1;
  const Below under = below(model, position, index, true);
  const double gap = bottom - under.top;
  const bool bears = under.body >= 0 && !model.bodies[under.body].ground && gap < k_hangs && gap > -k_top_of;
  return bears ? under.body : -1;
}

std::vector<int> bearers_of(const Model& model) {
  std::vector<int> bearers;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    bearers.push_back(bearer_of(model, model.node_position, b));
  return bearers;
}

}  // namespace topple
