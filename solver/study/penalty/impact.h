// Restitution of the contact laws in a normal impact.
#pragma once

#include "solver/model/parameters.h"
#include "solver/study/penalty/contact_trials.h"

namespace topple::study {

/// Restitution of a normal impact at `speed` by quadrature, without gravity; it depends neither on alpha and
/// q nor on the mass: with the law's force P f(v), both
///   integral of v/f(-v) from 0 to the speed before = integral of v/f(v) from 0 to the speed after
/// are the energy that the spring takes over the mass. printed: 0, it has no spring.
double restitution(const ContactLaw& law, double speed);

/// What meets the floor: `mass` on `contacts` like contacts of mean width L.
struct ImpactMass {
  double mass;  ///< kg
  int contacts;
  double L;  ///< m
};

/// The same through the solver: a body that meets a plane flat, with the integrator and step of `parameters`.
/// Its status tells when it does not leave the floor.
ContactTrial impact(const ImpactMass& body, const Parameters& parameters, double speed);

}  // namespace topple::study
