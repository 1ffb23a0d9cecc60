// Where the energy of a step went.
#pragma once

#include <vector>

#include "solver/frame/body_system.h"

namespace topple {

/// Energies that bodies exchanged in a step, J; added to.
struct StepEnergy {
  double input = 0, gravity = 0, friction = 0, normal_damping = 0, numerical = 0, plastic = 0, damping = 0;
};

/// What a contact law that changes over a step puts into springs that do not move: input. Call for every
/// contact at both ends of the step.
class LawChange {
 public:
  LawChange(const ContactLaw& before, const ContactLaw& after, StepEnergy& energy);
  void book_start(double depth, double L, double stick_energy, double weight = 1,
                  bool between_members = false);
  void book_end(double depth, double L, double stick_energy, double weight = 1, bool between_members = false);

 private:
  void book(double weight, double depth, double L, bool between_members, double stick_energy, double growth);

  const ContactLaw &before_, &after_;
  StepEnergy& energy_;
};

/// Work of gravity, floor, loads, viscous stresses and contacts on a system over a step from t to t + h
/// between two evaluations of the contacts, by the trapezoidal rule. The normal spring of Eq. 2 and the stick
/// springs are not booked: their energy is known at both ends. What an edit of the contact law puts into them
/// counts as input.
void book_work(const BodySystem& system, const Parameters& parameters, double t, double h,
               const BodyMotion& start, const BodyMotion& end, const Contacts& contacts_start,
               const Contacts& contacts_end, StepEnergy& energy);

}  // namespace topple
