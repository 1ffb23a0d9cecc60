// What became of a step, and the forces at its end.
#pragma once

#include <string>

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/state.h"

namespace topple {

/// Part of the largest energy exchanged so far that no step with contacts may leave unexplained: more is not
/// the motion of the model.
inline constexpr double k_lost_balance = 0.1;

/// What became of a step. ok, or the first thing that went wrong and where.
struct StepStatus {
  enum class Kind {
    ok,
    newton_diverged,
    not_accurate,  ///< no step is short enough for the tolerance
    not_finite,
    singular,
    not_settled,
    step_too_long,
    no_equilibrium,
    uncontrolled,
    passed_through,
    energy_lost,
    bad_parameter
  };
  Kind kind = Kind::ok;
  double time = 0;  ///< s
  int body = -1;
  int element = -1;  ///< -1: not an element's fault
  int node = -1;
  int newton_iterations = 0;
  int rejected = 0;           ///< trial steps thrown away within this step
  double limit = 0;           ///< s, step_too_long: the greatest stable step
  double load_factor = 0;     ///< statics: where no equilibrium was found
  bool by_tolerance = false;  ///< the tolerance, not time_step, is what makes steps shorter

  bool ok() const { return kind == Kind::ok; }
  /// One sentence: what, when, where, what to try.
  std::string message(const Model& model) const;
};

/// Force of one plane on one contact point at the newest state, floor's frame.
struct ContactForce {
  int point;
  int plane;
  double depth;   ///< 1 - l/L, > 0
  double normal;  ///< N, along the plane's normal
  Vec3 force;     ///< N, on the point, normal and tangential
};

/// Force between two members at the newest state.
struct MemberForce {
  ElementPair elements;
  double s, t;   ///< 0..1, where on a and on b
  double depth;  ///< 1 - l/L, > 0
  Vec3 force;    ///< N, on a; b has its opposite
};

/// bad_parameter or not_finite, with the body, where is_finite refuses the parameters or the state, without
/// `nodes` but for the per-node and per-element arrays; else ok. Numbers that a step goes by without handing
/// them on it would not find by itself.
StepStatus look_at_numbers(const Model& model, const Parameters& parameters, const State& state, bool nodes);

}  // namespace topple
