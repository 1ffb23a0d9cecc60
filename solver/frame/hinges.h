// Plastic hinges of a system: where they form, move and break. For dynamics and statics alike:
//
//   system.load_memory(state);                       // once per step
//   HingeStep hinges;
//   do solve(trial);                                 // to convergence, evaluate_with_tangent
//   while (update_hinges(system, trial, hinges));
//   energy = commit_hinges(system, start, trial, state);
//
// Both ends of an element are checked by equilibrium. Where f > 0 the element gets a hinge there and the step
// is solved again with its flow (plasticity.h). A hinge that unloads goes when the step is accepted.
#pragma once

#include <vector>

#include "solver/frame/body_system.h"

namespace topple {

// Of f, yield_function:
inline constexpr double k_yielding = 1e-8;   ///< above it a section is fully plastic
inline constexpr double k_unloading = 1e-3;  ///< below minus this a hinge goes: hysteresis against chatter
inline constexpr double k_beside = 1e-3;     ///< joint rule of update_hinges
inline constexpr double k_crowded = 1e-2;    ///< rule of one hinge per element of update_hinges

inline constexpr int k_most_redos = 60;  ///< repeated solutions of one step for its hinges

/// What the solutions of one step changed so far.
struct HingeStep {
  /// An end of an element loaded beyond yield. f is rounded so that symmetric sections compare as equal.
  struct Candidate {
    long long f;
    int element, end;
  };
  std::vector<bool> formed;  ///< per element of the system: its hinge was formed or moved, once per step
  int redos = 0;
  std::vector<Candidate> candidates;  ///< scratch, as `nodes`
  std::vector<int> nodes;
  std::vector<SectionForces> sections;  ///< one per element of the model

  void clear() {
    formed.clear();
    redos = 0;
  }
};

/// Looks at a converged solution `trial` of a step and changes system.elements. True: the step must be solved
/// again. In this order, each followed by a new solution:
/// - Sections that flow beyond their limits break (breaks).
/// - The section with the greatest f gets a hinge, and with it those nearly as far (symmetric ones). The last
///   end at a joint that is not held stays elastic: hinges at all ends leave the joint's rotation
///   undetermined. It yields all the same once loaded k_beside beyond its surface while the others lie on
///   theirs: then the directions of flow differ.
/// - An element holds one hinge. When its other end is loaded k_crowded beyond yield the hinge moves there:
///   then both flow in turns, each a step late (warning: Outcome::crowded_members, overturn.h).
/// False too after k_most_redos: the next step goes on from there.
bool update_hinges(BodySystem& system, const BodyMotion& trial, HingeStep& step);

/// Takes the flow of the accepted solution into system.elements and `state`; hinges loaded k_unloading below
/// yield go. Returns the energy that flow and fracture took, J, by the trapezoidal rule like all work.
double commit_hinges(BodySystem& system, const BodyMotion& start, const BodyMotion& end, State& state);

/// Whether a fully plastic section breaks: one of
///   |kappa_y| size_z/2,  |kappa_z| size_y/2,  gamma_x (tension only)
/// reaches fracture_strain, or an elastic shear strain V/(k G A) reaches sqrt(3) fracture_strain (von Mises).
/// kappa and gamma_x are the whole strain of the element: flow is spread over its length.
bool breaks(const Model& model, const Element& element, const BeamStrain& strain,
            const SectionForces& forces);

}  // namespace topple
