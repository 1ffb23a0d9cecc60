// Where the energy of a step went.
#pragma once

#include "solver/contact/contact_law.h"

namespace topple {

/// Energies that bodies exchanged in a step, J; added to.
struct StepEnergy {
  double input = 0, gravity = 0, friction = 0, normal_damping = 0, numerical = 0, plastic = 0, damping = 0;
  StepEnergy& operator+=(const StepEnergy& other);
};

/// Energies of a body, or of several, that depend on where it is, J.
struct BodyEnergy {
  double kinetic = 0, strain = 0, contact = 0, anchor = 0;
  BodyEnergy& operator+=(const BodyEnergy& other);
  double sum() const { return kinetic + strain + contact + anchor; }
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

}  // namespace topple
