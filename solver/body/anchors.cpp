#include "solver/body/anchors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

// What it held is gone.
void release(const Model& model, int k, AnchorHold hold, State& state, std::vector<char>& changed) {
  const double held =
      anchor_force(model.anchors[k], state.anchors[k], anchor_point(model, state, k).at).energy;
  state.energy.anchor -= held;
  state.energy.released += held;
  state.anchors[k].hold = hold;
  changed[model.anchors[k].body] = true;
}

}  // namespace

AnchorPoint anchor_point(const Model& model, const State& state, int k) {
  const Anchor& anchor = model.anchors[k];
  const int g = anchor.node;
  const BodyState& s = state.bodies[anchor.body];
  if (s.level == ModelLevel::frame) {
    const Vec3 arm = state.rotation[g] * anchor.arm;
    return {state.position[g] + arm,
            state.velocity[g] + state.rotation[g] * state.angular_velocity[g].cross(anchor.arm)};
  }
  const Body& body = model.bodies[anchor.body];
  Vec3 arm = model.node_position[g] - body.centre_of_gravity + anchor.arm, rate = Vec3::Zero();
  if (s.level == ModelLevel::elastic)
    for (int m = 0; m < body.elastic->modes; ++m) {
      const Vec3 shape = anchor_shape(model, anchor, m);
      arm += s.amplitude[m] * shape;
      rate += s.rate[m] * shape;
    }
  return {s.position + s.rotation * arm, s.velocity + s.rotation * (s.angular_velocity.cross(arm) + rate)};
}

std::vector<AnchorForce> anchor_forces(const Model& model, const State& state) {
  std::vector<AnchorForce> forces;
  forces.reserve(model.anchors.size());
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k)
    forces.push_back(anchor_force(model.anchors[k], state.anchors[k], anchor_point(model, state, k).at));
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
    now.length = (anchor_point(model, state, k).at - model.anchors[k].to).norm();
    now.hold = AnchorHold::in_place;
    changed[model.anchors[k].body] = true;
  }
  return any;
}

bool break_anchors(const Model& model, State& state, std::vector<char>& changed) {
  bool any = false;
  for (int k = 0; k < static_cast<int>(model.anchors.size()); ++k) {
    const Anchor& anchor = model.anchors[k];
    const Vec3 at = anchor_point(model, state, k).at;
    if (!(std::abs(anchor_force(anchor, state.anchors[k], at).tension) > anchor.strength)) continue;
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
    const double part = bounce_limit(model.bodies[anchor.body].mass, anchor.stiffness);
    const AnchorPoint point = anchor_point(model, state, k);
    const Vec3 d = point.at - anchor.to;
    const double length = d.norm(), gap = std::abs(length - now.length);
    if (holds(anchor, now, length) || !(length > 0)) {
      limit = std::min(limit, part);
      continue;
    }
    const double rate = d.dot(point.velocity) / length,
                 closing = anchor.type == Anchor::Type::strap ? rate : -rate;
    if (closing * k_longest_step > gap) limit = std::min(limit, std::max(gap / closing, part));
  }
  return limit;
}

}  // namespace topple
