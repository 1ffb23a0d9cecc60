// Forces in the sections of all elements.
#pragma once

#include <vector>

#include "solver/element/section_forces.h"
#include "solver/state/state.h"

namespace topple {

/// Section forces of every element at its stress point, from the nodes of `state`; none beyond yield, zero
/// where a body is on a level without stresses.
void section_forces(const Model& model, const State& state, std::vector<SectionForces>& forces);
/// Of one body's elements, into those of the model.
void section_forces(const Model& model, const State& state, int body, std::vector<SectionForces>& forces);

}  // namespace topple
