// The work that bodies exchange in a step of their nodes.
#pragma once

#include "solver/frame/body_system.h"
#include "solver/state/energy.h"

namespace topple {

/// Work of gravity, floor, loads, viscous stresses and contacts on a system over a step from t to t + h
/// between two evaluations of the contacts, by the trapezoidal rule. The normal spring of Eq. 2 and the stick
/// springs are not booked: their energy is known at both ends. What an edit of the contact law puts into them
/// counts as input.
void book_work(const BodySystem& system, const Parameters& parameters, double t, double h,
               const BodyMotion& start, const BodyMotion& end, const Contacts& contacts_start,
               const Contacts& contacts_end, StepEnergy& energy);

}  // namespace topple
