#include "solver/parameters.h"

#include <cmath>
#include <initializer_list>

namespace topple {
namespace {

bool all_finite(std::initializer_list<double> numbers) {
  bool all = true;
  for (const double x : numbers) all &= std::abs(x) <= k_largest_number;  // nor is NaN below it
  return all;
}

bool all_finite(const Vec3& v) {
  return all_finite({v.x(), v.y(), v.z()});
}

// The bindings name every member: a new one does not compile until it is looked at.

bool is_finite(const ContactLaw& law) {
  const auto& [kind, alpha, q, friction, friction_static, restitution, normal_speed, slip_speed] = law;
  return all_finite({alpha, q, friction, friction_static, restitution, normal_speed, slip_speed});
}

bool is_finite(const Passage& passage) {
  const auto& [since, over] = passage;
  return all_finite({since, over});
}

bool is_finite(const Shake& shake) {
  const auto& [kind, amplitude, frequency, last_frequency, direction, start, on, cycles, taper,
               initial_velocity, shape, duration, record, scale, turned, turns, amplitude_before,
               scale_before, passage] = shake;
  return all_finite({amplitude, frequency, last_frequency, start, cycles, taper, duration, scale, turned,
                     turns, scale_before}) &&
         all_finite(direction) && all_finite(amplitude_before) && is_finite(passage);
}

}  // namespace

bool is_finite(const Parameters& parameters) {
  const auto& [contact, contact_before, contact_passage, shakes, models, damping, anchors, want_stress,
               gravity, integrator, spectral_radius, beta, gamma, time_step, adaptive, tolerance,
               finer_parts] = parameters;
  for (const Shake& shake : shakes)
    if (!is_finite(shake)) return false;
  for (const double ratio : damping)
    if (!all_finite({ratio})) return false;
  return is_finite(contact) && is_finite(contact_before) && is_finite(contact_passage) &&
         all_finite(gravity) && all_finite({spectral_radius, beta, gamma, time_step, tolerance, finer_parts});
}

}  // namespace topple
