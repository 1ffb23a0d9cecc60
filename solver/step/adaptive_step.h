// A step whose length follows Parameters::tolerance.
#pragma once

#include <functional>

#include "solver/state/step_result.h"
#include "solver/step/workspace_impl.h"

namespace topple {

/// Takes one step of size h, s, from the state into Workspace::Impl::next.
using TryStep = std::function<StepStatus(double h)>;

/// A step into `w.next` as long as the motion and the tolerance allow (step_control.h), to `until`, s, at
/// most.
StepStatus adaptive_step(const Model& model, const Parameters& parameters, const State& state,
                         Workspace::Impl& w, double until, const TryStep& try_step);

}  // namespace topple
