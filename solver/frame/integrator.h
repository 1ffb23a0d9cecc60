// The time integrations of frames.
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
  bool is_explicit;  ///< steps have a limit of stability, and need no equations solved
  /// Advances the bodies of the system by h from time t, see advance_generalized_alpha().
  StepStatus (*advance)(BodySystem&, const Parameters&, State&, double t, double h, int halvings,
                        IntegratorScratch&, StepEnergy&);
};
/// In the order of the words of `run.integrator`, before which stands auto.
std::span<const IntegratorTraits> integrators();
inline const IntegratorTraits& traits(Integrator integrator) {
  return row_of(integrators(), integrator);
}

/// Of the number of a choice of `run.integrator`.
Integrator chosen_integrator(int choice);

}  // namespace topple
