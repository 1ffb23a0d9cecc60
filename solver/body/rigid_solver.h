// Newton's six equations of a rigid body, solved in blocks of three.
#pragma once

#include "solver/body/body_contacts.h"

namespace topple {

/// Solves (M - factor slope) (x, y) = right side with M = diag(m 1, inertia). factor: s. Right side: N s and
/// N m s; x, y: m/s and rad/s.
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
  /// x, y: the right side, then the solution.
  [[gnu::always_inline]] void solve(PackVec3& x, PackVec3& y) const {
    y = rest_over_ * (rest_ * (y - a_over_ * (c_a_ * x)));
    x = a_over_ * (a_ * (x - b_ * y));
  }

 private:
  // Adjugates, and 1 over the determinants apart: divisions are slow, so products need not wait for them.
  // `rest` is the Schur complement of the first block.
  PackMat3 a_, b_, c_a_, rest_;
  double a_over_, rest_over_;
};

}  // namespace topple
