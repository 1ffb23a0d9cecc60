#include "solver/body/candidates.h"

#include <algorithm>

#include "solver/body/model_level.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr double k_margin = 0.05;  // m, around surfaces: how far bodies come before they are looked for again

}  // namespace

double likely_travel(const Model& model, const State& state, double h) {
  double greatest = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (const BodyState& s = state.bodies[b]; s.level != ModelLevel::frame) {
      const double reach = body.reach;
      greatest = std::max(greatest, h * (s.velocity.norm() + reach * s.angular_velocity.norm() +
                                         h / 2 * s.force.norm() / body.mass));
      continue;
    }
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      greatest = std::max(greatest, h * state.velocity[i].norm() + h * h / 2 * state.acceleration[i].norm());
  }
  return greatest;
}

double greatest_travel(const Model& model, const State& from, const State& to) {
  double greatest = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (const BodyState& s = from.bodies[b], &e = to.bodies[b];
        s.level != ModelLevel::frame && e.level != ModelLevel::frame) {
      greatest =
          std::max(greatest, (e.position - s.position).norm() +
                                 body.reach * log_quaternion(s.rotation.conjugate() * e.rotation).norm());
      continue;
    }
    if (from.bodies[b].level != to.bodies[b].level) continue;  // where it changes nothing moves far
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      greatest = std::max(greatest, (to.position[i] - from.position[i]).norm());
  }
  return greatest;
}

void update_candidates(const Model& model, NearSearch& search, State& state, double travel) {
  if (model.bodies.size() < 2 || state.candidate_margin > 2 * travel) return;
  place_nodes(model, state);
  state.candidate_margin = std::max(k_margin, 4 * travel);
  const std::vector<ElementPair>& found = search.find(state.position, state.candidate_margin);
  if (!ranges::equal(state.candidate_pairs, found)) state.candidate_pairs = found;
}

}  // namespace topple
