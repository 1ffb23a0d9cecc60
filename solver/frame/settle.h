// Rest under gravity.
#pragma once

#include "solver/frame/body_system.h"
#include "solver/frame/generalized_alpha.h"
#include "solver/state/step_result.h"

namespace topple {

/// Moves the bodies of `system` in `state` to where floors, walls, supports and each other hold them at rest
/// under gravity and their loads, by Newton steps on (M/sigma^2) (x - x_k) = f(x) with growing sigma. Loads
/// act as at t = 0: those without history in full, in statics (BodySystem::loads_grow) not at all. The
/// contact law's alpha, q and friction serve; the floor stands still. What weight and loads make yield flows
/// (hinges.h); in statics the balance that follows does that. not_settled: nothing holds a body, it tips over
/// by itself, or it collapses under its own weight; the element is at the node that went furthest.
StepStatus settle_system(BodySystem& system, const Parameters& parameters, State& state,
                         IntegratorScratch& scratch);

}  // namespace topple
