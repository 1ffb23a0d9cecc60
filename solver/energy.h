// Where the energy of a step went.
#pragma once

#include <vector>

#include "solver/body_system.h"

namespace topple {

/// Energies that bodies exchanged in a step, J; added to.
struct StepEnergy {
  double input = 0, gravity = 0, friction = 0, normal_damping = 0, numerical = 0, plastic = 0;
};

/// Work over `travel` of the half of a contact's force that is taken at the start (sign -1) or the end (1) of
/// a step. The stick spring gives back what it holds; the rest of the tangential work is friction.
void book_contact(const ContactOutput& out, const Vec3& normal, const Vec3& travel, double sign,
                  StepEnergy& energy);

/// What a law that changes over a step puts into the springs of plane contacts at its ends: input.
void book_law_change(const ContactLaw& before, const ContactLaw& after,
                     const std::vector<TouchingPair>& contacts_start,
                     const std::vector<TouchingPair>& contacts_end, StepEnergy& energy);

/// Work of gravity, floor, loads and contacts on a system over a step from t to t + h between two evaluations
/// of the contacts, by the trapezoidal rule. The normal spring of Eq. 2 and the stick springs are not booked:
/// their energy is known at both ends. What an edit of the contact law puts into them counts as input.
void book_work(const BodySystem& system, const Parameters& parameters, double t, double h,
               const BodyMotion& start, const BodyMotion& end, const Contacts& contacts_start,
               const Contacts& contacts_end, StepEnergy& energy);

}  // namespace topple
