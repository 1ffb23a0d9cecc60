#include "solver/frame/work.h"

#include "solver/math/rotation.h"

namespace topple {
namespace {

// Work of the half of a contact's force that is taken at one end of the step. The stick spring gives back
// what it holds; the rest of the tangential work is friction.
void book_contact(const ContactOutput& out, const Vec3& normal, const Vec3& travel, double sign,
                  StepEnergy& energy) {
  energy.normal_damping -= 0.5 * (out.normal - out.conservative) * normal.dot(travel);
  energy.friction -= 0.5 * out.tangential.dot(travel) + sign * out.stick_energy;
}

}  // namespace

void book_work(const BodySystem& s, const StepSpan& span, const BodyMotion& start, const BodyMotion& end,
               const Contacts& contacts_start, const Contacts& contacts_end, StepEnergy& energy) {
  const Vec3 floor = 0.5 * (span.start.floor + span.end.floor);
  for (int i = 0; i < s.count; ++i) {
    const Vec3 travel = end.position[i] - start.position[i];
    const double m = s.node_mass[i];
    energy.gravity -= m * span.parameters.gravity.dot(travel);
    energy.input -= m * floor.dot(travel);
  }
  for (const auto& [load, i] : s.loads) {
    const double factor = 0.5 * (load_factor(*load, span.start.time) + load_factor(*load, span.end.time));
    const Vec3 spin = start.rotation[i] * log_quaternion(start.rotation[i].conjugate() * end.rotation[i]);
    energy.input += factor * (load->force.dot(end.position[i] - start.position[i]) + load->moment.dot(spin));
  }
  for (std::size_t k = 0; k < span.end.pulls.size(); ++k)
    if (const int i = s.local(span.end.pulls[k].node); i >= 0)
      energy.input +=
          0.5 *
          (span.start.pulls[k].force + span.end.pulls[k].force).dot(end.position[i] - start.position[i]);
  energy.damping += s.viscous_work(start, end);
  const auto book = [&](const Contacts& contacts, double sign) {
    for (const TouchingPair& pair : contacts.planes)
      book_contact(pair.out, s.model.planes[pair.plane].normal,
                   end.position[pair.node] - start.position[pair.node], sign, energy);
    for (const MemberTouch& touch : contacts.members.touches) {
      const MemberPair& pair = s.member_pairs()[touch.pair];
      book_contact(touch.out, touch.input.normal,
                   relative(touch, pair, end.position) - relative(touch, pair, start.position), sign, energy);
    }
  };
  book(contacts_start, -1);
  book(contacts_end, 1);

  const ContactLaw &law0 = span.start.law, &law1 = span.end.law;
  if (law0.alpha == law1.alpha && law0.q == law1.q) return;
  LawChange change(law0, law1, energy);
  for (const TouchingPair& pair : contacts_start.planes)
    change.book_start(pair.depth, pair.L, pair.out.stick_energy);
  for (const TouchingPair& pair : contacts_end.planes)
    change.book_end(pair.depth, pair.L, pair.out.stick_energy);
  for (const MemberTouch& touch : contacts_start.members.touches)
    change.book_start(touch.input.depth, s.member_pairs()[touch.pair].L, touch.out.stick_energy, touch.weight,
                      true);
  for (const MemberTouch& touch : contacts_end.members.touches)
    change.book_end(touch.input.depth, s.member_pairs()[touch.pair].L, touch.out.stick_energy, touch.weight,
                    true);
}

}  // namespace topple
