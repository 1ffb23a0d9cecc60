// Rest under gravity.
#pragma once

#include "solver/frame/body_system.h"
#include "solver/frame/generalized_alpha.h"
#include "solver/state/step_result.h"

namespace topple {

/// Moves the bodies of `system` in `state` to where floors, walls, supports and each other hold them at rest
/// under gravity and their loads, by Newton steps on (M/sigma^2) (x - x_k) = f(x) (find_rest). Loads act as
/// at t = 0: those without history in full, in statics (BodySystem::loads_grow) not at all. Contacts follow
/// law_at_rest; the floor stands still. Sections that yield flow (hinges.h); in statics they do so in the
/// equilibrium that follows. not_settled: nothing holds a body, it tips over by itself, or it collapses under
/// its own weight; node and element are where it went furthest or the tangent is singular.
StepStatus settle_system(BodySystem& system, const Parameters& parameters, State& state,
                         IntegratorScratch& scratch);

}  // namespace topple
