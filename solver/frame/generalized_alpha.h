// Implicit time integration of positions and rotations (a Lie group).
#pragma once

#include <vector>

#include "solver/frame/body_system.h"
#include "solver/state/energy.h"
#include "solver/state/profile.h"
#include "solver/state/step_result.h"

namespace topple {

/// Coefficients of the generalized-alpha method (Chung & Hulbert 1993) from its spectral radius at infinity;
/// without averaging, alpha_m = alpha_f = 0, it is Newmark's.
struct GeneralizedAlpha {
  double alpha_m, alpha_f, gamma, beta;
  explicit GeneralizedAlpha(double rho)
      : alpha_m((2 * rho - 1) / (rho + 1)),
        alpha_f(rho / (rho + 1)),
        gamma(0.5 + alpha_f - alpha_m),
        beta(0.25 * (gamma + 0.5) * (gamma + 0.5)) {}
  static GeneralizedAlpha newmark(double beta, double gamma);
  /// Newmark's of second order for rigid bodies among frames: nothing in these is stiff, and they come and
  /// go with the accelerations of their balance. Velocities follow displacements as the frames' do.
  GeneralizedAlpha of_rigid() const { return newmark(0.5 * beta / gamma, 0.5); }
};

/// Scratch of the integrators for one system.
struct IntegratorScratch {
  BodyMotion start, trial;
  std::vector<Vec3> travel, turn;  ///< unknowns: displacement, m, and rotation vector (material) of the step
  std::vector<Vec3> acceleration, angular_acceleration, algorithmic, algorithmic_angular;
  /// Accelerations at the start of the step, and the travel and turn for which the algorithmic ones at its
  /// end are zero.
  std::vector<Vec3> balance0, angular_balance0, algorithmic0, algorithmic_angular0, coasting, coasting_turn;
  std::vector<double> right_hand_side;     ///< six per node
  std::vector<double> kept_residual, way;  ///< line search: residual, and correction, six per node
  std::vector<Vec3> kept_travel, kept_turn;
  Contacts contacts_start;
  Profile* profile = nullptr;
};

/// Advances the bodies of `system` in `state` with the balance of forces taken at the end of the step (Brüls
/// & Cardona 2010). Newton's method to convergence; a step that does not converge is halved, at most
/// StepSpan::halvings times. Failures: newton_diverged, not_finite, singular, passed_through; their part of
/// `state` is then undefined.
StepStatus advance_generalized_alpha(BodySystem& system, const StepSpan& span,
                                     const GeneralizedAlpha& coefficients, State& state,
                                     IntegratorScratch& scratch, StepEnergy& energy);

}  // namespace topple
