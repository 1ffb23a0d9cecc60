// An implicit substep of a ReducedBody (method: reduced_body.h) in phases, so that bodies which touch each
// other can go through it together:
//   twice: reach, add, residual and correct until the stage is solved, then end_stage
//   error; arrive; then finish, or give_up at any time
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "solver/math/elementary.h"
#include "solver/reduced/reduced_body.h"
#include "solver/reduced/rigid_solver.h"

namespace topple {

/// A substep and what all bodies share in it.
struct SubstepSpan {
  static constexpr double k_gamma = 0.29289321881345254;  ///< 1 - 1/sqrt(2)
  static constexpr double k_early =
      0.35355339059327379;  ///< sqrt(2)/4, what the start and the first stage weigh

  const Parameters& parameters;
  const StepInputs &start, &end;
  double h, gamma_dt, early;  ///< s: its size, k_gamma h and k_early h
  StepInputs middle;          ///< where the first stage ends

  SubstepSpan(const Parameters& parameters_, const StepInputs& start_, const StepInputs& end_, double h_)
      : parameters(parameters_),
        start(start_),
        end(end_),
        h(h_),
        gamma_dt(k_gamma * h),
        early(k_early * h),
        middle(parameters, start.time + 2 * gamma_dt, start) {}

  /// Integral over the substep of what has these values at its start and at the ends of its stages: with the
  /// weights of the method, and to third order (Hosea and Shampine 1996).
  double by_method(double at_start, double first, double second) const {
    return early * (at_start + first) + gamma_dt * second;
  }
  double integral(double at_start, double first, double second) const {
    return ((h - early) * at_start + (h + 3 * early) * first + gamma_dt * second) / 3;
  }
};

/// How an implicit substep went, unless it is reached with nothing changed, and its local error over the
/// allowed one.
struct ImplicitOutcome {
  SubstepEnd end;
  double error;  ///< local error over the allowed one
  /// Of a substep with this error; a stage that was not found counts as a large one.
  static ImplicitOutcome given_up(double error) {
    return error < k_no_stage ? ImplicitOutcome{SubstepEnd::too_long, error}
                              : ImplicitOutcome{SubstepEnd::unsolved, k_no_stage};
  }
  static constexpr double k_no_stage = 1e3;
};

/// Newton's iterations for the stages of a substep, of one body or of several. Its matrix serves as long as
/// corrections shrink well.
struct StageNewton {
  /// Of the speed: far below the local error that a tolerance allows, above what rounding leaves.
  static double error(double tolerance) { return std::clamp(1e-4 * tolerance, 1e-11, 1e-7); }

  bool fresh = true;  ///< the next iteration makes the matrix anew
  double last = std::numeric_limits<double>::infinity();

  void begin_stage() { last = std::numeric_limits<double>::infinity(); }
  /// Share of a correction of `size`, m/s, that is left after it: as before, or its square over that of the
  /// smoothing.
  double rate(double size, const PreparedLaw& law) const {
    return fresh ? std::min(1., size / law.bend) : size / last;
  }
  void go_on(double size, double rate, int iteration) {
    fresh = rate > k_newton_good_rate && (!fresh || iteration > 0);
    last = size;
  }
};

/// Of one body, whose contacts at the start were found last.
class ImplicitSubstep {
 public:
  /// There is a BodyContacts::ScratchLease. `s` and `stick` become those at the end. `speed`, m/s: what
  /// errors of the velocity are measured by, speed_of() or more.
  ImplicitSubstep(ReducedBody& body, const SubstepSpan& span, BodyState& s, std::span<Vec3> stick,
                  double speed);
  /// Greatest speed of a point of the body, an upper bound, m/s.
  static double speed_of(const ReducedBody& body, const BodyState& s) {
    return s.velocity.norm() + body.reach_ * s.angular_velocity.norm();
  }

  const BodyState& start() const { return before_; }
  const BodyState& pose() const { return s_; }     ///< that reach found
  const PackMat3& rotation() const { return r_; }  ///< its matrix
  const BodyVelocity& velocity() const { return now_->u; }
  int modes() const { return modes_; }

  /// Places the body where the stage's velocity leads and finds what acts there; with_slope: derivatives too.
  void reach(bool with_slope);
  /// More of what acts there: N, N m about the centre of gravity, N/sqrt(kg).
  void add(const BodyVelocity& load);
  /// What is left of  M u = momentum + gamma_dt (field + forces): N s, N m s, m sqrt(kg)/s.
  BodyVelocity residual() const;
  /// M - gamma_dt d(forces)/d(u) where reach with_slope led; of stick springs and modes alone.
  RigidSolver solver() const;
  RigidSolver stick_solver() const;
  void fill(ModeMatrix& matrix) const;
  void fill_with_sticks(ModeMatrix& matrix) const;
  /// Takes it off the velocity.
  void correct(const BodyVelocity& by);
  double size_of(const BodyVelocity& correction) const;  ///< m/s
  double scale() const;                                  ///< m/s, what errors of the velocity are measured by
  void end_stage();
  /// Local error of the velocity times M, as residual; to be multiplied with the inverse matrix of stick
  /// springs. Then its size over that which is allowed.
  BodyVelocity error() const;
  double over_allowed(const BodyVelocity& error) const;

  /// Where the last correction leads.
  void arrive();
  /// Books, and sets what acts at the end, with stick springs after slipping.
  void finish(StepEnergy& booked);
  void give_up();

 private:
  // What the unknowns of a stage start from: m, rad, N s, N m s, modes.
  struct Origin {
    PackVec3 position, turn, momentum, spin;
    Amplitudes amplitude, rate;
  };
  // What acts: N, N m; on the modes, N/sqrt(kg), without their own springs; W.
  struct Acting {
    PackVec3 force, moment;
    Amplitudes load;
    double damping_power, friction_power;
  };
  // At its solution `acting` is what the momentum says.
  struct Stage {
    BodyVelocity u;
    PackVec3 spin;  // N m s, angular momentum
    Acting acting;
  };

  PackVec3 spin() const { return r_ * (body_.inertia_ * transposed_times(r_, now_->u.angular)); }
  double spring(int k) const { return body_.basis_->frequency[k] * body_.basis_->frequency[k]; }
  double modal_mass(int k) const { return 1 + span_.gamma_dt * spring(k) * (span_.gamma_dt + damping_); }
  // What accelerates mode k.
  double pull(const Acting& acting, double amplitude, double rate, int k) const {
    return acting.load[k] - spring(k) * (amplitude + damping_ * rate);
  }
  void guess_rates(const Amplitudes& load);
  void book_modes(StepEnergy& booked) const;

  ReducedBody& body_;
  const SubstepSpan& span_;
  BodyState& s_;
  const std::span<Vec3> stick_;
  const BodyState before_;
  const int modes_;
  const PackMat3 r0_, inverse_inertia_;
  const double allowed_;
  double damping_ = 0;  // s, damping_time()
  Acting start_;
  PackVec3 velocity0_, omega0_, spin0_, gravity_, field_, turning_;
  PackMat3 r_;
  Origin from_;
  Stage one_, two_, *now_ = &one_;
};

/// Advances a system by implicit substeps, as long as errors and landings allow; as ReducedBody::advance.
/// `system` has
///   double first(const ContactLaw&)   s, a first guess at a substep after a touch
///   double next_kink(double within)   s, the time until something touches, or ceases to slip on a plane
///   double wanted(), void want(double)   s, the substep that is tried next; 0: none was taken yet
///   ImplicitOutcome substep(const SubstepSpan&)
template <class System>
StepStatus::Kind advance_by_substeps(System& system, const Parameters& parameters, const StepInputs& start,
                                     const StepInputs& end, double h) {
  constexpr double k_safety = 0.9, k_most_growth = 3, k_most_shrinking = 5;
  constexpr double k_least_substep = 1e-4;  // of the first one
  StepInputs from = start;
  double left = h, growth = k_most_growth;
  while (left > 0) {
    const double first = system.first(from.law);
    double size = system.wanted() > 0 ? system.wanted() : first;
    if (const double kink = system.next_kink(std::min(size, left)); kink < size)
      size = std::max(kink, std::min(size, first));
    const double wanted = size;
    if (left < 2 * size) size = left <= size ? left : left / 2;
    const bool last = size == left;
    const StepInputs to = last ? end : StepInputs(parameters, from.time + size, from);
    const ImplicitOutcome substep = system.substep({parameters, from, to, size});
    const bool good = substep.end == SubstepEnd::reached;
    const double next = size * std::clamp(k_safety / elementary::cbrt(substep.error), 1 / k_most_shrinking,
                                          good ? growth : k_safety);
    if (!good) {
      if (size < k_least_substep * first)
        return parameters.adaptive && substep.end == SubstepEnd::too_long ? StepStatus::Kind::not_accurate
                                                                          : StepStatus::Kind::newton_diverged;
      growth = 1;
      system.want(next);
      continue;
    }
    growth = k_most_growth;
    system.want(size < wanted ? std::max(next, wanted) : next);
    left = last ? 0 : left - size;
    from = to;
  }
  return StepStatus::Kind::ok;
}

}  // namespace topple
