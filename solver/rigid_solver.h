// Six equations of a rigid body in blocks of three.
#pragma once

#include "solver/body_contacts.h"

namespace topple {

/// (M - factor slope) (x, y) = right side, M = (m, inertia): of linear and angular velocity.
class RigidSolver {
 public:
  RigidSolver() = default;
  RigidSolver(double mass, const PackMat3& inertia, double factor, const ContactSlope& slope) {
    const PackVec3 m{mass, mass, mass};
    b_ = -factor * slope.force_angular;
    const PackMat3 c = -factor * slope.moment_linear;
    a_inverse_ = inverse(diagonal(m) - factor * slope.force_linear);
    c_a_inverse_ = c * a_inverse_;
    rest_inverse_ = inverse(inertia - factor * slope.moment_angular - c_a_inverse_ * b_);
  }
  void solve(PackVec3& x, PackVec3& y) const {
    y = rest_inverse_ * (y - c_a_inverse_ * x);
    x = a_inverse_ * (x - b_ * y);
  }

 private:
  PackMat3 a_inverse_, b_, c_a_inverse_, rest_inverse_;  // the last: of what elimination leaves
};

}  // namespace topple
