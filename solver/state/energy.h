// Where the energy of a step went.
#pragma once

#include "solver/contact/contact_law.h"

namespace topple {

/// Energies exchanged in a step, J, with the meaning and signs of EnergyLedger; functions add to them.
struct StepEnergy {
  double input = 0, gravity = 0, friction = 0, normal_damping = 0, numerical = 0, plastic = 0, damping = 0;
  StepEnergy& operator+=(const StepEnergy& other);
};

/// Energies that a body, or several, hold by their motion at an instant, J.
struct BodyEnergy {
  double kinetic = 0, strain = 0, contact = 0, anchor = 0;
  BodyEnergy& operator+=(const BodyEnergy& other);
  double sum() const { return kinetic + strain + contact + anchor; }
};

/// Books as input the energy that a change of the contact law over a step (the ramp of an edit) puts into the
/// springs of contacts, half of it at each end of the step. Call for every contact that is closed there.
/// depth: 1 - l/L. L: m. stick_energy: J. weight: as MemberTouch::weight.
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

}  // namespace topple
