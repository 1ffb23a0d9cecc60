// Plastic hinges and fracture of a system. Sections flow within each evaluation (plasticity.h); for dynamics
// and statics alike:
//
//   system.load_memory(state);                       // once per step
//   do solve(trial);                                 // to convergence, evaluate_with_tangent
//   while (break_sections(system, trial));
//   energy = commit_hinges(system, start, trial, state);
#pragma once

#include "solver/frame/body_system.h"

namespace topple {

/// Of f, yield_function: below minus this a hinge goes. Hysteresis against chatter.
inline constexpr double k_unloading = 1e-3;

/// Sections that at a converged solution flow beyond their limits break (breaks). True: the step must be
/// solved again.
bool break_sections(BodySystem& system, const BodyMotion& trial);

/// Statics alone: where every end at a joint flows, their moments leave the joint's turn undetermined, within
/// what flowed; unlike forces in them leave a moment that only one which stays elastic can balance. So one
/// end of each such joint is held (ElementState::held): that furthest below its surface at `start`, as a step
/// before left it, then that of least flow. release_joints: lets those flow again that end up beyond their
/// surface, in favour of another one; true: solve again. Where each was released all flow.
void hold_joints(BodySystem& system, const BodyMotion& start, const BodyMotion& trial);
bool release_joints(BodySystem& system, const BodyMotion& trial);

/// Takes the flow of the accepted solution into system.elements and `state`; hinges are where it flowed, and
/// go when loaded k_unloading below yield. Returns the energy that flow and fracture took, J, by the
/// trapezoidal rule like all work.
double commit_hinges(BodySystem& system, const BodyMotion& start, const BodyMotion& end, State& state);

/// Whether a fully plastic section breaks: one of
///   |kappa_y| size_z/2,  |kappa_z| size_y/2,  gamma_x (tension only)
/// reaches fracture_strain, or an elastic shear strain V/(k G A) reaches sqrt(3) fracture_strain (von Mises).
/// kappa and gamma_x are the whole strain of the element: flow is spread over its length.
bool breaks(const Model& model, const Element& element, const BeamStrain& strain,
            const SectionForces& forces);

}  // namespace topple
