#include "solver/step/step.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "solver/body/anchors.h"
#include "solver/body/candidates.h"
#include "solver/body/model_level.h"
#include "solver/body/step_control.h"
#include "solver/model/excitation.h"
#include "solver/step/adaptive_step.h"
#include "solver/step/stages.h"

namespace topple {
namespace {

constexpr int k_halvings = 6;
constexpr int k_most_looks = 4;  // for candidates, of a step in which nodes move further than was expected
constexpr int k_parts = 4, k_most_divisions = 4;  // of a step that is taken again
constexpr double k_lossy = 1e-3;  // of the largest energy, left unexplained by a step or given by its method

StepStatus check_inputs(const Model& model, const Parameters& parameters, const State& state,
                        Workspace::Impl& w);
StepStatus try_step(const Model& model, const Parameters& parameters, const State& state, double h,
                    int halvings, Workspace::Impl& w);
StepStatus in_parts(const Model& model, const Parameters& parameters, const State& from, double h,
                    int divisions, Workspace::Impl& w);
void accept(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w);

}  // namespace

StepStatus step(const Model& model, const Parameters& parameters, State& state, Workspace& workspace,
                double until) {
  Workspace::Impl& w = workspace.impl();
  StepStatus status = check_inputs(model, parameters, state, w);
  if (!status.ok()) return status;
  if (parameters.adaptive) {
    const auto try_adaptive = [&](double h) { return try_step(model, parameters, state, h, 0, w); };
    status = adaptive_step(model, parameters, state, w, until, std::ref(try_adaptive));
  } else {
    status = in_parts(model, parameters, state, parameters.time_step,
                      parameters.resolves_contacts ? k_most_divisions : 0, w);
    w.next.step_size = state.step_size;
  }
  if (status.ok()) accept(model, parameters, state, w);
  return status;
}

namespace {

// One step of size h into w.next. passed_through: nodes moved too far for the pairs looked at.
StepStatus try_step(const Model& model, const Parameters& parameters, const State& state, double h,
                    int halvings, Workspace::Impl& w) {
  const bool alone = model.bodies.size() < 2;
  double approach = alone ? 0 : w.approach.likely(model, state, h);
  for (int look = 0; look < k_most_looks; ++look) {
    StepInProgress s(model, parameters, state, h, halvings, w);
    find_candidates(s, approach);
    switch_models(s);
    apply_events(s);
    StepStatus status = check_stability(s);
    if (status.ok()) status = advance_parts(s);
    if (status.ok()) {
      close_ledger(s);
      check(s, status);
    }
    if (status.ok() && w.models.yielded(model, w.next, w.parts)) continue;
    if (!status.ok() || alone) return status;
    approach = w.approach.greatest(model, state, w.next, w.next.candidate_margin);
    if (approach < w.next.candidate_margin) {
      w.next.candidate_margin -= approach;
      return status;
    }
  }
  StepStatus status;
  status.kind = StepStatus::Kind::passed_through;
  status.time = w.next.time;
  return status;
}

// Whether a step from `from` that ended so in w.next is to be taken again in parts: it failed in a way that
// shorter ones may not, or left energy of frames unexplained where something touches.
bool is_too_coarse(const Parameters& parameters, const State& from, double h, const StepStatus& status,
                   Workspace::Impl& w) {
  using Kind = StepStatus::Kind;
  switch (status.kind) {
    case Kind::newton_diverged:
    case Kind::passed_through:
    case Kind::energy_lost:
      return true;
    case Kind::step_too_long:  // unless the frame was asked for
      return w.next.bodies[status.body].reason != LevelReason::asked;
    case Kind::ok:
      break;
    default:
      return false;
  }
  const EnergyLedger &now = w.next.energy, &before = from.energy;
  const double left =
      std::max(std::abs(now.unexplained() - before.unexplained()), before.numerical - now.numerical);
  return w.parts.moves_nodes() && left > k_lossy * h / parameters.time_step * now.largest &&
         (contacts_dissipated(before, now) || hardest_contact(parameters, from, w).force > 0 ||
          hardest_contact(parameters, w.next, w).force > 0);
}

// One step of size h into w.next, in parts where it is too coarse as a whole. After those the algorithmic
// accelerations stay as near to the true ones as the last part left them: what is not smooth in a part is no
// slope that a whole step may follow.
StepStatus in_parts(const Model& model, const Parameters& parameters, const State& from, double h,
                    int divisions, Workspace::Impl& w) {
  StepStatus status = try_step(model, parameters, from, h, k_halvings, w);
  if (divisions == 0 || !is_too_coarse(parameters, from, h, status, w)) return status;
  int iterations = status.newton_iterations, rejected = status.rejected + 1;
  State at = from;
  at.step_size = h;
  change_step(at, h / k_parts);
  for (int part = 0; part < k_parts; ++part) {
    status = in_parts(model, parameters, at, h / k_parts, divisions - 1, w);
    status.newton_iterations = iterations += status.newton_iterations;
    status.rejected = rejected += status.rejected;
    if (!status.ok()) return status;
    accept(model, parameters, at, w);
  }
  at.step = from.step + 1;
  at.time = from.time + h;
  w.next = at;
  return status;
}

// Looks at the numbers of parameters that are new, and of a state that is not finite.
StepStatus check_inputs(const Model& model, const Parameters& parameters, const State& state,
                        Workspace::Impl& w) {
  if (w.parameters == parameters && moves_finite(state)) return {};
  const StepStatus status = look_at_numbers(model, parameters, state, false);
  if (status.ok()) w.invalidate_caches(parameters);
  return status;
}

// The step in w.next is taken. Where the floor's acceleration jumps, forces are those that follow.
void accept(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  if (!model.anchors.empty()) {
    w.changed.assign(model.bodies.size(), false);
    if (break_anchors(model, w.next, w.changed))
      w.parts.balance(parameters, StepInputs(parameters, w.next.time), w.changed, w.next);
  }
  if (w.jumps) {
    w.reached = StepInputs(parameters, w.next.time);
    w.parts.balance(parameters, *w.reached, w.next);
  }
  take(w.next, state, w.moves_nodes(state));
}

}  // namespace

std::optional<double> explicit_limit(Workspace& workspace) {
  const std::optional<ExplicitLimit>& limit = workspace.impl().explicit_limit;
  return limit ? std::optional(limit->step) : std::nullopt;
}

}  // namespace topple
