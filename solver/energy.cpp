#include "solver/energy.h"

#include <algorithm>
#include <cmath>

#include "solver/excitation.h"
#include "solver/rotation.h"

namespace topple {

void book_work(const BodySystem& s, const Parameters& parameters, double t, double h, const BodyMotion& start,
               const BodyMotion& end, const std::vector<TouchingPair>& contacts_start,
               const std::vector<TouchingPair>& contacts_end, StepEnergy& energy) {
  const Vec3 floor =
      0.5 * (floor_acceleration(parameters.shakes, t) + floor_acceleration(parameters.shakes, t + h));
  for (int i = 0; i < s.count; ++i) {
    const Vec3 travel = end.position[i] - start.position[i];
    const double m = s.model.node_mass[s.first + i];
    energy.gravity -= m * parameters.gravity.dot(travel);
    energy.input -= m * floor.dot(travel);
  }
  for (const Load* load : s.loads()) {
    const int i = load->node - s.first;
    const double factor = 0.5 * (load_factor(*load, t) + load_factor(*load, t + h));
    const Vec3 spin = start.rotation[i] * log_quaternion(start.rotation[i].conjugate() * end.rotation[i]);
    energy.input += factor * (load->force.dot(end.position[i] - start.position[i]) + load->moment.dot(spin));
  }
  const auto book = [&](const std::vector<TouchingPair>& contacts, double sign) {
    for (const TouchingPair& pair : contacts) {
      const int i = s.model.contact_points[pair.point].node - s.first;
      const Vec3 travel = end.position[i] - start.position[i];
      const double normal_travel = s.model.planes[pair.plane].normal.dot(travel);
      energy.normal_damping -= 0.5 * (pair.out.normal - pair.out.conservative) * normal_travel;
      // the stick spring gives back what it holds; the rest of the tangential work is friction
      energy.friction -= 0.5 * pair.out.tangential.dot(travel) + sign * pair.out.stick_energy;
    }
  };
  book(contacts_start, -1);
  book(contacts_end, 1);

  const ContactLaw law0 = contact_law(parameters, t), law1 = contact_law(parameters, t + h);
  if (law0.alpha == law1.alpha && law0.q == law1.q) return;
  // what a law that changes puts into springs that do not move
  const auto book_change = [&](const TouchingPair& pair, double stick) {
    if (parameters.contact.kind != ContactLawKind::printed)
      energy.input +=
          0.5 * (penalty_energy(law1, pair.depth, pair.L) - penalty_energy(law0, pair.depth, pair.L));
    energy.input += 0.5 * stick;
    energy.friction += 0.5 * stick;
  };
  for (const TouchingPair& pair : contacts_start)
    book_change(pair, pair.out.stick_energy * (law1.alpha / law0.alpha - 1));
  for (const TouchingPair& pair : contacts_end)
    book_change(pair, pair.out.stick_energy * (1 - law0.alpha / law1.alpha));
}

double EnergyLedger::balance_error() const {
  return largest > 0 ? std::abs(unexplained()) / largest : 0;
}

}  // namespace topple
