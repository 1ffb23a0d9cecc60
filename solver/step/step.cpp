#include "solver/step/step.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "solver/body/rungs.h"
#include "solver/body/step_control.h"
#include "solver/element/damping.h"
#include "solver/frame/central_difference.h"
#include "solver/frame/generalized_alpha.h"
#include "solver/frame/settle.h"
#include "solver/model/excitation.h"
#include "solver/state/energy.h"
#include "solver/step/balance.h"
#include "solver/step/step_forces.h"
#include "solver/step/workspace.h"

namespace topple {
namespace {

constexpr int k_halvings = 6;
constexpr double k_time_slack = 1e-9;   // s, times are sums of rounded steps
constexpr double k_safety = 0.9;        // of the error that is aimed at
constexpr double k_most_growth = 2;     // from step to step
constexpr double k_most_shrinking = 5;  // of a step that is tried again
constexpr int k_many_iterations = 8;    // of Newton: the step does not grow
constexpr double k_explicit_share = 0.9;
constexpr int k_bodies_per_task = 16;    // that are not frames: some microseconds
constexpr double k_least_energy = 1e-6;  // J, below it a balance is rounding

}  // namespace

Workspace::Workspace(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

void Workspace::share(ParallelFor parallel) {
  impl_->scratches.resize(parallel.workers);
  impl_->reduced_scratch.resize(parallel.workers);
  impl_->parallel = std::move(parallel);
}

Profile& Workspace::profile() {
  return impl_->profile;
}

StepStatus settle(const Model& model, const Parameters& parameters, State& state, Workspace& workspace) {
  StepStatus status = look_at_numbers(model, parameters, state, true);
  if (!status.ok()) return status;
  Workspace::Impl& w = workspace.impl();
  start_rungs(model, parameters, state, w);
  w.new_anchors.assign(model.bodies.size(), false);
  switch_anchors(model, parameters, state, w.new_anchors);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (state.bodies[b].rung == Rung::frame) continue;
    if (!w.reduced(model, state, b).settle(parameters, state.bodies[b], state.stick)) {
      status.kind = StepStatus::Kind::not_settled;
      status.time = state.time;
      status.body = b;
      return status;
    }
  }
  for (auto& system : w.systems()) {
    status = settle_system(*system, parameters, state, w.scratches[0]);
    if (!status.ok()) return status;
  }
  return status;
}

void prepare(const Model& model, const Parameters& parameters, State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  start_rungs(model, parameters, state, w);
  EnergyLedger& energy = state.energy;
  w.new_anchors.assign(model.bodies.size(), false);
  switch_anchors(model, parameters, state, w.new_anchors);
  break_anchors(model, state, w.new_anchors);
  energy.released = 0;  // what settling left in them was never in the run
  const BodyEnergy held = balance_all(model, parameters, state, w);
  state.law = parameters.contact.kind;
  take(held, energy);
  energy.start_total = held.kinetic + held.strain + held.contact + held.anchor;
  energy.largest = std::max(held.kinetic, held.strain + held.contact + held.anchor);
}

void resume(const Model& model, const State& state, Workspace& workspace) {
  workspace.impl().islands.arrange(state.bodies, state.near);
  section_forces(model, state, workspace.impl().sections);
}

namespace {

// The floor's velocity jumps by `floor`: bodies keep their own, so they move the other way in the floor's
// frame. Returns the kinetic energy that they gain there.
double jump(const Model& model, const Vec3& floor, State& state) {
  double gain = 0;
  const auto push = [&](double mass, Vec3& velocity) {
    gain -= 0.5 * mass * velocity.squaredNorm();
    velocity -= floor;
    gain += 0.5 * mass * velocity.squaredNorm();
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (state.bodies[b].rung != Rung::frame) {
      push(body.mass, state.bodies[b].velocity);
      continue;
    }
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      push(model.node_mass[i], state.velocity[i]);
  }
  for (const Support& support : model.supports)
    for (int k = 0; k < 3; ++k)
      if (support.fixed >> k & 1) {
        double& v = state.velocity[support.node][k];
        gain -= 0.5 * model.node_mass[support.node] * v * v;
        v = 0;
      }
  state.floor_velocity += floor;
  return gain;
}

// With the stiffer of the two laws of a passage.
void find_explicit_limit(const Model& model, const Parameters& parameters, const State& state,
                         Workspace::Impl& w) {
  if (w.explicit_limit) return;
  ContactLaw law = parameters.contact;
  if (parameters.contact_passage.over > 0) {
    law.alpha = std::max(law.alpha, parameters.contact_before.alpha);
    law.q = std::max(law.q, parameters.contact_before.q);
  }
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    BodySystem* const system = state.bodies[b].rung == Rung::frame ? w.islands.alone(b) : nullptr;
    if (!system) continue;
    int node = -1;
    const double limit = explicit_limit(*system, &law, damping_time(model, parameters, b), &node);
    if (limit >= w.explicit_limit.value_or(1e300)) continue;
    w.explicit_limit = limit;
    w.limiting_body = b;
    w.limiting_node = node;
  }
}

// One step of size h from w.next, whose near elements are known, into w.next.
StepStatus try_known(const Model& model, const Parameters& parameters, const State& state, double h,
                     int halvings, Workspace::Impl& w) {
  const double t = state.time;
  const Instant start = w.reached && w.reached->time == t ? *w.reached : Instant(parameters, t);
  const Instant& end = w.reached.emplace(parameters, t + h, start);
  {
    const InPhase phase(&w.profile, Phase::ladder);
    change_rungs(model, parameters, start, w.next, w);
    if (!model.anchors.empty()) {
      w.new_anchors.assign(model.bodies.size(), false);
      if (switch_anchors(model, parameters, w.next, w.new_anchors))
        balance_again(model, parameters, start, w.new_anchors, w.next, w);
    }
    if (w.next.law != parameters.contact.kind) change_law(model, parameters, w.next, w);
  }
  const bool is_explicit = parameters.integrator == Integrator::central_difference;
  StepStatus status;
  if (is_explicit) {
    find_explicit_limit(model, parameters, w.next, w);
    if (w.explicit_limit && h > *w.explicit_limit) {
      status.kind = StepStatus::Kind::step_too_long;
      status.limit = *w.explicit_limit;
      status.time = t;
      status.body = w.limiting_body;
      status.node = w.limiting_node;
      status.element = w.islands.alone(w.limiting_body)->element_at(w.limiting_node);
      return status;
    }
  }
  State& next = w.next;
  if (parameters.adaptive) change_step(next, h);
  StepEnergy exchanged;
  if (const Vec3 floor = floor_velocity_jump(parameters.shakes, t - k_time_slack, t + h - k_time_slack);
      !floor.isZero(0)) {
    exchanged.input = jump(model, floor, next);
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
      if (next.bodies[b].rung != Rung::frame)
        w.reduced(model, next, b).balance(parameters, start, next.bodies[b], next.stick);
    for (auto& system : w.systems()) balance_accelerations(*system, parameters, next, w.motion);
  }

  w.moving.clear();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (next.bodies[b].rung != Rung::frame) w.moving.push_back(b);
  const int bodies = static_cast<int>(w.moving.size()),
            chunks = (bodies + k_bodies_per_task - 1) / k_bodies_per_task,
            systems = static_cast<int>(w.systems().size());
  w.parts.resize(chunks + systems);
  const auto move_bodies = [&](int chunk, int worker) {
    PartOfStep& part = w.parts[chunk] = {};
    for (int k = chunk * k_bodies_per_task; k < std::min(bodies, (chunk + 1) * k_bodies_per_task); ++k) {
      const int b = w.moving[k];
      ReducedBody& body = w.reduced(model, next, b);
      part.status.kind = body.advance(parameters, start, end, h, next.bodies[b], next.stick, part.exchanged,
                                      w.reduced_scratch[worker]);
      if (!part.status.ok()) {
        part.status.time = end.time;
        part.status.body = b;
        return;
      }
      add(body.energy(end.law, next.bodies[b]), part.held);
    }
  };
  const auto move_system = [&](int s, int worker) {
    BodySystem& system = *w.systems()[s];
    PartOfStep& part = w.parts[chunks + s] = {};
    IntegratorScratch& scratch = w.scratches[worker];
    scratch.profile = &w.profile;
    {
      const InPhase phase(scratch.profile, Phase::forces);
      part.status =
          is_explicit
              ? advance_central_difference(system, parameters, next, t, h, scratch, part.exchanged)
              : advance_generalized_alpha(system, parameters, next, t, h, halvings, scratch, part.exchanged);
    }
    if (!part.status.ok()) return;
    const InPhase phase(scratch.profile, Phase::energy);
    add(system.energy(end.law, scratch.trial, system.contacts, w.sections), part.held);
  };
  const auto move = [&](int task, int worker) {
    if (task < chunks) {
      const InPhase phase(&w.profile, Phase::reduced);
      move_bodies(task, worker);
    } else {
      move_system(task - chunks, worker);
    }
  };
  if (w.parallel.run && chunks + systems > 1 && !w.profile.clock) {
    for (BodySystem* system : w.systems()) system->take_sticks(next);
    w.parallel.run(chunks + systems, std::ref(move));
    for (BodySystem* system : w.systems()) system->give_sticks(next);
  } else {
    for (int task = 0; task < chunks + systems; ++task) move(task, 0);
  }
  BodyEnergy held;
  int iterations = 0, rejected = 0;
  w.most_iterations = 0;
  status = {};
  for (const PartOfStep& part : w.parts) {
    iterations += part.status.newton_iterations;
    w.most_iterations = std::max(w.most_iterations, part.status.newton_iterations);
    rejected += part.status.rejected;
    if (!status.ok()) continue;
    status = part.status;
    add(part.held, held);
    exchanged.input += part.exchanged.input;
    exchanged.gravity += part.exchanged.gravity;
    exchanged.friction += part.exchanged.friction;
    exchanged.normal_damping += part.exchanged.normal_damping;
    exchanged.numerical += part.exchanged.numerical;
    exchanged.plastic += part.exchanged.plastic;
    exchanged.damping += part.exchanged.damping;
  }
  status.newton_iterations = iterations;
  status.rejected = rejected;
  if (!status.ok()) return status;

  next.step = state.step + 1;
  next.time = t + h;
  advance_floor(next.floor_displacement, next.floor_velocity, start.floor, end.floor, h);
  EnergyLedger& e = next.energy;
  e.input += exchanged.input;
  e.gravity += exchanged.gravity;
  e.friction += exchanged.friction;
  e.normal_damping += exchanged.normal_damping;
  e.numerical += exchanged.numerical;
  e.plastic += exchanged.plastic;
  e.damping += exchanged.damping;
  take(held, e);
  e.largest = std::max(
      {e.largest, std::abs(e.input), e.kinetic, std::abs(e.gravity), e.strain + e.contact + e.anchor});
  // central differences have looked at the accelerations
  if (!(w.systems().empty() ? moves_finite(next) : is_finite(next, !is_explicit))) {
    status.kind = StepStatus::Kind::not_finite;
    status.time = next.time;
    status.body = body_not_finite(model, next);
  } else if (e.balance_error() > k_lost_balance && std::abs(e.unexplained()) > k_least_energy &&
             blame_hardest_contact(model, w, status)) {
    status.kind = StepStatus::Kind::energy_lost;
    status.time = next.time;
  }
  return status;
}

// Whether a step needs the per-node arrays: there are frames, or `w` has never seen this state.
bool moves_nodes(const State& state, const Workspace::Impl& w) {
  return !w.systems().empty() || w.next.position.size() != state.position.size();
}

// One step of size h into w.next.
StepStatus try_step(const Model& model, const Parameters& parameters, const State& state, double h,
                    int halvings, Workspace::Impl& w) {
  constexpr int k_most_looks = 4;
  double travel = model.bodies.size() > 1 ? likely_travel(model, state, h) : 0;
  StepStatus status;
  for (int look = 0; look < k_most_looks; ++look) {
    {
      const InPhase phase(&w.profile, Phase::search);
      copy(state, w.next, moves_nodes(state, w));
      look_around(model, w.search, w.next, travel);
    }
    status = try_known(model, parameters, state, h, halvings, w);
    if (!status.ok() || model.bodies.size() < 2) return status;
    travel = greatest_travel(model, state, w.next);
    if (2 * travel < w.next.near_slack) {
      w.next.near_slack -= 2 * travel;
      return status;
    }
  }
  status.kind = StepStatus::Kind::passed_through;
  status.time = w.next.time;
  return status;
}

// The size to try next after one of size h with this error and these iterations.
double next_size(double h, double error, int iterations) {
  double growth = error > 0 ? k_safety / std::sqrt(error) : k_most_growth;
  if (iterations > k_many_iterations) growth = std::min(growth, 1.);
  return h * std::clamp(growth, 1 / k_most_shrinking, k_most_growth);
}

// At most h, so that what is left of the way takes no step much shorter than the others.
double fit(double h, double left) {
  if (left <= h) return left;
  return left < 2 * h ? left / 2 : h;
}

// look_ahead of all bodies.
double next_limit(const Model& model, const Parameters& parameters, const State& state, Workspace::Impl& w) {
  double limit = look_ahead(model, parameters, state);
  const ContactLaw law = contact_law(parameters, state.time);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (state.bodies[b].rung != Rung::frame)
      limit = std::min(limit, w.reduced(model, state, b).look_ahead(law, state.bodies[b]));
  return std::max(limit, 2 * k_least_step);
}

// The step in w.next is taken.
void accept(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  if (!model.anchors.empty()) {
    w.new_anchors.assign(model.bodies.size(), false);
    if (break_anchors(model, w.next, w.new_anchors))
      balance_again(model, parameters, Instant(parameters, w.next.time), w.new_anchors, w.next, w);
  }
  take(w.next, state, moves_nodes(state, w));
}

StepStatus adaptive_step(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w,
                         double until) {
  if (parameters.integrator == Integrator::central_difference)
    find_explicit_limit(model, parameters, state, w);
  const bool is_explicit = w.explicit_limit.has_value();  // no frame, no limit: bodies bound their errors
  const double left = std::min(until, next_kink(model, parameters, state.time)) - state.time;
  double h = state.step_size > 0 ? state.step_size : k_first_step;
  h = is_explicit ? k_explicit_share * *w.explicit_limit
                  : std::min(h, next_limit(model, parameters, state, w));
  h = fit(h, left);
  StepStatus status;
  int iterations = 0, rejected = 0;
  for (;;) {
    status = try_step(model, parameters, state, h, 0, w);
    iterations += status.newton_iterations;
    const double error = status.ok() && !is_explicit ? step_error(model, parameters, state, w.next, h) : 0;
    if (status.ok() && error <= 1) {
      if (h == left) w.next.time = state.time + left;
      const double wanted = std::min(next_size(h, error, w.most_iterations), k_longest_step);
      w.next.step_size = h;
      if (!is_explicit) change_step(w.next, std::min(wanted, next_limit(model, parameters, w.next, w)));
      accept(model, parameters, state, w);
      break;
    }
    if (status.kind == StepStatus::Kind::step_too_long) {  // a body becomes a frame
      ++rejected;
      h = k_explicit_share * status.limit;
      continue;
    }
    if (is_explicit || h < 2 * k_least_step) {
      if (status.ok()) {
        status.kind = StepStatus::Kind::not_accurate;
        status.time = w.next.time;
      }
      break;
    }
    ++rejected;
    h = std::max(status.ok() ? std::min(next_size(h, error, 0), h / 1.2) : h / 2, k_least_step);
  }
  status.newton_iterations = iterations;
  status.rejected = rejected;
  status.by_tolerance = !is_explicit;
  return status;
}

}  // namespace

StepStatus step(const Model& model, const Parameters& parameters, State& state, Workspace& workspace,
                double until) {
  Workspace::Impl& w = workspace.impl();
  if (w.parameters != parameters || !is_finite(state, false)) {
    const StepStatus status = look_at_numbers(model, parameters, state, false);
    if (!status.ok()) return status;
    w.meet(parameters);
  }
  if (parameters.adaptive) return adaptive_step(model, parameters, state, w, until);
  const double h = parameters.time_step;
  const StepStatus status = try_step(model, parameters, state, h, k_halvings, w);
  if (status.ok()) accept(model, parameters, state, w);
  return status;
}

std::optional<double> explicit_limit(Workspace& workspace) {
  return workspace.impl().explicit_limit;
}

}  // namespace topple
