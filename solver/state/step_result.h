// What became of a step, and the forces at its end.
#pragma once

#include <string>

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/state.h"

namespace topple {

/// Largest EnergyLedger::balance_error that a step with contacts may end with: beyond it the motion is not
/// that of the model.
inline constexpr double k_lost_balance = 0.1;

/// Whether an equilibrium is stable under constant loads: whether its tangent is positive definite. Of forces
/// that keep their direction; moments about fixed axes have no potential.
struct Stability {
  enum class Loss {
    none,
    limit_point,  ///< the loads do work along the mode: the path has passed a greatest load
    buckling,     ///< they do none: the body leaves the path sideways
    mechanism,    ///< as limit_point, while hinges flow
    fracture      ///< StepStatus::element breaks, and what is left does not carry the loads
  };
  Loss loss = Loss::none;
  int negative_pivots = -1;       ///< of the tangent: directions in which it runs away; -1: not known
  int node = -1;                  ///< index into the model: moves most in the mode of the first of them,
  Vec3 direction = Vec3::Zero();  ///< along this unit vector, world axes

  bool stable() const { return negative_pivots <= 0; }
};

/// Why a body has no rest. leaves: it has gone a quarter of its size and nothing holds it; tips_over: its
/// balance is none that lasts; not_found: neither, so there may be one.
enum class NoRest { leaves, tips_over, not_found };

/// What became of a step: ok, or the first thing that went wrong, when and where.
struct StepStatus {
  enum class Kind {
    ok,
    newton_diverged,  ///< no converged solution
    not_accurate,     ///< no step is short enough for the tolerance
    not_finite,       ///< the motion is not (is_finite)
    singular,         ///< tangent; a part may be free to move
    not_settled,      ///< a body finds no rest under gravity
    step_too_long,    ///< above `limit`, for an explicit method
    no_equilibrium,   ///< statics: none at `load_factor`, or no stable one where that is asked for
    uncontrolled,     ///< statics: the loads do not move the controlled direction
    passed_through,   ///< members would pass through each other unseen
    energy_lost,      ///< k_lost_balance is exceeded
    bad_parameter     ///< a parameter is no finite number
  };
  Kind kind = Kind::ok;
  double time = 0;  ///< s
  int body = -1;    ///< index into the model, as the next two; -1: of none
  int element = -1;
  int node = -1;
  int newton_iterations = 0;
  int rejected = 0;                    ///< trial steps thrown away within this step
  double limit = 0;                    ///< s, step_too_long: the greatest stable step
  NoRest no_rest = NoRest::not_found;  ///< not_settled
  double load_factor = 0;              ///< no_equilibrium: at which none was found
  Stability stability = {};            ///< statics: of the equilibrium
  bool by_tolerance = false;           ///< the tolerance, not time_step, is what makes steps shorter

  bool ok() const { return kind == Kind::ok; }
  /// One sentence for the user: what, when, where, what to try.
  std::string message(const Model& model) const;
};

/// Force of one plane on one contact point at a state, floor's frame.
struct ContactForce {
  int point;      ///< index into Model::contact_points
  int plane;      ///< index into Model::planes
  double depth;   ///< 1 - l/L, > 0
  double normal;  ///< N, along the plane's normal
  Vec3 force;     ///< N, on the point, normal and tangential
};

/// Force between two parts at a state, floor's frame.
struct MemberForce {
  ElementPair elements;
  double s, t;   ///< 0..1, where on a and on b (NearestPoints)
  double depth;  ///< 1 - l/L, > 0
  Vec3 force;    ///< N, on a; b has its opposite
  double u = 0;  ///< of a panel: it is touched at (t, u), PanelPlace::r
};

/// That of a touch, on the parts and at the places where it acts.
MemberForce member_force(const MemberTouch& touch, const MemberPair& pair);

/// bad_parameter or not_finite, with the body, where is_finite refuses the parameters or the state (`nodes`:
/// as there); else ok. A step calls it first: a bad number need not show in its result.
StepStatus look_at_numbers(const Model& model, const Parameters& parameters, const State& state, bool nodes);

}  // namespace topple
