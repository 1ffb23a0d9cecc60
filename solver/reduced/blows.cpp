// What is about to strike an elastic body, and how far that leads beyond its modes.
#include <algorithm>
#include <cmath>

#include "solver/math/ranges.h"
#include "solver/reduced/reduced_body.h"

namespace topple {
namespace {

constexpr double k_blow = 7.5;  // error of stresses over the ratio of stiffnesses, of what modes leave out

}  // namespace

bool ReducedBody::lands_on_what_gives(double alpha) const {
  const std::vector<int>& base = model_.bodies[body_].base_points;
  bool any = false;
  contacts_.each([&](const BodyContacts::Touch& touch, int k, int point, std::size_t) {
    any = any ||
          (alpha * touch.give[k] > contacts_.length(touch, k) && ranges::find(base, point) == base.end());
  });
  return any;
}

ReducedBody::Strikes ReducedBody::strikes_soon(const BodyState& s) const {
  const Body& body = model_.bodies[body_];
  Strikes strikes;
  for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p) {
    const int node = node_of(p) - body.first_node;
    const auto shape = basis_->shape.middleRows<3>(6 * node);
    const Vec3 bent = shape.lazyProduct(s.amplitude.head(basis_->modes).matrix()),
               rate = shape.lazyProduct(s.rate.head(basis_->modes).matrix()),
               arm = model_.node_position[node_of(p)] - body.centre_of_gravity + bent,
               velocity = s.velocity + s.rotation * (s.angular_velocity.cross(arm) + rate);
    for (const Plane& plane : model_.planes) {
      const double nears = -plane.normal.dot(velocity);
      if (!(nears > 0)) continue;
      const double gap =
          plane.normal.dot(s.position + s.rotation * arm - plane.point) - model_.contact_points[p].width / 2;
      if (!(std::abs(gap) < k_blow_ahead * nears)) continue;  // nor does it press for longer already
      const bool on_base = ranges::find(body.base_points, p) != body.base_points.end();
      double& fastest = on_base ? strikes.on_base : strikes.aside;
      fastest = std::max(fastest, nears);
    }
  }
  return strikes;
}

double ReducedBody::speed_bound(const BodyState& s) const {
  return s.velocity.norm() + s.angular_velocity.norm() * reach_ + greatest_shape_ * s.rate.matrix().norm();
}

double ReducedBody::blow_error(const ContactLaw& law, bool on_base) const {
  return std::min(1.0, k_blow * contacts_.stiffness(law) * (on_base ? base_beyond_ : greatest_beyond_));
}

double ReducedBody::blow_error(const ContactLaw& law, const BodyState& s, double speed, bool on_base) const {
  constexpr double k_rings = 2;  // what a sudden force raises over what it does at rest, at most
  const double raises =
      speed * std::sqrt(contacts_.stiffness(law) * mass_) * (on_base ? base_stress_ : greatest_stress_);
  if (!(raises > 0)) return 0;
  const double now = stress_bound(s);
  if (k_rings * raises + now < s.peak_stress) return 0;
  return blow_error(law, on_base) * std::min(1.0, raises / std::max(s.peak_stress, now));
}

// Of the series of both springs' stiffness over that of the one of the contact.
template <class F>
void ReducedBody::each_stick(F f) const {
  contacts_.each([&](const BodyContacts::Touch& touch, int k, int, std::size_t stick) {
    f(stick, 1 - touch.give_across[k] * touch.stick_stiffness[k]);
  });
}

void ReducedBody::scale_sticks_to_frame(std::span<Vec3> stick) const {
  each_stick([&](std::size_t k, double share) { stick[k] *= share; });
}

void ReducedBody::scale_sticks_from_frame(std::span<Vec3> stick) const {
  each_stick([&](std::size_t k, double share) { stick[k] /= share; });
}

}  // namespace topple
