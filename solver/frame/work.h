// Work on the nodes of bodies in a step.
#pragma once

#include "solver/frame/body_system.h"
#include "solver/state/energy.h"

namespace topple {

/// Adds to `energy` the work of gravity, floor, loads, pulls, viscous stresses and contacts on a system over
/// a step, by the trapezoidal rule with the contact forces at its two ends. The springs of Eq. 2 and stick
/// springs are left out: BodySystem::energy has what they hold. What the ramp of an edit of the contact law
/// puts into them is input (LawChange).
void book_work(const BodySystem& system, const StepSpan& span, const BodyMotion& start, const BodyMotion& end,
               const Contacts& contacts_start, const Contacts& contacts_end, StepEnergy& energy);

}  // namespace topple
