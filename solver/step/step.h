// One step of a run.
#pragma once

#include <limits>
#include <optional>

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/state.h"
#include "solver/state/step_result.h"
#include "solver/step/step_forces.h"
#include "solver/step/workspace.h"

namespace topple {

/// Brings the bodies to rest under gravity and the loads at t = 0 on floors, walls and supports: positions,
/// rotations and stick springs of `state` change, velocities become zero. Normal penalty forces of Eq. 2 with
/// stick springs serve for every law. not_settled: a body has nothing to rest on, tips over by itself, or
/// collapses.
StepStatus settle(const Model& model, const Parameters& parameters, State& state, Workspace& workspace);

/// Sets levels, anchors, accelerations and energies of `state`, where a run begins: call once before the
/// first step, or to begin anew from a state with other parameters.
void prepare(const Model& model, const Parameters& parameters, State& state, Workspace& workspace);

/// Fills the workspace from a state that was stepped before, such as a checkpoint; leaves the state as it is.
void resume(const Model& model, const State& state, Workspace& workspace);

/// Advances `state` by parameters.time_step, or in an adaptive run by what step_control.h allows, to `until`,
/// s, at most. On failure `state` is as before the call. bad_parameter: is_finite refuses them. energy_lost:
/// the step is much too long for what happens in it. The implicit methods halve their step within the call
/// when Newton does not converge or members would pass through each other unseen: a fixed one down to 1/64,
/// an adaptive one down to k_least_step. A fixed step in which frames that touch something lose energy is
/// taken again in 4, 16, 64 or 256 parts (Parameters::resolves_contacts).
StepStatus step(const Model& model, const Parameters& parameters, State& state, Workspace& workspace,
                double until = std::numeric_limits<double>::infinity());

/// Greatest stable step of central differences with all contacts closed, s; none before the first such step.
std::optional<double> explicit_limit(Workspace& workspace);

}  // namespace topple
