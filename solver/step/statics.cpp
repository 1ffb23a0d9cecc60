#include "solver/step/statics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/body/anchors.h"
#include "solver/contact/contact_law.h"
#include "solver/element/beam.h"
#include "solver/element/plasticity.h"
#include "solver/frame/hinges.h"
#include "solver/frame/settle.h"
#include "solver/math/rotation.h"
#include "solver/step/controlled_way.h"
#include "solver/step/own_weight.h"
#include "solver/step/stability_of.h"

namespace topple {
namespace {

constexpr int k_most_iterations = 40;
constexpr double k_convergence = 1e-11;  // of the body's size, error left
constexpr double k_quadratic = 1e-8;     // of the body's size: the correction after one this small is noise
constexpr double k_furthest = 1;         // of the body's size, travel within a load step
constexpr double k_most_turn = 1.5;      // rad, within a load step: more is another equilibrium
constexpr double k_least_part = 1. / 1024;  // of a load step
constexpr double k_left = 0.5;              // of the work along a correction: a line search ends with less
constexpr int k_most_searches = 30;
constexpr int k_patience = 8;  // partial corrections, after which what is left may be enough (is_balanced)
constexpr double k_least_damping = 1e-6, k_damped_more = 10;  // of add_levenberg, 1 at most
constexpr double k_further = 4;  // of the first correction: no later one of a frame that yields goes further

// Six numbers per node, of the last evaluation.
void unbalance(const BodySystem& s, std::vector<double>& forces) {
  for (int i = 0; i < s.count; ++i)
    for (int k = 0; k < 6; ++k) forces[6 * i + k] = k < 3 ? s.force[i][k] : s.moment[i][k - 3];
}

// Of an element at a trial motion.
SectionResponse response_at(const BodySystem& s, const BodyMotion& at, std::size_t n) {
  const auto [e, i, j] = s.own_elements[n];
  const Element& element = s.model.elements[e];
  return respond(
      element, s.elements[n],
      beam_strain(element, beam_ends(at.position[i], at.rotation[i], at.position[j], at.rotation[j])));
}

bool flows_anywhere(const BodySystem& s, const BodyMotion& at) {
  for (std::size_t n = 0; n < s.elements.size(); ++n)
    if (response_at(s, at, n).flows()) return true;
  return false;
}

// Whether what is left is no more than what rounding of the positions makes, beside 1e-8 of what the sections
// bear. An element's force along an axis is as uncertain as that coordinate of its ends, its end moments as
// the forces across it.
bool is_balanced(const BodySystem& s, const BodyMotion& at, const std::vector<double>& forces) {
  constexpr double k_share = 1e-8, k_rounding = 4 * std::numeric_limits<double>::epsilon();
  std::vector<double> allowed(forces.size(), 0.);
  for (std::size_t n = 0; n < s.elements.size(); ++n) {
    const auto [e, i, j] = s.own_elements[n];
    const Element& element = s.model.elements[e];
    const double bears = k_share * element.capacity.tail<3>().minCoeff();
    if (!std::isfinite(bears)) continue;
    const Vec3 force = k_rounding * element.normal_stiffness.maxCoeff() / element.length *
                       at.position[i].cwiseAbs().cwiseMax(at.position[j].cwiseAbs());
    const Vec3 arm = (at.position[j] - at.position[i]).cwiseAbs() / 2;
    const Vec3 moment(arm.y() * force.z() + arm.z() * force.y(), arm.z() * force.x() + arm.x() * force.z(),
                      arm.x() * force.y() + arm.y() * force.x());
    for (const int node : {i, j})
      for (int k = 0; k < 3; ++k) {
        allowed[6 * node + k] += force[k] + bears / s.size;
        allowed[6 * node + 3 + k] += moment[k] + bears;
      }
  }
  for (std::size_t k = 0; k < forces.size(); ++k)
    if (!(std::abs(forces[k]) <= allowed[k])) return false;
  return flows_anywhere(s, at);  // a mechanism without hinges is in balance wherever it is: that is none
}

// The greatest of a correction, m, its node, and whether the trial is another equilibrium's.
struct Correction {
  double greatest = 0;
  int node = 0;
  bool too_far = false;
};

struct Furthest {
  double way = 0;  ///< m
  int node = 0;
};
Furthest furthest_of(const BodySystem& s, const std::vector<double>& x) {
  Furthest out;
  for (int i = 0; i < s.count; ++i) {
    const double way = std::max(Vec3(&x[6 * i]).norm(), s.size * Vec3(&x[6 * i + 3]).norm());
    if (!(way <= out.way)) out = {way, i};
  }
  return out;
}

// Levenberg's: `share` of what bending holds the nodes with, so that what hinges leave open does not leap.
void add_levenberg(BodySystem& s, double share) {
  if (share == 0) return;
  for (const auto& [e, i, j] : s.own_elements) {
    const Element& element = s.model.elements[e];
    const double turn = share * element.bending_stiffness.minCoeff() / element.length;
    Mat6 block = Mat6::Zero();
    block.diagonal().head<3>().setConstant(turn / (element.length * element.length));
    block.diagonal().tail<3>().setConstant(turn);
    s.lu.add(i, i, block);
    s.lu.add(j, j, block);
  }
}

// Six numbers of `x` per node, onto the trial motion and the turns from the start.
Correction correct(const BodySystem& s, const BodyMotion& start, const std::vector<double>& x,
                   BodyMotion& trial, std::vector<Vec3>& turn) {
  Correction out;
  for (int i = 0; i < s.count; ++i) {
    const Vec3 shift(&x[6 * i]), spin(&x[6 * i + 3]);
    trial.position[i] += shift;
    trial.rotation[i] = exp_quaternion(spin) * trial.rotation[i];
    trial.rotation[i].normalize();
    turn[i] += spin;
    out.too_far = out.too_far || (trial.position[i] - start.position[i]).norm() > k_furthest * s.size ||
                  turn[i].norm() > k_most_turn;
    const double size = std::max(shift.norm(), s.size * spin.norm());
    if (!(size <= out.greatest)) {
      out.greatest = size;
      out.node = i;
    }
  }
  return out;
}

}  // namespace

LoadPath::LoadPath(const Model& model, const StaticSettings& settings)
    : model_(&model), settings_(settings), sections_(model.elements.size()) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    systems_.push_back(std::make_unique<BodySystem>(model, b));
    systems_.back()->loads_grow = true;
  }
  start_.resize(systems_.size());
  trial_.resize(systems_.size());
}

int LoadPath::controlled_body() const {
  return settings_.control ? model_->node_body[settings_.control->node] : -1;
}

// What a load step goes along, six numbers per node of the controlled body.
std::vector<double> LoadPath::controlled_way(const BodySystem& s, const State& state) const {
  std::vector<double> along(6 * s.count, 0.);
  const PathControl& control = *settings_.control;
  if (!control.arc_length) {
    along[6 * (control.node - s.first) + control.direction] = 1;
    return along;
  }
  double square = 0;
  for (int i = 0; i < s.count; ++i) square += state.algorithmic_acceleration[s.first + i].squaredNorm();
  for (int i = 0; i < s.count; ++i)
    for (int k = 0; k < 3; ++k)
      along[6 * i + k] = state.algorithmic_acceleration[s.first + i][k] / std::sqrt(square * s.count);
  return along;
}

// Forces and tangent of the trial motion; fixed directions are out.
void LoadPath::evaluate(BodySystem& s, const Parameters& still, const State& state, double factor) {
  const BodyMotion& trial = trial_[s.index];
  s.lu.set_zero();
  s.evaluate_with_tangent(still, StepInputs(still, factor), trial, state.stick, start_[s.index].position, 0);
  distribute_weight(s, still.gravity, trial.position);
  for (int i = 0; i < s.count; ++i) {
    s.clear_fixed(i, s.force[i], s.moment[i]);
    for (int k = 0; k < 6; ++k)
      if (s.is_fixed(i, k)) s.lu.fix(i, k);
  }
}

// Derivative of the applied forces by the load factor, six numbers per node.
std::vector<double> LoadPath::growing_loads(const BodySystem& s) const {
  std::vector<double> loads(6 * s.count, 0.);
  for (const auto& [load, i] : s.loads)
    for (int k = 0; k < 6; ++k)
      if (load->history.empty() && !s.is_fixed(i, k))
        loads[6 * i + k] += k < 3 ? load->force[k] : load->moment[k - 3];
  return loads;
}

// Part of a correction that is taken. Where sections begin or cease to flow Newton's way may overshoot: to
// where little is left of the `work` with which the forces begin along it (Matthies and Strang 1979).
double LoadPath::search_line(BodySystem& s, const Parameters& still, const State& state, double factor,
                             const NewtonStep& step) {
  BodyMotion& trial = trial_[s.index];
  const BodyMotion from = trial;
  const std::vector<double>& x = step.x;
  std::vector<double> way(x.size()), forces(x.size());
  std::vector<Vec3> turn(s.count);
  const double work = dot(step.forces, x) + step.change * dot(step.growth, x);
  const auto work_at = [&](double part) {
    for (std::size_t i = 0; i < x.size(); ++i) way[i] = part * x[i];
    correct(s, from, way, trial, turn);
    evaluate(s, still, state, factor + step.change);
    unbalance(s, forces);
    trial = from;
    return dot(forces, x);
  };
  if (!(work > 0)) return 1;
  double at = 1, left = work_at(at);
  if (left >= -k_left * work) return 1;
  // between parts with work along and against it by the Illinois rule
  double less = 0, less_work = work, more = at, more_work = left;
  for (int k = 0; k < k_most_searches && std::abs(left) > k_left * work; ++k) {
    at = less + (more - less) * less_work / (less_work - more_work);
    left = work_at(at);
    if (left > 0) {
      less = at;
      less_work = left;
      more_work /= 2;
    } else {
      more = at;
      more_work = left;
      less_work /= 2;
    }
  }
  return at;
}

// Newton's correction of the trial, damped while it would go further than it may. The node whose tangent is
// singular, or that leaps however it is damped; -1: found.
int LoadPath::find_correction(BodySystem& s, const Parameters& still, const State& state, double factor,
                              ControlledWay* way, NewtonStep& step) {
  step.damping = step.damping > k_least_damping ? step.damping / k_damped_more : 0;
  while (true) {
    evaluate(s, still, state, factor);
    if (way) way->add_spring(s);
    add_levenberg(s, step.damping);
    const int singular = s.lu.factor();
    unbalance(s, step.x);
    step.forces = step.x;
    int leaps = singular;
    if (singular < 0) {
      s.lu.solve(step.x.data());
      step.change = way ? way->go(s, step.growth, step.x) : 0;
      const Furthest furthest = furthest_of(s, step.x);
      if (!s.yields || furthest.way <= step.reach) {
        if (!std::isfinite(step.reach)) step.reach = k_further * furthest.way;
        return -1;
      }
      leaps = furthest.node;
    }
    if (!s.yields || step.damping >= 1) return leaps;
    step.damping = step.damping > 0 ? k_damped_more * step.damping : k_least_damping;
  }
}

StepStatus LoadPath::balance_body(BodySystem& s, const Parameters& still, const State& state,
                                  std::optional<double> travel, double& factor) {
  BodyMotion &start = start_[s.index], &trial = trial_[s.index];
  s.load(state, start);
  trial = start;
  StepStatus status;
  status.kind = StepStatus::Kind::no_equilibrium;
  status.body = s.index;
  std::optional<ControlledWay> way;
  if (travel) way.emplace(s, controlled_way(s, state), *travel);
  NewtonStep step(growing_loads(s));
  s.load_memory(state, start);
  std::vector<Vec3> turn(s.count, Vec3::Zero());
  constexpr double k_none = std::numeric_limits<double>::infinity();
  const double tolerance = k_convergence * s.size;
  double last = k_none;  // whole correction
  int partial = 0;       // corrections that were not, one after the other
  bool released = false;
  const auto blame = [&](int node) {
    status.node = s.first + node;
    status.element = s.element_at(status.node);
    status.load_factor = factor;
    for (std::size_t k = 0; k < s.elements.size(); ++k) {
      const int e = s.own_elements[k].element;
      if (s.elements[k].hinge != Hinge::broken || state.elements[e].hinge == Hinge::broken) continue;
      status.element = e;
      status.stability.loss = Stability::Loss::fracture;
      break;
    }
    return status;
  };
  // where many sections of one moment come to yield at once, some begin to flow in each iteration
  const int most = k_most_iterations + (s.yields ? static_cast<int>(s.elements.size()) : 0);
  for (int iteration = 1; iteration <= most; ++iteration) {
    status.newton_iterations = iteration;
    if (iteration > 1) hold_joints(s, start, trial);
    const auto correction = [&] {
      return find_correction(s, still, state, factor, way ? &*way : nullptr, step);
    };
    int leaping = correction();
    if (leaping >= 0 && std::exchange(released, false)) {
      step.reach = k_none;  // what was held, or is gone, may have to go further
      leaping = correction();
    }
    if (leaping >= 0) return blame(leaping);
    bool found = partial >= k_patience && is_balanced(s, trial, step.forces) &&
                 (!way || std::abs(way->left()) < tolerance);
    if (!found) {
      const double part = iteration > 1 && s.yields ? search_line(s, still, state, factor, step) : 1;
      factor += part * step.change;
      for (double& value : step.x) value *= part;
      if (way) way->take(step.x);
      const auto [greatest, node, too_far] = correct(s, start, step.x, trial, turn);
      if (too_far || !std::isfinite(greatest + factor)) return blame(node);
      status.node = node;
      const bool whole = part == 1 && step.damping == 0;
      const double rate = std::isfinite(last) ? greatest / last : 1;
      found = whole && (greatest < tolerance || last < k_quadratic * s.size ||
                        (rate < 0.5 && greatest * rate / (1 - rate) < tolerance));
      last = whole ? greatest : k_none;
      partial = whole ? 0 : partial + 1;
    }
    if (!found) continue;
    const bool flows = release_joints(s, trial), breaks = !flows && break_sections(s, trial);
    if (breaks) hold_ends(s);
    if (flows || breaks) {
      iteration = partial = 0;
      last = k_none;
      released = true;
      continue;
    }
    evaluate(s, still, state, factor);
    status.stability = stability_of(s, step.growth);
    if (!status.stability.stable() && flows_anywhere(s, trial))
      status.stability.loss = Stability::Loss::mechanism;
    if (settings_.stop_at_instability && !status.stability.stable()) return blame(status.node);
    status.kind = StepStatus::Kind::ok;
    return status;
  }
  return blame(status.node);
}

// By a body's last equilibrium, when there is none beyond it: where sections yield it collapses, else its
// softest mode runs away.
Stability LoadPath::what_is_lost(const Parameters& parameters, const State& state, int body) {
  BodySystem& s = *systems_[body];
  s.load(state, start_[body]);
  s.load_memory(state, start_[body]);
  trial_[body] = start_[body];
  evaluate(s, at_rest(parameters), state, state.load_factor);
  const std::vector<double> growth = growing_loads(s);
  Stability out = stability_of(s, growth);
  if (out.negative_pivots >= 0 && out.loss != Stability::Loss::mechanism && is_free(s))
    return {.loss = Stability::Loss::mechanism};
  if (out.negative_pivots == 0 && !(is_at_yield(*model_, state, body) && add_collapse(s, growth, out)))
    add_softest_mode(s, growth, out);
  return out;
}

StepStatus LoadPath::balance(const Parameters& parameters, State& state, Target target) {
  StepStatus status = look_at_numbers(*model_, parameters, state, true);
  if (!status.ok()) return status;
  const Parameters still = at_rest(parameters);
  double factor = target.factor;
  int iterations = 0;
  Stability worst;
  const int first = controlled_body();
  const auto solve = [&](BodySystem& system) {
    status = balance_body(system, still, state, system.index == first ? target.travel : std::nullopt, factor);
    status.newton_iterations = iterations += status.newton_iterations;
    if (status.stability.negative_pivots > worst.negative_pivots) worst = status.stability;
    return status.ok();
  };
  if (first >= 0 && !solve(*systems_[first])) return status;
  for (auto& system : systems_)
    if (system->index != first && !solve(*system)) return status;
  accept(still, factor, state);
  stability_ = worst;
  return status;
}

// Every body is in balance: the one place where a trial becomes the state.
void LoadPath::accept(const Parameters& still, double factor, State& state) {
  EnergyLedger& energy = state.energy;
  energy.strain = energy.contact = energy.anchor = 0;
  for (auto& system : systems_) {
    BodySystem& s = *system;
    const BodyMotion &start = start_[s.index], &trial = trial_[s.index];
    for (const auto& own : s.loads) {
      const Load* const load = own.load;
      const int i = own.node;
      const auto share = [&](double at) { return load->history.empty() ? at : load_factor(*load, at); };
      const Vec3 turn = start.rotation[i] * log_quaternion(start.rotation[i].conjugate() * trial.rotation[i]);
      energy.input += (share(state.load_factor) + share(factor)) / 2 *
                      (load->force.dot(trial.position[i] - start.position[i]) + load->moment.dot(turn));
    }
    energy.plastic += commit_hinges(*system, start, trial, state);
    for (int i = 0; i < s.count; ++i) {
      const int g = s.first + i;
      if (settings_.control && settings_.control->arc_length)
        state.algorithmic_acceleration[g] = trial.position[i] - start.position[i];
      energy.gravity -= s.model.node_mass[g] * still.gravity.dot(trial.position[i] - start.position[i]);
      state.position[g] = trial.position[i];
      state.rotation[g] = trial.rotation[i];
      state.velocity[g].setZero();
      state.angular_velocity[g].setZero();
    }
    s.store_stick(s.contacts, state);
    const BodyEnergy held = s.energy(still.contact, trial, s.contacts, sections_);
    energy.strain += held.strain;
    energy.contact += held.contact;
    energy.anchor += held.anchor;
  }
  state.load_factor = factor;
}

void LoadPath::add_weight(const Parameters& parameters, const State& state,
                          std::vector<SectionForces>& sections) const {
  for (const auto& system : systems_) topple::add_weight(*system, parameters.gravity, state, sections);
}

// How far a load step's share of the loads moves what is controlled from here. With arc length it is the way
// of the first load step.
std::optional<double> LoadPath::first_travel(const Parameters& parameters, State& state) {
  BodySystem& s = *systems_[controlled_body()];
  s.load(state, start_[s.index]);
  trial_[s.index] = start_[s.index];
  evaluate(s, at_rest(parameters), state, 0);
  if (s.lu.factor() >= 0) return std::nullopt;
  std::vector<double> by_factor = growing_loads(s);
  s.lu.solve(by_factor.data());
  if (settings_.control->arc_length)
    for (int i = 0; i < s.count; ++i) state.algorithmic_acceleration[s.first + i] = Vec3(&by_factor[6 * i]);
  const std::vector<double> along = controlled_way(s, state);
  const double travel = dot(along, by_factor) / settings_.load_steps;
  if (!(std::abs(travel) > k_convergence * s.size)) return std::nullopt;
  return travel;
}

StepStatus LoadPath::start(const Parameters& parameters, bool settled, State& state) {
  StepStatus status;
  std::vector<char> changed(model_->bodies.size());
  switch_anchors(*model_, parameters, state, changed);
  IntegratorScratch scratch;
  for (auto& system : systems_)
    if (settled && status.ok()) status = settle_system(*system, parameters, state, scratch);
  if (!status.ok()) return status;
  status = balance(parameters, state, {0});
  if (status.kind == StepStatus::Kind::no_equilibrium && status.stability.loss == Stability::Loss::none)
    status.stability = what_is_lost(parameters, state, status.body);
  if (!status.ok() || !settings_.control) return status;
  const PathControl& control = *settings_.control;
  std::optional<double> travel;
  if (control.arc_length || !control.to) travel = first_travel(parameters, state);
  if (control.to && (travel || !control.arc_length)) travel = *control.to / settings_.load_steps;
  if (travel) {
    state.step_size = *travel;
  } else {
    status.kind = StepStatus::Kind::uncontrolled;
    status.body = controlled_body();
    status.node = control.node;
  }
  return status;
}

StepStatus LoadPath::advance(const Parameters& parameters, State& state) {
  const double steps = settings_.load_steps, before = static_cast<double>(state.step);
  double done = 0, part = 1;
  int iterations = 0, rejected = 0;
  StepStatus status;
  std::vector<char> changed(model_->bodies.size());
  switch_anchors(*model_, parameters, state, changed);
  // where a path bends off Newton may step over to an equilibrium that is not stable: closer before that
  bool looks_closer = !settings_.control && stability_.stable();
  while (done < 1) {
    const State from = looks_closer ? state : State{};
    const Stability stable = stability_;
    const Target target = settings_.control ? Target{state.load_factor, part * state.step_size}
                                            : Target{(before + done + part) / steps};
    status = balance(parameters, state, target);
    iterations += status.newton_iterations;
    const bool unstable = status.ok() && looks_closer && !stability_.stable();
    if (unstable && part / 2 >= k_least_part) {
      state = from;
      stability_ = stable;
      ++rejected;
      part /= 2;
    } else if (status.ok()) {
      looks_closer = looks_closer && !unstable;
      done += part;
      part = std::min(2 * part, 1 - done);
      state.time = settings_.control ? (before + done) / steps : state.load_factor;
    } else {
      ++rejected;
      part /= 2;
      if (part < k_least_part) break;
    }
  }
  if (done > 0) ++state.step;
  // where it was unstable before, what is lost is not why it ends
  if (status.kind == StepStatus::Kind::no_equilibrium && status.stability.loss == Stability::Loss::none &&
      stability_.stable())
    status.stability = what_is_lost(parameters, state, status.body);
  status.time = state.time;
  status.newton_iterations = iterations;
  status.rejected = rejected;
  return status;
}

}  // namespace topple
