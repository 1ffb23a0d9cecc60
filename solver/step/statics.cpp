#include "solver/step/statics.h"

#include <algorithm>
#include <cmath>

#include "solver/body/anchors.h"
#include "solver/contact/contact_law.h"
#include "solver/frame/hinges.h"
#include "solver/frame/settle.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr int k_most_iterations = 40;
constexpr double k_convergence = 1e-11;  // of the body's size, error left
constexpr double k_quadratic = 1e-8;     // of the body's size: the correction after one this small is noise
constexpr double k_furthest = 1;         // of the body's size, travel within a load step
constexpr double k_most_turn = 1.5;      // rad, within a load step: more is another equilibrium
constexpr double k_least_part = 1. / 1024;  // of a load step

// Forces that keep their direction have a potential, moments about fixed axes have none: only with the former
// does the tangent tell whether an equilibrium is stable.
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

/// Of the order of what holds a node of the body, N/m.
double control_spring(const BodySystem& s) {
  const Element& element = s.model.elements[s.model.bodies[s.index].first_element];
  return element.normal_stiffness[0] / element.length;
}

// The way of a controlled direction, 6 times its node and which of six. A spring keeps a mechanism from being
// singular. What it would hold is put on as a load: so it does nothing to the solution, which moves the
// direction by what is left of the way.
class ControlledWay {
 public:
  ControlledWay(const BodySystem& s, int direction, double travel)
      : direction_(direction), travel_(travel), spring_(control_spring(s)) {}

  void add_spring(BodySystem& s) const {
    Mat6 block = Mat6::Zero();
    block(direction_ % 6, direction_ % 6) = spring_;
    s.lu.add(direction_ / 6, direction_ / 6, block);
  }
  // `x`, the correction under constant loads, becomes that which goes what is left; `growth`: growing_loads.
  // Returns the change of the load factor.
  double go(BodySystem& s, const std::vector<double>& growth, std::vector<double>& x) {
    by_factor_ = growth;
    by_spring_.assign(x.size(), 0.);
    by_spring_[direction_] = spring_ * left();
    s.lu.solve(by_factor_.data());
    s.lu.solve(by_spring_.data());
    const double change = (left() - x[direction_] - by_spring_[direction_]) / by_factor_[direction_];
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += change * by_factor_[i] + by_spring_[i];
    moved_ += x[direction_];
    return change;
  }

 private:
  double left() const { return travel_ - moved_; }

  int direction_;
  double travel_, moved_ = 0, spring_;
  std::vector<double> by_factor_, by_spring_;
};

// The greatest of a correction, m, its node, and whether the trial is another equilibrium's.
struct Correction {
  double greatest = 0;
  int node = 0;
  bool too_far = false;
};

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

// Of six per node of that body.
int LoadPath::controlled_direction() const {
  return 6 * (settings_.control->node - systems_[controlled_body()]->first) + settings_.control->direction;
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

StepStatus LoadPath::balance_body(BodySystem& s, const Parameters& still, const State& state,
                                  std::optional<double> travel, double& factor) {
  BodyMotion &start = start_[s.index], &trial = trial_[s.index];
  s.load(state, start);
  trial = start;
  StepStatus status;
  status.kind = StepStatus::Kind::no_equilibrium;
  status.body = s.index;
  std::optional<ControlledWay> way;
  if (travel) way.emplace(s, controlled_direction(), *travel);
  const std::vector<double> growth = growing_loads(s);
  std::vector<double> x(6 * s.count);
  s.load_memory(state, start);
  std::vector<Vec3> turn(s.count, Vec3::Zero());
  double last = 0;
  const auto blame = [&](int node) {
    status.node = s.first + node;
    status.element = s.element_at(status.node);
    status.load_factor = factor;
    return status;
  };
  for (int iteration = 1; iteration <= k_most_iterations; ++iteration) {
    status.newton_iterations = iteration;
    evaluate(s, still, state, factor);
    if (way) way->add_spring(s);
    if (const int singular = s.lu.factor(); singular >= 0) return blame(singular);
    for (int i = 0; i < s.count; ++i)
      for (int k = 0; k < 6; ++k) x[6 * i + k] = k < 3 ? s.force[i][k] : s.moment[i][k - 3];
    s.lu.solve(x.data());
    if (way) factor += way->go(s, growth, x);
    const auto [greatest, node, too_far] = correct(s, start, x, trial, turn);
    if (too_far || !std::isfinite(greatest + factor)) return blame(node);
    const double rate = iteration > 1 ? greatest / last : 1;
    const double tolerance = k_convergence * s.size;
    if (greatest < tolerance || (iteration > 1 && last < k_quadratic * s.size) ||
        (rate < 0.5 && greatest * rate / (1 - rate) < tolerance)) {
      if (break_sections(s, trial)) {
        iteration = 0;
        last = 0;
        continue;
      }
      evaluate(s, still, state, factor);
      // directions in which it would run away: Newton stepped over a limit or a branching
      if (!travel && is_conservative(s) && (s.lu.factor(true) >= 0 || s.lu.negative() > 0))
        return blame(node);
      status.kind = StepStatus::Kind::ok;
      return status;
    }
    last = greatest;
    status.node = node;
  }
  return blame(status.node);
}

StepStatus LoadPath::balance(const Parameters& parameters, State& state, Target target) {
  StepStatus status = look_at_numbers(*model_, parameters, state, true);
  if (!status.ok()) return status;
  const Parameters still = at_rest(parameters);
  double factor = target.factor;
  int iterations = 0;
  const int first = controlled_body();
  const auto solve = [&](BodySystem& system) {
    status = balance_body(system, still, state, system.index == first ? target.travel : std::nullopt, factor);
    status.newton_iterations = iterations += status.newton_iterations;
    return status.ok();
  };
  if (first >= 0 && !solve(*systems_[first])) return status;
  for (auto& system : systems_)
    if (system->index != first && !solve(*system)) return status;
  accept(still, factor, state);
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

// How far a load step's share of the loads moves the controlled direction from here.
std::optional<double> LoadPath::first_travel(const Parameters& parameters, const State& state) {
  BodySystem& s = *systems_[controlled_body()];
  s.load(state, start_[s.index]);
  trial_[s.index] = start_[s.index];
  evaluate(s, at_rest(parameters), state, 0);
  if (s.lu.factor() >= 0) return std::nullopt;
  std::vector<double> by_factor = growing_loads(s);
  s.lu.solve(by_factor.data());
  const double travel = by_factor[controlled_direction()] / settings_.load_steps;
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
  const std::optional<double> travel =
      settings_.control->to ? *settings_.control->to / settings_.load_steps : first_travel(parameters, state);
  if (travel) {
    state.step_size = *travel;
  } else {
    status.kind = StepStatus::Kind::uncontrolled;
    status.body = controlled_body();
    status.node = settings_.control->node;
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
  status.time = state.time;
  status.newton_iterations = iterations;
  status.rejected = rejected;
  return status;
}

}  // namespace topple
