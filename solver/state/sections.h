// Forces in the sections of all elements.
#pragma once

#include <vector>

#include "solver/element/section_forces.h"
#include "solver/state/state.h"

namespace topple {

/// Section forces of every element at `state`.
void section_forces(const Model& model, const State& state, std::vector<SectionForces>& forces);

}  // namespace topple
