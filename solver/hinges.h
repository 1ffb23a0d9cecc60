// Plastic hinges of a body: when they form, move and break. For dynamics and statics alike:
//
//   system.load_elements(state);                     // once per step
//   HingeStep hinges;
//   do solve(trial);                                 // to convergence, evaluate_with_tangent
//   while (update_hinges(system, start, trial, hinges));
//   energy = commit_hinges(system, start, trial, state);
//
// An element in the elastic state has its stress point where the scheme puts it (Model::scheme). It is checked
// at both ends by equilibrium; where f > 0, the stress point moves there, at the start of the step, and the
// step is solved again with the section's flow (plasticity.h). When f falls below -k_unloading at the hinge
// the step is solved again with the point moved back. Moves keep the forces on the nodes (beam.h, shifted).
#pragma once

#include <vector>

#include "solver/body_system.h"

namespace topple {

inline constexpr double k_yielding = 1e-8;   ///< of f: above it a section is fully plastic
inline constexpr double k_unloading = 1e-3;  ///< of f: hysteresis, or hinges chatter
inline constexpr double k_beside = 1e-3;     ///< of f: joint rule of update_hinges
inline constexpr int k_most_redos = 60;      ///< of one step

/// What the solutions of one step changed so far. Per element a hinge may go and may then form, each once.
struct HingeStep {
  std::vector<bool> released, formed;  ///< per element of the body
  int redos = 0;
};

/// Looks at a converged solution `trial` of the step from `start` and changes system.elements. True: the step
/// must be solved again from `start`. In this order, each followed by a new solution:
/// - fracture of flowing sections (breaks);
/// - hinges that unload go;
/// - the section with the greatest f gets a hinge, and with it those nearly as far (symmetric ones). An
///   element holds one hinge, and the last end at a joint that is not held stays elastic: hinges at all ends
///   leave the joint's rotation undetermined. It yields all the same once loaded k_beside beyond its surface
///   while the others lie on theirs: then the directions of flow differ.
/// False too after k_most_redos: the next step goes on from there.
bool update_hinges(BodySystem& system, const BodyMotion& start, const BodyMotion& trial, HingeStep& step);

/// Takes the flow of the accepted solution into system.elements and `state`. Returns the energy, J, that
/// plastic flow, moves of stress points and fracture took, by the trapezoidal rule like all work.
double commit_hinges(BodySystem& system, const BodyMotion& start, const BodyMotion& end, State& state);

/// A fully plastic section breaks when
///   |kappa_y| size_z/2, |kappa_z| size_y/2 or the stretch gamma_x (tension only)
/// reaches fracture_strain, or an elastic shear strain V/(k G A) reaches sqrt(3) fracture_strain (von Mises).
/// kappa and gamma_x are those of the whole element: flow is spread over its length.
bool breaks(const Model& model, const Element& element, const BeamStrain& strain,
            const SectionForces& forces);

/// Integration point of an element with this hinge; `partner`: hinge of the other element of its pair.
double place_of(const Model& model, int element, Hinge hinge, Hinge partner);

/// The other element of the pair, or -1.
int partner_of(const Model& model, int element);

}  // namespace topple
