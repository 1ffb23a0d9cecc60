#include "solver/step/statics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/body/anchors.h"
#include "solver/contact/contact_law.h"
#include "solver/frame/hinges.h"
#include "solver/frame/settle.h"
#include "solver/frame/start_vector.h"
#include "solver/math/rotation.h"

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
constexpr double k_least_damping = 1e-6, k_damped_more = 10;  // of add_levenberg, 1 at most
constexpr double k_further = 4;  // of the first correction: no later one of a frame that yields goes further
constexpr double k_no_reach = std::numeric_limits<double>::infinity();

// Of a tangent that has no potential nothing is told.
bool is_conservative(const BodySystem& s) {
  return std::all_of(s.loads.begin(), s.loads.end(),
                     [](const auto& own) { return own.load->moment.isZero(0); });
}

// Weight of two elements of a member, held at its ends: half of it on each with the moments +-W L/12. The mid
// node's 2/3 stand for the whole, and L is taken on either side of it, so that every derivative has a place.
void distribute_weight(BodySystem& s, const Vec3& gravity, const std::vector<Vec3>& x) {
  const Body& body = s.model.bodies[s.index];
  for (int m = body.first_member; m < body.first_member + body.member_count; ++m) {
    const Member& member = s.model.members[m];
    for (int e = member.first_element; e + 1 < member.first_element + member.element_count; e += 2) {
      const int a = s.model.elements[e].node[0] - s.first, mid = s.model.elements[e].node[1] - s.first,
                b = s.model.elements[e + 1].node[1] - s.first;
      const Vec3 weight = s.model.node_mass[s.first + mid] * gravity;
      s.force[mid] -= weight;
      const auto hold = [&](int end) {
        s.force[end] += weight / 2;
        s.moment[end] += (x[mid] - x[end]).cross(weight) / 4;
        Mat6 block = Mat6::Zero();
        block.bottomLeftCorner<3, 3>() = skew(weight) / 4;
        s.lu.add(end, mid, block);
        s.lu.add(end, end, Mat6(-block));
      };
      hold(a);
      hold(b);
    }
  }
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
}

/// Of the order of what holds a node of the body, N/m.
double control_spring(const BodySystem& s) {
  const Element& element = s.model.elements[s.model.bodies[s.index].first_element];
  return element.normal_stiffness[0] / element.length;
}

// `along` times the increments of the unknowns, six numbers per node, is to come to `travel`. A spring on the
// greatest entry of `along` keeps a mechanism from being singular. What it would hold is put on as a load: so
// it does nothing to the solution.
class ControlledWay {
 public:
  ControlledWay(const BodySystem& s, std::vector<double> along, double travel)
      : along_(std::move(along)), left_(travel), spring_(control_spring(s)) {
    for (std::size_t i = 0; i < along_.size(); ++i)
      if (std::abs(along_[i]) > std::abs(along_[held_])) held_ = i;
  }

  void add_spring(BodySystem& s) const {
    const int node = static_cast<int>(held_ / 6), k = static_cast<int>(held_ % 6);
    Mat6 block = Mat6::Zero();
    block(k, k) = spring_;
    s.lu.add(node, node, block);
  }
  // `x`, the correction under constant loads, becomes that which goes what is left; `growth`: growing_loads.
  // Returns the change of the load factor.
  double go(BodySystem& s, const std::vector<double>& growth, std::vector<double>& x) {
    by_factor_ = growth;
    by_spring_.assign(x.size(), 0.);
    by_spring_[held_] = spring_;
    s.lu.solve(by_factor_.data());
    s.lu.solve(by_spring_.data());
    // of change and the spring's shift:  shift = x + change by_factor + shift by_spring  where it is held,
    //                                    left = along . (x + change by_factor + shift by_spring)
    const double way_factor = dot(along_, by_factor_), way_spring = dot(along_, by_spring_),
                 rest = left_ - dot(along_, x);
    const double here = x[held_], by_factor = by_factor_[held_], soft = 1 - by_spring_[held_];
    const double determinant = soft * way_factor + by_factor * way_spring;
    const double change = (soft * rest - way_spring * here) / determinant,
                 shift = (way_factor * here + by_factor * rest) / determinant;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += change * by_factor_[i] + shift * by_spring_[i];
    return change;
  }
  /// `x` was taken.
  void take(const std::vector<double>& x) { left_ -= dot(along_, x); }

 private:
  std::vector<double> along_;
  std::size_t held_ = 0;
  double left_, spring_;
  std::vector<double> by_factor_, by_spring_;
};

// Completes `out` by the mode of the tangent last factored, K, that is its softest or, with negative pivots,
// the softest of those in which it runs away: inverse iteration, beside those found before. K is symmetric.
void look_at_mode(BodySystem& s, const std::vector<double>& growth, Stability& out) {
  constexpr int k_rounds = 50, k_most_modes = 8;
  constexpr double k_beside = 1e-3;  // of the loads' work: less is none
  using Unknowns = Eigen::VectorXd;
  std::vector<Unknowns> found;
  const auto n = static_cast<Eigen::Index>(growth.size());
  for (int m = 0; m < k_most_modes; ++m) {
    Unknowns mode(n);
    double softness = 0;
    for (Eigen::Index i = 0; i < n; ++i) mode[i] = start_entry(static_cast<int>(i));
    for (int round = 0; round < k_rounds; ++round) {
      for (int i = 0; i < s.count; ++i) {
        Eigen::Map<Vec3> shift(&mode[6 * i]), spin(&mode[6 * i + 3]);
        s.clear_fixed(i, shift, spin);
      }
      for (const Unknowns& other : found) mode -= other.dot(mode) * other;
      mode.normalize();
      const Unknowns before = mode;
      s.lu.solve(mode.data());
      softness = before.dot(mode);
    }
    found.push_back(mode.normalized());
    if (softness < 0 || out.negative_pivots <= 0) break;
  }
  const Unknowns& mode = found.back();
  double greatest = 0;
  for (int i = 0; i < s.count; ++i)
    if (const Vec3 shift = mode.segment<3>(6 * i); shift.norm() > greatest) {
      greatest = shift.norm();
      out.node = s.first + i;
      out.direction = shift / greatest;
    }
  const Eigen::Map<const Unknowns> loads(growth.data(), n);
  double share = 0;
  for (int i = 0; i < s.count; ++i) share += mode.segment<3>(6 * i).dot(loads.segment<3>(6 * i));
  const bool hinged =
      std::ranges::any_of(s.elements, [](const ElementState& e) { return e.hinge != Hinge::none; });
  out.loss = hinged                                                 ? Stability::Loss::mechanism
             : std::abs(share) > k_beside * loads.norm() * greatest ? Stability::Loss::limit_point
                                                                    : Stability::Loss::buckling;
}

// Six numbers per node, of the last evaluation.
void unbalance(const BodySystem& s, std::vector<double>& forces) {
  for (int i = 0; i < s.count; ++i)
    for (int k = 0; k < 6; ++k) forces[6 * i + k] = k < 3 ? s.force[i][k] : s.moment[i][k - 3];
}

// The greatest of a correction, m, its node, and whether the trial is another equilibrium's.
struct Correction {
  double greatest = 0;
  int node = 0;
  bool too_far = false;
};

double greatest_of(const BodySystem& s, const std::vector<double>& x) {
  double greatest = 0;
  for (int i = 0; i < s.count; ++i)
    greatest = std::max({greatest, Vec3(&x[6 * i]).norm(), s.size * Vec3(&x[6 * i + 3]).norm()});
  return greatest;
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
                             const std::vector<double>& x, double work) {
  BodyMotion& trial = trial_[s.index];
  const BodyMotion from = trial;
  std::vector<double> way(x.size()), forces(x.size());
  std::vector<Vec3> turn(s.count);
  const auto work_at = [&](double part) {
    for (std::size_t i = 0; i < x.size(); ++i) way[i] = part * x[i];
    correct(s, from, way, trial, turn);
    evaluate(s, still, state, factor);
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
  const std::vector<double> growth = growing_loads(s);
  std::vector<double> x(6 * s.count);
  s.load_memory(state, start);
  std::vector<Vec3> turn(s.count, Vec3::Zero());
  double last = 0, damping = 0, reach = k_no_reach;
  const auto blame = [&](int node) {
    status.node = s.first + node;
    status.element = s.element_at(status.node);
    status.load_factor = factor;
    return status;
  };
  for (int iteration = 1; iteration <= k_most_iterations; ++iteration) {
    status.newton_iterations = iteration;
    if (iteration > 1) hold_joints(s, start, trial);
    damping = damping > k_least_damping ? damping / k_damped_more : 0;
    std::vector<double> forces(x.size());
    double change = 0;
    while (true) {
      evaluate(s, still, state, factor);
      if (way) way->add_spring(s);
      add_levenberg(s, damping);
      const int singular = s.lu.factor();
      unbalance(s, x);
      forces = x;
      if (singular < 0) {
        s.lu.solve(x.data());
        change = way ? way->go(s, growth, x) : 0;
        if (!s.yields || greatest_of(s, x) <= reach) break;
      } else if (!s.yields) {
        return blame(singular);
      }
      if (damping >= 1) return blame(singular >= 0 ? singular : status.node);
      damping = damping > 0 ? k_damped_more * damping : k_least_damping;
    }
    if (reach == k_no_reach) reach = k_further * greatest_of(s, x);
    for (std::size_t i = 0; i < x.size(); ++i) forces[i] += change * growth[i];
    const double part =
        iteration > 1 && s.yields ? search_line(s, still, state, factor + change, x, dot(forces, x)) : 1;
    factor += part * change;
    for (double& value : x) value *= part;
    if (way) way->take(x);
    const auto [greatest, node, too_far] = correct(s, start, x, trial, turn);
    if (too_far || !std::isfinite(greatest + factor)) return blame(node);
    const double rate = iteration > 1 ? greatest / last : 1;
    const double tolerance = k_convergence * s.size;
    if (part < 1 || damping > 0) {
      last = 0;
    } else if (greatest < tolerance || (iteration > 1 && last < k_quadratic * s.size) ||
               (rate < 0.5 && greatest * rate / (1 - rate) < tolerance)) {
      if (release_joints(s, trial) || break_sections(s, trial)) {
        iteration = 0;
        last = 0;
        continue;
      }
      evaluate(s, still, state, factor);
      status.stability = look_at_stability(s, growth);
      if (settings_.stop_at_instability && !status.stability.stable()) return blame(node);
      status.kind = StepStatus::Kind::ok;
      return status;
    }
    if (part == 1 && damping == 0) last = greatest;
    status.node = node;
  }
  return blame(status.node);
}

// Of the tangent last evaluated.
Stability LoadPath::look_at_stability(BodySystem& s, const std::vector<double>& growth) {
  Stability out;
  if (!is_conservative(s)) return out;
  const int singular = s.lu.factor(true);
  out.negative_pivots = s.lu.negative();
  if (singular >= 0) {
    ++out.negative_pivots;
    out.loss = Stability::Loss::mechanism;
    out.node = s.first + singular;
  } else if (out.negative_pivots > 0) {
    look_at_mode(s, growth, out);
  }
  return out;
}

// By the softest mode of a body's last equilibrium, when there is none beyond it.
Stability LoadPath::what_is_lost(const Parameters& parameters, const State& state, int body) {
  BodySystem& s = *systems_[body];
  s.load(state, start_[body]);
  s.load_memory(state, start_[body]);
  trial_[body] = start_[body];
  evaluate(s, at_rest(parameters), state, state.load_factor);
  const std::vector<double> growth = growing_loads(s);
  Stability out = look_at_stability(s, growth);
  if (out.negative_pivots == 0) look_at_mode(s, growth, out);
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
  while (done < 1) {
    const Target target = settings_.control ? Target{state.load_factor, part * state.step_size}
                                            : Target{(before + done + part) / steps};
    status = balance(parameters, state, target);
    iterations += status.newton_iterations;
    if (status.ok()) {
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
  if (status.kind == StepStatus::Kind::no_equilibrium && status.stability.loss == Stability::Loss::none)
    status.stability = what_is_lost(parameters, state, status.body);
  status.time = state.time;
  status.newton_iterations = iterations;
  status.rejected = rejected;
  return status;
}

}  // namespace topple
