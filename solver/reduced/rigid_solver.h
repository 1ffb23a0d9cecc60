// Newton's six equations of a rigid body, solved in blocks of three.
#pragma once

#include <cmath>

#include "solver/reduced/body_contacts.h"

namespace topple {

inline constexpr int k_newton_iterations = 20;     ///< of Newton, for a velocity
inline constexpr double k_newton_good_rate = 0.1;  ///< of Newton with an old matrix
inline constexpr double k_slow_speed = 1e-3;       ///< m/s, below it errors of a velocity are absolute

/// m/s, of a linear and an angular velocity; reach: m.
inline double velocity_size(double reach, const PackVec3& linear, const PackVec3& angular) {
  const auto sum_of = [](const PackVec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  return sum_of(linear) + reach * sum_of(angular);
}
/// What the errors of a velocity are measured by, m/s.
inline double velocity_scale(double reach, const BodyVelocity& u) {
  return k_slow_speed + velocity_size(reach, u.linear, u.angular);
}

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
