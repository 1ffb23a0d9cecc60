#include "solver/step/stages.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "solver/body/anchors.h"
#include "solver/body/candidates.h"
#include "solver/body/step_control.h"
#include "solver/frame/integrator.h"
#include "solver/math/ranges.h"
#include "solver/model/excitation.h"

namespace topple {
namespace {

constexpr double k_time_slack = 1e-9;          // s, times are sums of rounded steps
constexpr double k_longest_floor_step = 5e-3;  // s, trapezoidal: off by 1e-4 at 1 Hz
constexpr double k_least_energy = 1e-6;        // J, below it a balance is rounding

// Accelerations anew of the bodies whose anchors were switched.
void balance_changed(const StepInProgress& s) {
  s.w.parts.balance(s.parameters, s.start, s.w.changed, s.w.next);
}

// Another law took hold: what contacts hold more with it is input.
void change_law(const StepInProgress& s) {
  State& next = s.w.next;
  const double before = next.energy.contact;
  next.law = s.parameters.contact.kind;
  next.energy.contact = s.w.parts.balance(s.parameters, s.start, next).contact;
  next.energy.input += next.energy.contact - before;
}

}  // namespace

StepInProgress::StepInProgress(const Model& model_, const Parameters& parameters_, const State& from_,
                               double h_, int halvings_, Workspace::Impl& w_)
    : model(model_),
      parameters(parameters_),
      from(from_),
      h(h_),
      halvings(halvings_),
      w(w_),
      start(w.reached && w.reached->time == from.time ? *w.reached : StepInputs(parameters, from.time)) {
  w.reached.emplace(parameters, end(), start);
  w.jumps = acceleration_jumps(parameters.shakes, end());
  if (w.jumps) w.reached->floor = acceleration_until(parameters.shakes, end());
}

void find_candidates(const StepInProgress& s, double approach) {
  const InPhase phase(&s.w.profile, Phase::search);
  copy(s.from, s.w.next, s.w.moves_nodes(s.from));
  update_candidates(s.model, s.w.search, s.w.next, approach);
}

void switch_models(const StepInProgress& s) {
  const InPhase phase(&s.w.profile, Phase::models);
  if (s.w.models.update(s.model, s.parameters, s.start, *s.w.reached, s.w.next, s.w.parts))
    s.w.forget_limits();
}

void apply_events(StepInProgress& s) {
  State& next = s.w.next;
  if (!s.model.anchors.empty()) {
    s.w.changed.assign(s.model.bodies.size(), false);
    if (switch_anchors(s.model, s.parameters, next, s.w.changed)) {
      // what ties bodies to each other decides which are stepped together
      const auto ties = [](const Anchor& anchor) { return anchor.other.body >= 0; };
      if (ranges::any_of(s.model.anchors, ties)) switch_models(s);
      balance_changed(s);
    }
  }
  if (next.law != s.parameters.contact.kind) change_law(s);
  if (s.parameters.adaptive) change_step(next, s.h);
  const Vec3 jump =
      floor_velocity_jump(s.parameters.shakes, s.from.time - k_time_slack, s.end() - k_time_slack);
  if (jump.isZero(0)) return;
  s.exchanged.input = jump_floor(s.model, jump, next);
  s.w.parts.balance(s.parameters, s.start, next);
}

StepStatus check_stability(const StepInProgress& s) {
  StepStatus status;
  const double share = stable_share(s.parameters);
  if (!std::isfinite(share)) return status;
  const std::optional<ExplicitLimit>& limit = s.w.find_explicit_limit(s.parameters, s.w.next);
  if (!limit || s.h <= share * limit->step) return status;
  status.kind = StepStatus::Kind::step_too_long;
  status.limit = share * limit->step;
  status.time = s.from.time;
  status.body = limit->body;
  status.node = limit->node;
  status.element = limit->element;
  return status;
}

StepStatus advance_parts(StepInProgress& s) {
  Workspace::Impl& w = s.w;
  const auto& parts = w.parts.all();
  const int count = static_cast<int>(parts.size());
  const StepSpan span{s.parameters, s.start, *w.reached, s.h, s.halvings};
  w.outcomes.resize(count);
  const auto advance = [&](int part, int worker) {
    PartScratch& scratch = w.scratches[worker];
    scratch.frame.profile = &w.profile;
    w.outcomes[part] = {};
    parts[part]->advance(span, w.next, scratch, w.outcomes[part]);
  };
  w.parts.with_sticks(w.next, [&] {
    if (w.parallel.run && count > 1 && !w.profile.clock)
      w.parallel.run(count, std::ref(advance));
    else
      for (int part = 0; part < count; ++part) advance(part, 0);
  });

  StepStatus status;
  int iterations = 0, rejected = 0;
  w.most_iterations = 0;
  for (const PartOutcome& outcome : w.outcomes) {
    iterations += outcome.status.newton_iterations;
    w.most_iterations = std::max(w.most_iterations, outcome.status.newton_iterations);
    rejected += outcome.status.rejected;
    if (!status.ok()) continue;
    status = outcome.status;
    s.held += outcome.held;
    s.exchanged += outcome.exchanged;
  }
  status.newton_iterations = iterations;
  status.rejected = rejected;
  return status;
}

HardestContact hardest_contact(const Parameters& parameters, const State& state, Workspace::Impl& w) {
  w.parts.arrange(state);
  const StepInputs now(parameters, state.time);
  w.forces.contacts.clear();
  w.forces.members.clear();
  for (const auto& part : w.parts.all()) part->list_forces(parameters, now, state, w.forces);
  HardestContact hardest;
  for (const auto& part : w.parts.all()) hardest = part->hardest_contact(hardest);
  return hardest;
}

bool contacts_dissipated(const EnergyLedger& from, const EnergyLedger& to) {
  return to.normal_damping != from.normal_damping || to.friction != from.friction;
}

// The floor's displacement is shown, and does not depend on the steps.
void move_floor(const StepInProgress& s) {
  State& next = s.w.next;
  const int parts = std::max(1, static_cast<int>(std::ceil(s.h / k_longest_floor_step)));
  Vec3 before = s.start.floor;
  for (int k = 1; k <= parts; ++k) {
    const Vec3 after = k == parts ? s.w.reached->floor
                                  : floor_acceleration(s.parameters.shakes, s.from.time + k * s.h / parts);
    advance_floor(next.floor_displacement, next.floor_velocity, before, after, s.h / parts);
    before = after;
  }
}

void close_ledger(const StepInProgress& s) {
  State& next = s.w.next;
  next.step = s.from.step + 1;
  next.time = s.end();
  move_floor(s);
  next.energy.close(s.exchanged, s.held);
}

void check(const StepInProgress& s, StepStatus& status) {
  const State& next = s.w.next;
  // explicit methods have looked at the accelerations
  const bool finite = s.w.parts.moves_nodes() ? is_finite(next, !traits(s.parameters.integrator).is_explicit)
                                              : moves_finite(next);
  if (!finite) {
    status.kind = StepStatus::Kind::not_finite;
    status.time = next.time;
    status.body = body_not_finite(s.model, next);
  } else if (next.energy.balance_error() > k_lost_balance &&
             std::abs(next.energy.unexplained()) > k_least_energy) {
    HardestContact hardest = hardest_contact(s.parameters, s.from, s.w);
    if (hardest.force == 0) hardest = hardest_contact(s.parameters, next, s.w);
    if (hardest.force > 0 || contacts_dissipated(s.from.energy, next.energy) ||
        next.energy.plastic != s.from.energy.plastic) {
      status.kind = StepStatus::Kind::energy_lost;
      status.time = next.time;
      status.body = hardest.body;
      status.node = hardest.node;
      status.element = hardest.element;
    }
  }
}

}  // namespace topple
