// Explicit time integration.
#pragma once

#include "solver/frame/body_system.h"
#include "solver/frame/generalized_alpha.h"
#include "solver/state/energy.h"
#include "solver/state/step_result.h"

namespace topple {

/// Advances the bodies of `system` in `state` by h from time t with central differences in velocity form;
/// rotations likewise in material axes. Velocity-dependent contact forces are taken at the new velocity, node
/// by node; between members by sweeps over what touches. not_finite: the new motion is not; their part of
/// `state` is then undefined.
StepStatus advance_central_difference(BodySystem& system, const Parameters& parameters, State& state,
                                      double t, double h, IntegratorScratch& scratch, StepEnergy& energy);

/// Greatest stable step of central differences, s: 2 over the highest frequency of the unloaded reference
/// pose, by power iteration on M^-1 K. With a law every contact point holds on to every plane: Eq. 2 at
/// 1 - l/L = 1 (below q = 1: at 0.01, where it is stiffer) along the normal, the stick spring across it;
/// where there are more bodies every node holds on to one member likewise, before hardening.
/// `damping`: damping_time a of the bodies, s; it acts at the velocity half a step before, which makes the
/// limit sqrt(a^2 + 4/w^2) - a.
/// `busiest`: index into the model of the node that has most of the kinetic energy of that mode.
double explicit_limit(BodySystem& system, const ContactLaw* law = nullptr, double damping = 0,
                      int* busiest = nullptr);

}  // namespace topple
