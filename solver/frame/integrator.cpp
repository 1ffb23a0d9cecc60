#include "solver/frame/integrator.h"

#include <cmath>
#include <limits>

#include "solver/frame/central_difference.h"

namespace topple {
namespace {

GeneralizedAlpha by_spectral_radius(const Parameters& p) {
  return GeneralizedAlpha(p.spectral_radius);
}

GeneralizedAlpha newmark(const Parameters& p) {
  return GeneralizedAlpha::newmark(p.beta, p.gamma);
}

template <GeneralizedAlpha (*coefficients)(const Parameters&)>
StepStatus advance(BodySystem& system, const StepSpan& span, State& state, IntegratorScratch& scratch,
                   StepEnergy& energy) {
  return advance_generalized_alpha(system, span, coefficients(span.parameters), state, scratch, energy);
}

constexpr IntegratorTraits k_integrators[] = {
    {Integrator::generalized_alpha, "generalized-alpha", false, by_spectral_radius,
     advance<by_spectral_radius>},
    {Integrator::central_difference, "central-difference", true, nullptr, advance_central_difference},
    {Integrator::newmark, "newmark", false, newmark, advance<newmark>},
};

}  // namespace

std::span<const IntegratorTraits> integrators() {
  return k_integrators;
}

double stable_share(const Parameters& parameters) {
  const IntegratorTraits& method = traits(parameters.integrator);
  if (method.is_explicit) return 1;
  const GeneralizedAlpha c = method.coefficients(parameters);
  const double lacks = c.gamma / 2 - c.beta;
  return lacks > 0 ? 0.5 / std::sqrt(lacks) : std::numeric_limits<double>::infinity();
}

}  // namespace topple
