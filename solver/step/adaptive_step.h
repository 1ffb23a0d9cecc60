// A step whose length follows Parameters::tolerance.
#pragma once

#include "solver/state/step_result.h"
#include "solver/step/workspace_impl.h"

namespace topple {

/// One step of size h from `state` into `w.next`, with implicit methods that halve theirs so often at most.
StepStatus try_step(const Model& model, const Parameters& parameters, const State& state, double h,
                    int halvings, Workspace::Impl& w);

/// A step into `w.next`, `until` at most, that the motion and the tolerance allow.
StepStatus adaptive_step(const Model& model, const Parameters& parameters, const State& state,
                         Workspace::Impl& w, double until);

}  // namespace topple
