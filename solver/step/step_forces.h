// Forces at the end of the newest step.
#pragma once

#include <vector>

#include "solver/element/section_forces.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/state.h"
#include "solver/state/step_result.h"
#include "solver/step/workspace.h"

namespace topple {

/// Contact forces of planes at `state`, ordered by point then plane; the list lives until the next call with
/// `workspace`.
const std::vector<ContactForce>& contact_forces(const Model& model, const Parameters& parameters,
                                                const State& state, Workspace& workspace);
/// The same at the state that the newest step led to, under the parameters that it had: cheaper.
const std::vector<ContactForce>& contact_forces_after_step(const State& state, Workspace& workspace);

/// Forces between members of the last call of contact_forces.
const std::vector<MemberForce>& member_forces(Workspace& workspace);

/// Section forces of every element at the state that prepare, resume or the last successful step left; of
/// elastic bodies, as find_section_forces found them last.
const std::vector<SectionForces>& section_forces(Workspace& workspace);

/// Of an elastic body at `state`, that of the last contact_forces: finds its section forces; says by an upper
/// bound, which is cheaper, whether somewhere the stress may be more than `stress`, Pa, or sqrt(f + 1)
/// (plasticity.h) more than `yield_ratio`.
void find_section_forces(const State& state, int body, Workspace& workspace);
bool may_exceed(const State& state, int body, double stress, double yield_ratio, Workspace& workspace);

}  // namespace topple
