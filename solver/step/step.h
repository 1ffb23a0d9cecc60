// One step of a run.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/element/section_forces.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/profile.h"
#include "solver/state/state.h"
#include "solver/step/parallel_for.h"

namespace topple {

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

/// Scratch of the integrators; may be thrown away at any time. Sized for one model.
class Workspace {
 public:
  explicit Workspace(const Model& model);
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;
  /// Islands are stepped by the workers of `parallel`; results are the same bit for bit.
  void share(ParallelFor parallel);
  /// Off until it gets a clock; then steps take one thread.
  Profile& profile();
  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// bad_parameter or not_finite, with the body, where is_finite refuses the parameters or the state, without
/// `nodes` but for the per-node and per-element arrays; else ok. Numbers that a step goes by without handing
/// them on it would not find by itself.
StepStatus look_at_numbers(const Model& model, const Parameters& parameters, const State& state, bool nodes);

/// Brings the bodies to rest under gravity and the loads at t = 0 on floors, walls and supports: positions,
/// rotations and stick springs of `state` change, velocities become zero. Normal penalty forces of Eq. 2 with
/// stick springs serve for every law. not_settled: a body has nothing to rest on, tips over by itself, or
/// collapses.
StepStatus settle(const Model& model, const Parameters& parameters, State& state, Workspace& workspace);

/// Initial accelerations and energies of `state`; call once before the first step and after a change of
/// Parameters that is not seen by step.
void prepare(const Model& model, const Parameters& parameters, State& state, Workspace& workspace);

/// Fills the workspace from a state that was stepped before, such as a checkpoint; leaves the state as it is.
void resume(const Model& model, const State& state, Workspace& workspace);

/// Part of the largest energy exchanged so far that no step with contacts may leave unexplained: more is not
/// the motion of the model.
inline constexpr double k_lost_balance = 0.1;

/// Advances `state` by parameters.time_step, or in an adaptive run by what step_control.h allows, `until` at
/// most. On failure `state` is as before the call. bad_parameter: is_finite refuses them. energy_lost: the
/// step is much too long for what happens in it. The implicit methods halve their step within the call when
/// Newton does not converge or members would pass through each other unseen: a fixed one down to 1/64, an
/// adaptive one down to k_least_step.
StepStatus step(const Model& model, const Parameters& parameters, State& state, Workspace& workspace,
                double until = std::numeric_limits<double>::infinity());

/// Greatest stable step of central differences with all contacts closed, s; none before the first such step.
std::optional<double> explicit_limit(Workspace& workspace);

/// Contact forces of planes at `state`, ordered by point then plane; the list lives until the next call with
/// `workspace`. Also finds the section forces of bodies on the rung elastic.
const std::vector<ContactForce>& contact_forces(const Model& model, const Parameters& parameters,
                                                const State& state, Workspace& workspace);

/// Forces between members of the last call of contact_forces.
const std::vector<MemberForce>& member_forces(Workspace& workspace);

/// Section forces of every element at the state that prepare, resume or the last successful step left; of
/// bodies that are not frames, at that of the last contact_forces.
const std::vector<SectionForces>& section_forces(Workspace& workspace);

}  // namespace topple
