// The rung on which each body is computed, from step to step (ladder.h).
#pragma once

#include "solver/step/workspace.h"

namespace topple {

/// Every body on its base, or a frame where another is near. Nothing is booked: the run begins here.
void start_rungs(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w);

/// Contacts of what is not a frame, then the rungs on which `state` goes on.
void change_rungs(const Model& model, const Parameters& parameters, const Instant& now, State& state,
                  Workspace::Impl& w);

}  // namespace topple
