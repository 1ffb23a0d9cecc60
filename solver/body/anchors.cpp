#include "solver/body/anchors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_break_part = 0.01;  // of a step that resolves its spring: the last one before it breaks

// The bodies on which it acts.
void mark(const Model& model, int k, std::vector<char>& changed) {
  for (const int body : {model.anchors[k].body, model.anchors[k].other.body})
    if (body >= 0) changed[body] = true;
}

// What it held is gone.
void release(const Model& model, int k, AnchorHold hold, State& state, std::vector<char>& changed) {
  const double held = anchor_force_at(model, state, k, state.anchors[k]).energy;
  state.energy.anchor -= held;
  state.energy.released += held;
  state.anchors[k].hold = hold;
  mark(model, k, changed);
}

AnchorPoint place_of(const Model& model, const State& state, const AnchorEnd& end) {
  const int g = end.node;
  const BodyState& s = state.bodies[end.body];
  if (s.level == ModelLevel::frame) {
    const Vec3 arm = state.rotation[g] * end.arm;
    return {state.position[g] + arm,
            state.velocity[g] + state.rotation[g] * state.angular_velocity[g].cross(end.arm)};
  }
  const Body& body = model.bodies[end.body];
  Vec3 arm = model.node_position[g] - body.centre_of_gravity + end.arm, rate = Vec3::Zero();
  if (s.level == ModelLevel::elastic)
    for (int m = 0; m < body.elastic->modes; ++m) {
      const Vec3 shape = anchor_shape(model, end, m);
      arm += s.amplitude[m] * shape;
      rate += s.rate[m] * shape;
    }
  return {s.position + s.rotation * arm, s.velocity + s.rotation * (s.angular_velocity.cross(arm) + rate)};
}

// By the rate at which it is stretched now; infinite: it is not.
double time_to_break(const Model& model, const State& state, int k, const Vec3& d, const Vec3& velocity) {
  const Anchor& anchor = model.anchors[k];
  const double length = d.norm(), tension = anchor_force_at(model, state, k, state.anchors[k]).tension;
  const double rate = length > 0 ? d.dot(velocity) / length * (tension < 0 ? -1 : 1) : 0;
  if (!(rate > 0)) return std::numeric_limits<double>::infinity();
  return std::max(anchor.strength - std::abs(tension), 0.) / (anchor.stiffness * rate);
}

}  // namespace

AnchorPoint anchor_point(const Model& model, const State& state, int k) {
  return place_of(model, state, model.anchors[k].own());
}

AnchorPoint anchor_target(const Model& model, const State& state, int k) {
  const Anchor& anchor = model.anchors[k];
  return anchor.other.body < 0 ? AnchorPoint{anchor.to, Vec3::Zero()} : place_of(model, state, anchor.other);
}

AnchorForce anchor_force_at(const Model& model, const State& state, int k, const AnchorState& held) {
  return anchor_force(model.anchors[k], held, anchor_point(model, state, k).at,
                      anchor_target(model, state, k).at);
}

std::vector<AnchorForce> anchor_forces(const Model& model, const State& state) {
  std::vector<AnchorForce> forces;
  forces.reserve(model.anchors.size());
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k)
    forces.push_back(anchor_force_at(model, state, k, state.anchors[k]));
  return forces;
}

bool switch_anchors(const Model& model, const Parameters& parameters, State& state,
                    std::vector<char>& changed) {
  bool any = false;
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k) {
    AnchorState& now = state.anchors[k];
    const bool wanted = parameters.anchors.empty() || parameters.anchors[k];
    if (wanted != (now.hold == AnchorHold::away)) continue;
    any = true;
    if (!wanted) {
      release(model, k, AnchorHold::away, state, changed);
      continue;
    }
    now.length = (anchor_point(model, state, k).at - anchor_target(model, state, k).at).norm();
    now.hold = AnchorHold::in_place;
    mark(model, k, changed);
  }
  return any;
}

bool break_anchors(const Model& model, State& state, std::vector<char>& changed) {
  bool any = false;
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k) {
    const double tension = anchor_force_at(model, state, k, state.anchors[k]).tension;
    if (!(std::abs(tension) > model.anchors[k].strength)) continue;
    any = true;
    release(model, k, AnchorHold::broken, state, changed);
  }
  return any;
}

double anchor_look_ahead(const Model& model, const State& state) {
  double limit = std::numeric_limits<double>::infinity();
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k) {
    const Anchor& anchor = model.anchors[k];
    const AnchorState& now = state.anchors[k];
    if (now.hold != AnchorHold::in_place) continue;
    double inverse_mass = 1 / model.bodies[anchor.body].mass;
    if (anchor.other.body >= 0) inverse_mass += 1 / model.bodies[anchor.other.body].mass;
    const double part = bounce_limit(1 / inverse_mass, anchor.stiffness);
    const AnchorPoint point = anchor_point(model, state, k), target = anchor_target(model, state, k);
    const Vec3 d = point.at - target.at;
    const double length = d.norm(), gap = std::abs(length - now.length);
    if (holds(anchor, now, length) || !(length > 0)) {
      limit = std::min({limit, part,
                        std::max(k_break_part * part,
                                 time_to_break(model, state, k, d, point.velocity - target.velocity))});
      continue;
    }
    const double rate = d.dot(point.velocity - target.velocity) / length,
                 closing = anchor.type == Anchor::Type::strap ? rate : -rate;
    if (closing * k_longest_step > gap) limit = std::min(limit, std::max(gap / closing, part));
  }
  return limit;
}

}  // namespace topple
