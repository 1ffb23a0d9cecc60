// A step whose length follows Parameters::tolerance.
#pragma once

#include "solver/state/step_result.h"
#include "solver/step/workspace_impl.h"

namespace topple {

/// One step of size h, s, from `state` into `w.next`. `halvings`: how often the implicit methods of frames
/// may halve h when Newton does not converge. passed_through: nodes moved too far for the pairs looked at.
StepStatus try_step(const Model& model, const Parameters& parameters, const State& state, double h,
                    int halvings, Workspace::Impl& w);

/// A step into `w.next` as long as the motion and the tolerance allow (step_control.h), to `until`, s, at
/// most.
StepStatus adaptive_step(const Model& model, const Parameters& parameters, const State& state,
                         Workspace::Impl& w, double until);

}  // namespace topple
