// Rest of rigid and elastic bodies under gravity, one alone or several that touch each other.
#pragma once

#include <span>

#include "solver/reduced/coupled_bodies.h"
#include "solver/state/step_result.h"

namespace topple {

/// Brings them to rest on planes and on each other, as settle() of step.h. `coupling`: of several, with the
/// stick springs of its pairs; null: of one alone. not_settled: the one that moved furthest has no rest, or
/// tips over by itself.
StepStatus settle_bodies(std::span<const ModelBody> bodies, MemberCoupling* coupling,
                         const Parameters& parameters, State& state);

}  // namespace topple
