// Six equations of a rigid body in blocks of three.
#pragma once

#include "solver/body/body_contacts.h"

namespace topple {

/// (M - factor slope) (x, y) = right side, M = (m, inertia): of linear and angular velocity.
class RigidSolver {
 public:
  RigidSolver() = default;
  [[gnu::always_inline]] RigidSolver(double mass, const PackMat3& inertia, double factor,
                                     const ContactSlope& slope) {
    const PackVec3 m{mass, mass, mass};
    const PackAdjugate<double> a(diagonal(m) - factor * slope.force_linear);
    a_ = a.matrix;
    a_over_ = 1 / a.determinant;
    b_ = -factor * slope.force_angular;
    c_a_ = -factor * slope.moment_linear * a_;
    const PackAdjugate<double> rest(inertia - factor * slope.moment_angular - a_over_ * (c_a_ * b_));
    rest_ = rest.matrix;
    rest_over_ = 1 / rest.determinant;
  }
  [[gnu::always_inline]] void solve(PackVec3& x, PackVec3& y) const {
    y = rest_over_ * (rest_ * (y - a_over_ * (c_a_ * x)));
    x = a_over_ * (a_ * (x - b_ * y));
  }

 private:
  // Adjugates, and 1 over the determinants, which are long in coming; `rest` is what elimination leaves.
  PackMat3 a_, b_, c_a_, rest_;
  double a_over_, rest_over_;
};

}  // namespace topple
