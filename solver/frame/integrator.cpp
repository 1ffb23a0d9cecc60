#include "solver/frame/integrator.h"

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

}  // namespace topple
