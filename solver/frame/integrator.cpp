#include "solver/frame/integrator.h"

#include "solver/frame/central_difference.h"

namespace topple {
namespace {

constexpr IntegratorTraits k_integrators[] = {
    {Integrator::generalized_alpha, "generalized-alpha", false, advance_generalized_alpha},
    {Integrator::central_difference, "central-difference", true,
     [](BodySystem& system, const Parameters& parameters, State& state, double t, double h, int,
        IntegratorScratch& scratch, StepEnergy& energy) {
       return advance_central_difference(system, parameters, state, t, h, scratch, energy);
     }},
    {Integrator::newmark, "newmark", false, advance_generalized_alpha},
};

}  // namespace

std::span<const IntegratorTraits> integrators() {
  return k_integrators;
}

Integrator chosen_integrator(int choice) {
  return choice > 0 ? k_integrators[choice - 1].kind : Integrator::generalized_alpha;
}

}  // namespace topple
