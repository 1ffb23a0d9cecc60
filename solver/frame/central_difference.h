// Explicit time integration.
#pragma once

#include "solver/frame/body_system.h"
#include "solver/frame/generalized_alpha.h"
#include "solver/state/energy.h"
#include "solver/state/step_result.h"

namespace topple {

/// Advances the bodies of `system` in `state` with central differences in velocity form (velocity Verlet),
/// rotations likewise in material axes; StepSpan::halvings is of no use to it. Contact forces are taken at
/// the new velocity: with planes node by node, between members by Gauss-Seidel sweeps. not_finite: the new
/// motion is not; their part of `state` is then undefined.
StepStatus advance_central_difference(BodySystem& system, const StepSpan& span, State& state,
                                      IntegratorScratch& scratch, StepEnergy& energy);

/// Likewise, but positions run ahead by 0.1 h^2 (a - a'), a the acceleration and a' (a' + a)/2 at each step,
/// State::algorithmic_acceleration: Tchamwa & Wielgosz's (1999) dissipation, of high frequencies alone. A
/// mode of angular frequency w that is slow for the step has the ratio 0.1 (w h)^3 to critical, none more
/// than 0.07; stable below w h = 1.87. What it takes is numerical energy.
StepStatus advance_damped_central_difference(BodySystem& system, const StepSpan& span, State& state,
                                             IntegratorScratch& scratch, StepEnergy& energy);

/// Greatest stable step of central differences, s: 2/w, w the highest angular frequency of the unloaded
/// reference pose with its anchors, by power iteration on M^-1 K.
/// law: every contact point is closed and sticks on every plane with the stiffness of stiffness_bound, and
///   every node likewise on one member where there are other bodies. Null: no contacts.
/// damping: damping_time a, s, of the bodies. Viscous forces are those of the velocity half a step before,
///   which makes the limit sqrt(a^2 + 4/w^2) - a.
/// busiest: index into the model of the node with most of the kinetic energy in that mode.
double explicit_limit(BodySystem& system, const ContactLaw* law = nullptr, double damping = 0,
                      int* busiest = nullptr);

}  // namespace topple
