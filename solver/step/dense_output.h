// The motion within a step that was taken.
#pragma once

#include "solver/model/model.h"
#include "solver/state/state.h"
#include "solver/step/workspace.h"

namespace topple {

/// At `time` between the ends of a step: positions, rotations and amplitudes by cubic Hermite polynomials,
/// with velocities as their derivatives (both of third order); stick springs, plastic strains and energies
/// linear; the rest as at the end, or as when it began for anchors and the number of the step. Nodes of
/// what is no frame are anywhere: place_nodes() places them.
void state_between(const Model& model, const State& start, const State& end, double time, State& at);

/// The same within the newest step, which ended in `end`, until another is tried with `workspace`; of planar
/// blocks motion and energies are exact.
void state_within_step(const Model& model, const State& end, double time, Workspace& workspace, State& at);

}  // namespace topple
