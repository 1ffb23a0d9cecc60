// The stages of a step, in the order in which it takes them (step.cpp).
#pragma once

#include "solver/state/step_result.h"
#include "solver/step/workspace_impl.h"

namespace topple {

/// One step of size h, s, from `from`; `w.next` is what becomes of it.
struct StepInProgress {
  const Model& model;
  const Parameters& parameters;
  const State& from;
  double h;
  int halvings;  ///< the implicit methods halve it so often when Newton does not converge
  Workspace::Impl& w;
  StepInputs start;
  StepEnergy exchanged = {};
  BodyEnergy held = {};

  StepInProgress(const Model& model, const Parameters& parameters, const State& from, double h, int halvings,
                 Workspace::Impl& w);
  double end() const { return from.time + h; }
};

/// `w.next` becomes `from`, with all pairs that touch when no node moves by more than `travel`, m.
void find_candidates(const StepInProgress& step, double travel);

/// What each body is computed as from here on.
void switch_models(const StepInProgress& step);

/// What happened between the steps: anchors switched, another law, a jump of the floor's velocity, another
/// step size.
void apply_events(StepInProgress& step);

/// step_too_long where an explicit method is not stable.
StepStatus check_stability(const StepInProgress& step);

/// The parts go to the end of the step, side by side where there are workers.
StepStatus advance_parts(StepInProgress& step);

/// Time, floor and energies of the end.
void close_ledger(const StepInProgress& step);

/// `status` becomes not_finite or energy_lost where the numbers or the energies at the end are so.
void check(const StepInProgress& step, StepStatus& status);

}  // namespace topple
