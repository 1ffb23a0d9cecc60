// Rest under gravity.
#pragma once

#include "solver/body_system.h"
#include "solver/generalized_alpha.h"
#include "solver/step.h"

namespace topple {

/// Moves the bodies of `system` in `state` to where gravity, floors, walls and supports hold it at rest, by
/// Newton steps on (M/sigma^2) (x - x_k) = f(x) with growing sigma. `law`: its alpha, q and friction serve;
/// loads and floor motion do not. Elements keep the hinges they have: what weight makes yield does so in the
/// first steps.
StepStatus settle_system(BodySystem& system, const Parameters& parameters, State& state,
                         IntegratorScratch& scratch);

}  // namespace topple
