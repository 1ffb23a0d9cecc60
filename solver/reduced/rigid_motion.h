// How two rigid bodies come closer.
#pragma once

#include <algorithm>

#include "solver/math/types.h"

namespace topple {

/// Of a rigid body, from one instant to another.
struct RigidMotion {
  Vec3 centre = Vec3::Zero();  ///< m, where it is at the first
  double reach = 0;            ///< m, of its points from there
  Vec3 shift = Vec3::Zero();   ///< m, of the centre
  Quat turn = Quat::Identity();

  /// m, bound of the way of its points.
  double way() const { return shift.norm() + 2 * reach * turn.vec().norm(); }
};

/// Bound of the way by which points of two bodies come closer, m: the greatest displacement of points of the
/// smaller body relative to the other body, extended to where they are.
inline double approach(const RigidMotion& a, const RigidMotion& b) {
  if (a.reach > b.reach) return approach(b, a);
  const Vec3 arm = a.centre - b.centre;
  const double against = (a.shift - b.shift - (b.turn * arm - arm)).norm() +
                         2 * a.reach * (b.turn.conjugate() * a.turn).vec().norm();
  return std::min(against, a.way() + b.way());
}

}  // namespace topple
