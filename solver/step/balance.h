// Accelerations and contacts of a state, outside a step.
#pragma once

#include "solver/step/workspace.h"

namespace topple {

/// Adds what a part of the model holds.
void add(const BodyEnergy& part, BodyEnergy& sum);
void take(const BodyEnergy& held, EnergyLedger& energy);

/// Accelerations from the balance of forces at `state`. Leaves the bodies' motion in `motion`.
void balance_accelerations(BodySystem& system, const Parameters& parameters, State& state,
                           BodyMotion& motion);

/// Accelerations and contacts of all bodies; returns what they hold.
BodyEnergy balance_all(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w);

/// Accelerations anew of the bodies that `changed` marks.
void balance_again(const Model& model, const Parameters& parameters, const Instant& now,
                   const std::vector<char>& changed, State& state, Workspace::Impl& w);

/// Another law took hold: what contacts hold more with it is input.
void change_law(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w);

}  // namespace topple
