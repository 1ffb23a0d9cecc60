// When points of BodyContacts will touch.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/reduced/body_contacts.h"
#include "solver/state/step_limits.h"

namespace topple {

double BodyContacts::next_landing(const BodyState& s, const Vec3& acceleration,
                                  const Vec3& angular_acceleration, double within) const {
  const double never = std::numeric_limits<double>::infinity();
  const Vec3& omega = s.angular_velocity;
  const double reach =
      within *
      (s.velocity.norm() + reach_ * omega.norm() +
       within / 2 * (acceleration.norm() + reach_ * (angular_acceleration.norm() + omega.squaredNorm())));
  Four soonest = Four(never);
  const PackMat3 r = rotation_matrix(packed(s.rotation));
  for (std::size_t k = 0; k < model_.planes.size(); ++k) {
    const Plane& plane = model_.planes[k];
    const double height = plane.normal.dot(s.position - plane.point);
    const Vec3 normal = unpacked(transposed_times(r, packed(plane.normal)));
    if (clearance(normal, height) > widest_[k] + reach) continue;
    const Points n = in_all_lanes(normal), turn = in_all_lanes(Vec3(normal.cross(omega))),
                 bend = in_all_lanes(Vec3(normal.cross(angular_acceleration) + normal.dot(omega) * omega -
                                          omega.squaredNorm() * normal));
    const Four speed = Four(plane.normal.dot(s.velocity)), rise = Four(plane.normal.dot(acceleration));
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Points& at = groups_[g].place;
      const Four gap = dot(n, at) + (Four(height) - sides_[k * groups_.size() + g].gap);
      // gap - closing t + rises t^2/2 = 0, the first t > 0
      const Four closing = -speed - dot(turn, at), rises = rise + dot(bend, at);
      const Four root = closing * closing - 2 * rises * gap;
      const Four down = closing + sqrt(choose(root < 0, Four(0), root)), when = 2 * gap / down;
      const Four::Mask lands = (Four(0) <= gap) & (Four(0) < down) & (Four(0) <= root) & (when < soonest);
      soonest = choose(lands, when, soonest);
    }
  }
  const double first = std::min(std::min(soonest[0], soonest[1]), std::min(soonest[2], soonest[3]));
  return first < within ? first : never;
}

double BodyContacts::next_stop(const BodyState& s, const Vec3& acceleration, const Vec3& angular_acceleration,
                               double within) const {
  constexpr double k_slow = 5e-3;       // m/s
  constexpr double k_slips = 1 - 1e-6;  // of the limit, squared
  const double never = std::numeric_limits<double>::infinity();
  const Points linear = in_all_lanes(s.velocity),
               angular = in_all_lanes(Vec3(s.rotation * s.angular_velocity)),
               gain = in_all_lanes(acceleration),
               turn = in_all_lanes(Vec3(s.rotation * angular_acceleration));
  Four soonest = Four(never);
  for (const Touch& touch : now_.list()) {
    const Points n = normal(touch), circling = cross(angular, touch.arm);
    const Points slip = tangential(n, linear + circling);
    const Four slip2 = dot(slip, slip),
               slows = -dot(slip, gain + (cross(turn, touch.arm) + cross(angular, circling))),
               when = slip2 / slows;
    const Four::Mask stops =
        touch.touching & (Four(0) < touch.limit) &
        (k_slips * touch.limit * touch.limit <= dot(touch.tangential, touch.tangential)) &
        (Four(k_slow * k_slow) < slip2) & (Four(0) < slows) & (when < soonest);
    soonest = choose(stops, when, soonest);
  }
  const double first = std::min(std::min(soonest[0], soonest[1]), std::min(soonest[2], soonest[3]));
  return first < within ? first : never;
}

double BodyContacts::look_ahead(const ContactLaw& law, bool quiet, const BodyState& s) const {
  double stiffness = 0, limit = k_longest_step;
  const Vec3 omega = s.rotation * s.angular_velocity;
  const PackMat3 r = rotation_matrix(packed(s.rotation));
  for (std::size_t k = 0; k < model_.planes.size(); ++k) {
    const Plane& plane = model_.planes[k];
    const double fall = -plane.normal.dot(s.velocity), height = plane.normal.dot(s.position - plane.point);
    const Vec3 normal = unpacked(transposed_times(r, packed(plane.normal)));
    if (clearance(normal, height) - widest_[k] >
        (std::max(0., fall) + reach_ * omega.norm()) * k_longest_step)
      continue;
    const Points n = in_all_lanes(normal),
                 turn = in_all_lanes(unpacked(transposed_times(r, packed(Vec3(plane.normal.cross(omega))))));
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Side& side = sides_[k * groups_.size() + g];
      const Four gap = dot(n, groups_[g].place) + height - side.gap;
      const Four closing = fall - dot(turn, groups_[g].place);
      for (int which = 0; which < groups_[g].size; ++which) {
        const ContactAhead ahead = contact_ahead(law, gap[which], closing[which], side.L[which]);
        stiffness += ahead.stiffness;
        limit = std::min(limit, ahead.limit);
      }
    }
  }
  return std::min(limit, (quiet ? k_quiet_steps : 1) * bounce_limit(mass_, stiffness));
}

}  // namespace topple
