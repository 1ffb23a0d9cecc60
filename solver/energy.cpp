#include "solver/energy.h"

#include <algorithm>
#include <cmath>

#include "solver/excitation.h"
#include "solver/rotation.h"

namespace topple {

void book_contact(const ContactOutput& out, const Vec3& normal, const Vec3& travel, double sign,
                  StepEnergy& energy) {
  energy.normal_damping -= 0.5 * (out.normal - out.conservative) * normal.dot(travel);
  energy.friction -= 0.5 * out.tangential.dot(travel) + sign * out.stick_energy;
}

namespace {

// What a law that changes puts into springs that do not move.
class LawChange {
 public:
  LawChange(const ContactLaw& before, const ContactLaw& after, ContactLawKind kind, StepEnergy& energy)
      : before_(before), after_(after), kind_(kind), energy_(energy) {}
  void book(double weight, double depth, double L, bool between_members, double stick_energy, double growth) {
    const auto held = [&](const ContactLaw& law) { return penalty_energy(law, depth, L, between_members); };
    if (kind_ != ContactLawKind::printed) energy_.input += 0.5 * weight * (held(after_) - held(before_));
    energy_.input += 0.5 * stick_energy * growth;
    energy_.friction += 0.5 * stick_energy * growth;
  }
  void book(const std::vector<TouchingPair>& contacts, double growth) {
    for (const TouchingPair& pair : contacts)
      book(1, pair.depth, pair.L, false, pair.out.stick_energy, growth);
  }
  void book(const Contacts& contacts, const std::vector<MemberPair>& pairs, double growth) {
    book(contacts.planes, growth);
    for (const MemberTouch& touch : contacts.members.touches)
      book(touch.weight, touch.depth, pairs[touch.pair].L, true, touch.out.stick_energy, growth);
  }
  double growth_at_start() const { return after_.alpha / before_.alpha - 1; }
  double growth_at_end() const { return 1 - before_.alpha / after_.alpha; }

 private:
  const ContactLaw &before_, &after_;
  ContactLawKind kind_;
  StepEnergy& energy_;
};

}  // namespace

void book_law_change(const ContactLaw& before, const ContactLaw& after,
                     const std::vector<TouchingPair>& contacts_start,
                     const std::vector<TouchingPair>& contacts_end, StepEnergy& energy) {
  if (before.alpha == after.alpha && before.q == after.q) return;
  LawChange change(before, after, after.kind, energy);
  change.book(contacts_start, change.growth_at_start());
  change.book(contacts_end, change.growth_at_end());
}

void book_work(const BodySystem& s, const Parameters& parameters, double t, double h, const BodyMotion& start,
               const BodyMotion& end, const Contacts& contacts_start, const Contacts& contacts_end,
               StepEnergy& energy) {
  const Vec3 floor =
      0.5 * (floor_acceleration(parameters.shakes, t) + floor_acceleration(parameters.shakes, t + h));
  for (int i = 0; i < s.count; ++i) {
    const Vec3 travel = end.position[i] - start.position[i];
    const double m = s.model.node_mass[s.node[i]];
    energy.gravity -= m * parameters.gravity.dot(travel);
    energy.input -= m * floor.dot(travel);
  }
  for (const auto& [load, i] : s.loads) {
    const double factor = 0.5 * (load_factor(*load, t) + load_factor(*load, t + h));
    const Vec3 spin = start.rotation[i] * log_quaternion(start.rotation[i].conjugate() * end.rotation[i]);
    energy.input += factor * (load->force.dot(end.position[i] - start.position[i]) + load->moment.dot(spin));
  }
  const auto book = [&](const Contacts& contacts, double sign) {
    for (const TouchingPair& pair : contacts.planes)
      book_contact(pair.out, s.model.planes[pair.plane].normal,
                   end.position[pair.node] - start.position[pair.node], sign, energy);
    for (const MemberTouch& touch : contacts.members.touches) {
      const MemberPair& pair = s.member_pairs()[touch.pair];
      book_contact(touch.out, touch.normal,
                   relative(touch, pair, end.position) - relative(touch, pair, start.position), sign, energy);
    }
  };
  book(contacts_start, -1);
  book(contacts_end, 1);

  const ContactLaw law0 = contact_law(parameters, t), law1 = contact_law(parameters, t + h);
  if (law0.alpha == law1.alpha && law0.q == law1.q) return;
  LawChange change(law0, law1, parameters.contact.kind, energy);
  change.book(contacts_start, s.member_pairs(), change.growth_at_start());
  change.book(contacts_end, s.member_pairs(), change.growth_at_end());
}

double EnergyLedger::balance_error() const {
  return largest > 0 ? std::abs(unexplained()) / largest : 0;
}

}  // namespace topple
