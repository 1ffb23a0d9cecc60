// Anchors: springs between a point of a body and one that is fixed to the floor's frame or to another body.
//
//   d = at - to,  l = |d|,  N = k (l - l0),  F = -N d/l on the body at `at`,  U = k/2 (l - l0)^2
//
// and -F on the other body at `to`. With l0 = 0 it is a pin, F = -k d, N = k l; that of a strap bears no push
// down: d_z counts as 0 where it is less. N > 0 pulls. A strap holds where l >
// l0 only, a pole where l < l0 only, a bracket always. An anchor breaks for good at the end of the first step
// that leaves |N| above its strength. The energy that it holds when it breaks or is taken away is booked as
// EnergyLedger::released. Putting it in place sets l0 to the present l, so that it starts without force; a
// broken one is taken away first.
#pragma once

#include <cstdint>

#include "solver/model/model.h"

namespace topple {

enum class AnchorHold : std::uint8_t { in_place, away, broken };

/// Part of State, one per anchor.
struct AnchorState {
  double length = 0;  ///< m, natural
  AnchorHold hold = AnchorHold::in_place;
};

/// Whether it bears a force at the distance l = `length` of its ends, m.
bool holds(const Anchor& anchor, const AnchorState& state, double length);

struct AnchorForce {
  double tension = 0;         ///< N, negative: pushes
  double energy = 0;          ///< J
  Vec3 force = Vec3::Zero();  ///< N, on the body
};

/// Force of an anchor whose attached point is at `at` and whose other end at `to`, m; zero where it does not
/// hold.
AnchorForce anchor_force(const Anchor& anchor, const AnchorState& state, const Vec3& at, const Vec3& to);
/// Of one to the floor's frame.
inline AnchorForce anchor_force(const Anchor& anchor, const AnchorState& state, const Vec3& at) {
  return anchor_force(anchor, state, at, anchor.to);
}

/// d(force)/d(at) = -d(force)/d(to), N/m; zero where it does not hold.
Mat3 anchor_tangent(const Anchor& anchor, const AnchorState& state, const Vec3& at, const Vec3& to);
inline Mat3 anchor_tangent(const Anchor& anchor, const AnchorState& state, const Vec3& at) {
  return anchor_tangent(anchor, state, at, anchor.to);
}

/// Derivative of a force at node + arm, and of its moment about the node, by displacement and spatial spin of
/// the node; `tangent`: that of the force by the position at which it acts.
Mat6 anchor_slope(const Mat3& tangent, const Vec3& arm, const Vec3& force);

}  // namespace topple
