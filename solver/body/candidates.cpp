#include "solver/body/candidates.h"

#include <algorithm>

#include "solver/body/model_level.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr double k_margin = 0.05;  // m, around surfaces: how far bodies come before they are looked for again

}  // namespace

Approach::Motion::Motion(const Model& model, const State& state, int index) {
  const Body& body = model.bodies[index];
  half_width = body.width / 2;
  if (const BodyState& s = state.bodies[index]; s.level != ModelLevel::frame) {
    const Mat3 r = s.rotation.toRotationMatrix();
    const Vec3 middle = s.position + r * body.box.center(), half = r.cwiseAbs() * body.box.sizes() / 2;
    box = {middle - half, middle + half};
    rigid = {.centre = s.position, .reach = body.reach};
    return;
  }
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) box.extend(state.position[i]);
  rigid = {.centre = box.center(), .reach = box.sizes().norm() / 2};
}

// Of motions_.
double Approach::greatest(double margin) {
  for (Motion& motion : motions_) motion.way = motion.rigid.way() + motion.more;
  ranges::sort(motions_, [](const Motion& a, const Motion& b) { return a.first() < b.first(); });
  double greatest = 0;
  for (auto a = motions_.begin(); a != motions_.end(); ++a)
    for (auto b = a + 1; b != motions_.end() && b->first() <= a->last() + margin; ++b) {
      const double closer = approach(a->rigid, b->rigid) + a->more + b->more;
      if (closer > greatest &&
          a->box.exteriorDistance(b->box) <= margin + a->half_width + b->half_width + closer)
        greatest = closer;
    }
  return greatest;
}

double Approach::likely(const Model& model, const State& state, double h) {
  motions_.clear();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    Motion& motion = motions_.emplace_back(model, state, b);
    if (const BodyState& s = state.bodies[b]; s.level != ModelLevel::frame) {
      motion.rigid.shift = h * s.velocity;
      motion.rigid.turn = exp_quaternion(h * (s.rotation * s.angular_velocity));
      motion.more = h * h / 2 * s.force.norm() / body.mass;
      continue;
    }
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      motion.more =
          std::max(motion.more, h * state.velocity[i].norm() + h * h / 2 * state.acceleration[i].norm());
  }
  return greatest(state.candidate_margin);
}

double Approach::greatest(const Model& model, const State& from, const State& to, double margin) {
  motions_.clear();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    Motion& motion = motions_.emplace_back(model, from, b);
    const BodyState &s = from.bodies[b], &e = to.bodies[b];
    if (s.level != ModelLevel::frame && e.level != ModelLevel::frame) {
      motion.rigid.shift = e.position - s.position;
      motion.rigid.turn = e.rotation * s.rotation.conjugate();
    } else if (s.level == e.level) {  // where it changes nothing moves far
      for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
        motion.more = std::max(motion.more, (to.position[i] - from.position[i]).norm());
    }
  }
  return greatest(margin);
}

void update_candidates(const Model& model, NearSearch& search, State& state, double approach) {
  if (model.bodies.size() < 2 || state.candidate_margin > approach) return;
  place_nodes(model, state);
  state.candidate_margin = std::max(k_margin, 2 * approach);
  const std::vector<ElementPair>& found = search.find(state.position, state.candidate_margin);
  if (!ranges::equal(state.candidate_pairs, found)) state.candidate_pairs = found;
}

}  // namespace topple
