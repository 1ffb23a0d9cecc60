// Table of the time integrations of frames.
#pragma once

#include <span>

#include "solver/frame/generalized_alpha.h"
#include "solver/model/table.h"

namespace topple {

/// A time integration. A new one is an Integrator, its file with `advance`, and a row of the table in
/// integrator.cpp.
struct IntegratorTraits {
  Integrator kind;
  const char* word;  ///< in scenes
  bool is_explicit;  ///< no equations to solve, but a stability limit (explicit_limit)
  /// Of an implicit method; explicit ones have none.
  GeneralizedAlpha (*coefficients)(const Parameters&);
  /// As advance_generalized_alpha().
  StepStatus (*advance)(BodySystem&, const StepSpan&, State&, IntegratorScratch&, StepEnergy&);
};
/// In the order of the words of the scene key `run.integrator`, of which the first is auto.
std::span<const IntegratorTraits> integrators();
inline const IntegratorTraits& traits(Integrator integrator) {
  return row_of(integrators(), integrator);
}
/// Greatest stable step over that of central differences (explicit_limit), by linear theory:
/// 1/sqrt(gamma/2 - beta)/2 of Newmark's method where that is real (Hughes 1987, 9.1.2), else infinite.
double stable_share(const Parameters& parameters);

}  // namespace topple
