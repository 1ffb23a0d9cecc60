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

/// Sections that at a converged solution flow beyond their limits break (breaks), and elements whose ends
/// have turned by k_torn against each other: strains are known up to a full turn. True: the step must be
/// solved again.
bool break_sections(BodySystem& system, const BodyMotion& trial);

/// Statics alone. Where every end at a joint flows, their moments are those of yield whatever the joint's
/// turn is: nothing determines it, and nothing balances what is left of their sum. So one end of each such
/// joint stays elastic (ElementState::held): the one furthest below its surface at `start`, else that of
/// least flow. release_joints lets those flow again that end up beyond their surface, so that hold_joints
/// takes another one, and returns whether there were any: then the step must be solved again. Where each end
/// was released all of them flow.
void hold_joints(BodySystem& system, const BodyMotion& start, const BodyMotion& trial);
bool release_joints(BodySystem& system, const BodyMotion& trial);
/// Statics alone: holds every end that is not broken. When a section breaks most of what flows unloads, and
/// with all of that flowing on what is left is a mechanism.
void hold_ends(BodySystem& system);

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
