#include "solver/state/energy.h"

#include "solver/contact/contact_law.h"

namespace topple {

StepEnergy& StepEnergy::operator+=(const StepEnergy& other) {
  input += other.input;
  gravity += other.gravity;
  friction += other.friction;
  normal_damping += other.normal_damping;
  numerical += other.numerical;
  plastic += other.plastic;
  damping += other.damping;
  return *this;
}

BodyEnergy& BodyEnergy::operator+=(const BodyEnergy& other) {
  kinetic += other.kinetic;
  strain += other.strain;
  contact += other.contact;
  anchor += other.anchor;
  return *this;
}

LawChange::LawChange(const ContactLaw& before, const ContactLaw& after, StepEnergy& energy)
    : before_(before), after_(after), energy_(energy) {}

void LawChange::book_start(double depth, double L, double stick_energy, double weight, bool between_members) {
  book(weight, depth, L, between_members, stick_energy, after_.alpha / before_.alpha - 1);
}

void LawChange::book_end(double depth, double L, double stick_energy, double weight, bool between_members) {
  book(weight, depth, L, between_members, stick_energy, 1 - before_.alpha / after_.alpha);
}

void LawChange::book(double weight, double depth, double L, bool between_members, double stick_energy,
                     double growth) {
  const auto held = [&](const ContactLaw& law) { return penalty_energy(law, depth, L, between_members); };
  if (traits(after_).stores_energy) energy_.input += 0.5 * weight * (held(after_) - held(before_));
  energy_.input += 0.5 * stick_energy * growth;
  energy_.friction += 0.5 * stick_energy * growth;
}

}  // namespace topple
