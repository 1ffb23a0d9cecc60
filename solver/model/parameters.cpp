#include "solver/model/parameters.h"

#include <cmath>

#include "solver/math/overflow.h"

namespace topple {
namespace {

// Sums that are finite when all their numbers are, and not too large. The bindings name every member: a new
// one does not compile until it is looked at.

template <class... Number>
double sum(Number... x) {
  return (... + (x * k_overflow));
}

double sum_of(const Vec3& v) {
  return sum(v.x(), v.y(), v.z());
}

double sum_of(const ContactLaw& law) {
  const auto& [kind, alpha, q, friction, friction_static, restitution, normal_speed, slip_speed,
               member_share] = law;
  return sum(alpha, q, friction, friction_static, restitution, normal_speed, slip_speed, member_share);
}

double sum_of(const ParameterRamp& ramp) {
  const auto& [since, over] = ramp;
  return sum(since, over);
}

double sum_of(const Shake& shake) {
  const auto& [kind, amplitude, frequency, last_frequency, direction, start, on, cycles, taper,
               initial_velocity, shape, duration, record, scale, building, turned, turns, amplitude_before,
               scale_before, ramp] = shake;
  return sum(amplitude, frequency, last_frequency, start, cycles, taper, duration, scale, turned, turns,
             scale_before) +
         sum_of(direction) + sum_of(amplitude_before) + sum_of(ramp);
}

}  // namespace

Vec3 pull_force(const Pull& pull, double t) {
  return pull.before + pull.ramp.share(t) * (pull.force - pull.before);
}

bool is_finite(const Parameters& parameters) {
  const auto& [contact, contact_before, contact_ramp, shakes, models, damping, anchors, pulls, want_stress,
               accuracy, gravity, integrator, automatic, spectral_radius, beta, gamma, time_step, adaptive,
               tolerance, substep_refinement, resolves_contacts] = parameters;
  double total = sum_of(contact) + sum_of(contact_before) + sum_of(contact_ramp) + sum_of(gravity) +
                 sum(accuracy, spectral_radius, beta, gamma, time_step, tolerance, substep_refinement);
  for (const Shake& shake : shakes) total += sum_of(shake);
  for (const Pull& pull : pulls) total += sum_of(pull.force) + sum_of(pull.before) + sum_of(pull.ramp);
  for (const double ratio : damping) total += sum(ratio);
  return std::isfinite(total);
}

}  // namespace topple
