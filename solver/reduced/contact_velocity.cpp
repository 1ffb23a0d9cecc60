// The velocity that contact forces leave in an explicit substep of ReducedBody.
#include <algorithm>
#include <cmath>
#include <optional>

#include "solver/reduced/reduced_body.h"
#include "solver/reduced/rigid_solver.h"

namespace topple {
namespace {

constexpr double k_iterate_error = 1e-5;  // of the speed; of adaptive runs in this share of the tolerance:
constexpr double k_iterate_share = 0.01;
constexpr double k_contracts = 0.5;  // from one fixed-point iteration to the next, at least
constexpr int k_most_iterates = 3;
constexpr double k_velocity_error = 1e-7;  // of the speed, by Newton

}  // namespace

// By fixed-point iteration, to `error` of the speed; none: that does not contract.
[[gnu::always_inline]] inline ReducedBody::Solution ReducedBody::iterate_velocity(
    const ContactImpulse& impulse, double error, BodyVelocity& u, ContactLoads& loads, Amplitudes& load) {
  const auto& [law, r, h, free, m] = impulse;
  const double per_root_mass = m > 0 ? 1 / std::sqrt(mass_) : 0;
  double last = 0;
  for (int pass = 0; pass < k_most_iterates; ++pass) {
    const ContactLoads now = contacts_.evaluate_forces<false, ContactSums::loads>(law, u, 0);
    BodyVelocity next{mul_add(h / 2 / mass_, now.force, free.linear),
                      free.angular + r * (inverse_inertia_ * transposed_times(r, h / 2 * now.moment)),
                      {}};
    double size = velocity_size(reach_, u.linear - next.linear, u.angular - next.angular);
    if (m > 0) contacts_.modal_loads(m, load);
    for (int k = 0; k < m; ++k) {
      next.rate[k] = free.rate[k] + h / 2 * kick_[k] * load[k];
      size += per_root_mass * std::abs(u.rate[k] - next.rate[k]);
    }
    // what is left is a geometric series
    const double rate = last > 0 ? size / last : k_contracts;
    if (size * rate <= (1 - rate) * error * velocity_scale(reach_, u)) {
      loads = now;
      return Solution::found;
    }
    if (rate > k_contracts) break;
    u.linear = next.linear;
    u.angular = next.angular;
    for (int k = 0; k < m; ++k) u.rate[k] = next.rate[k];
    last = size;
  }
  return Solution::none;
}

// M - factor slope of the body's six unknowns; nothing yet in the rows and columns of its modes.
void ReducedBody::fill(double factor, const PackMat3& inertia, const ContactSlope& slope, int m,
                       ModeMatrix& matrix) const {
  const PackVec3 mass{mass_, mass_, mass_};
  set_block(matrix, 0, 0, diagonal(mass) - factor * slope.force_linear);
  set_block(matrix, 0, 3, -factor * slope.force_angular);
  set_block(matrix, 3, 0, -factor * slope.moment_linear);
  set_block(matrix, 3, 3, inertia - factor * slope.moment_angular);
  for (int k = 0; k < m; ++k) {
    for (int i = 0; i < 6; ++i) matrix[i][6 + k] = matrix[6 + k][i] = 0;
    for (int i = 0; i < m; ++i) matrix[6 + i][6 + k] = 0;
  }
}

// Factors of Newton's matrix for the forces found last with slopes.
void ReducedBody::factor_with_modes(const ContactImpulse& impulse, const PackMat3& inertia,
                                    ReducedScratch& w) const {
  const double h = impulse.h;
  const int m = impulse.modes;
  fill(h / 2, inertia, contacts_.slope(), m, w.matrix);
  for (int k = 0; k < m; ++k) w.matrix[6 + k][6 + k] = 1 / kick_[k];
  contacts_.add_slope_of_modes(-h / 2, m, w.matrix);
  factor(w.matrix, 6 + m);
  w.substep = h;
  w.touching = contacts_.hash();
}

// By Newton, with an old matrix while that serves.
[[gnu::always_inline]] inline ReducedBody::Solution ReducedBody::correct_velocity(
    const ContactImpulse& impulse, BodyVelocity& u, ContactLoads& loads, Amplitudes& load,
    ReducedScratch& w) {
  const auto& [law, r, h, free, m] = impulse;
  const double per_root_mass = m > 0 ? 1 / std::sqrt(mass_) : 0;
  const PackMat3 inertia = inertia_at(r);
  std::optional<RigidSolver> rigid;
  bool fresh = m == 0 || w.substep != h || w.touching != contacts_.hash();
  double last = 0;
  for (int iteration = 0; iteration < k_newton_iterations; ++iteration) {
    loads = fresh ? contacts_.evaluate_forces<true>(law, u, 0)
                  : contacts_.evaluate_forces<false, ContactSums::loads>(law, u, 0);
    PackVec3 x = mass_ * (u.linear - free.linear) - h / 2 * loads.force,
             y = inertia * (u.angular - free.angular) - h / 2 * loads.moment;
    double size = 0;
    if (m == 0) {
      if (fresh) rigid.emplace(mass_, inertia, h / 2, contacts_.slope());
      rigid->solve(x, y);
    } else {
      if (fresh) factor_with_modes(impulse, inertia, w);
      contacts_.modal_loads(m, load);
      double* const side = w.side;
      put({x, y, {}}, 0, side);
      for (int k = 0; k < m; ++k) side[6 + k] = (u.rate[k] - free.rate[k]) / kick_[k] - h / 2 * load[k];
      solve(w.matrix, side, 6 + m);
      x = {side[0], side[1], side[2]};
      y = {side[3], side[4], side[5]};
      for (int k = 0; k < m; ++k) {
        u.rate[k] -= side[6 + k];
        size += per_root_mass * std::abs(side[6 + k]);
      }
    }
    u.linear = u.linear - x;
    u.angular = u.angular - y;
    size += velocity_size(reach_, x, y);
    // what is left after the correction: its rate, or its square over that of the smoothing
    const double rate = fresh ? std::min(1., size / law.bend) : last > 0 ? size / last : 1;
    if (size * rate <= k_velocity_error * velocity_scale(reach_, u)) {
      loads.force = 2 / h * mass_ * (u.linear - free.linear);
      loads.moment = 2 / h * (inertia * (u.angular - free.angular));
      for (int k = 0; k < m; ++k) load[k] = 2 / h / kick_[k] * (u.rate[k] - free.rate[k]);
      return Solution::found;
    }
    fresh = iteration > 0 && rate > k_newton_good_rate;
    last = size;
  }
  return Solution::none;
}

// The velocity u that half a step of the contact forces at it leaves, and these forces:
//   u = free + (h/2) M^-1 F(u)
// Begins with the u that is expected; by fixed-point iteration where that contracts, else by Newton.
ReducedBody::Solution ReducedBody::solve_velocity(const Parameters& parameters, const ContactImpulse& impulse,
                                                  BodyVelocity& u, ContactLoads& loads, Amplitudes& load,
                                                  ReducedScratch& w) {
  const double error = parameters.adaptive ? std::min(k_iterate_error, k_iterate_share * parameters.tolerance)
                                           : k_iterate_error;
  return iterate_velocity(impulse, error, u, loads, load) == Solution::found
             ? Solution::found
             : correct_velocity(impulse, u, loads, load, w);
}

}  // namespace topple
