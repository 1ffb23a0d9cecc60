// Explicit time integration.
#pragma once

#include "solver/body_system.h"
#include "solver/energy.h"
#include "solver/generalized_alpha.h"
#include "solver/step.h"

namespace topple {

/// Advances one body of `state` by h from time t with central differences in velocity form; rotations
/// likewise in material axes. Velocity-dependent contact forces are taken at the new velocity, node by node.
/// not_finite: the new motion is not; the body's part of `state` is then undefined.
StepStatus advance_central_difference(BodySystem& system, const Parameters& parameters, State& state,
                                      double t, double h, IntegratorScratch& scratch, StepEnergy& energy);

/// Greatest stable step of central differences, s: 2 over the highest frequency of the unloaded reference
/// pose, by power iteration on M^-1 K.
double explicit_limit(BodySystem& system);

}  // namespace topple
