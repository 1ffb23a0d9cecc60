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
  int halvings;  ///< how often the implicit methods of frames may halve h when Newton does not converge
  Workspace::Impl& w;
  StepInputs start;
  StepEnergy exchanged = {};  ///< in the step
  BodyEnergy held = {};       ///< at its end

  StepInProgress(const Model& model, const Parameters& parameters, const State& from, double h, int halvings,
                 Workspace::Impl& w);
  double end() const { return from.time + h; }  ///< s
};

/// Copies `from` to `w.next` and finds all candidate pairs, for surfaces that come closer by `approach`, m,
/// at most.
void find_candidates(const StepInProgress& step, double approach);

/// Chooses what each body is computed as from here on (model_switch.h).
void switch_models(const StepInProgress& step);

/// Applies what changed since the last step: anchors, contact law, step size, a jump of the floor's velocity.
void apply_events(StepInProgress& step);

/// step_too_long where an explicit method, or Newmark's with steps of fixed length, is not stable.
StepStatus check_stability(const StepInProgress& step);

/// Advances all parts to the end of the step, in parallel where there are workers. The first failure counts.
StepStatus advance_parts(StepInProgress& step);

/// At `state`, for which it arranges the parts.
HardestContact hardest_contact(const Parameters& parameters, const State& state, Workspace::Impl& w);

/// Contacts took energy between two states.
bool contacts_dissipated(const EnergyLedger& from, const EnergyLedger& to);

/// Sets step, time, floor motion and energies of `w.next`.
void close_ledger(const StepInProgress& step);

/// `status` becomes not_finite where a number at the end is not, energy_lost where the balance error is
/// above k_lost_balance and a contact is closed at one of the ends or took energy, or a section flowed or
/// broke.
void check(const StepInProgress& step, StepStatus& status);

}  // namespace topple
