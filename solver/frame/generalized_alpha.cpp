#include "solver/frame/generalized_alpha.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "solver/frame/hinges.h"
#include "solver/frame/work.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr int k_most_iterations = 25;
// Newton stops when the error left is below this part of the body's size: a hundred times rounding.
constexpr double k_convergence = 1e-11;
// A factorisation is used again while each correction is below this part of the one before.
constexpr double k_good_rate = 0.1;
// When corrections shrink no faster than this from some iteration on, those that follow go only as far as the
// residual leads.
constexpr int k_patience = 6;
constexpr double k_cycling_rate = 0.7;
constexpr double k_turned = 0.5;  // residual along the correction, over that before: may turn so far
constexpr int k_most_looks = 40;
constexpr double k_unguided = 0.5;  // share of a correction that the residual does not point along
// A predicted pose that takes more than this many times the body's kinetic energy to get to is no start for
// Newton.
constexpr double k_reach = 2;

enum class Outcome { converged, diverged, not_finite, singular, too_far };

struct Attempt {
  Outcome outcome;
  int iterations;
  int node;  // where the last correction was greatest, of the model
};

// Nodes that are integrated alike, one after the other.
struct Alike {
  int first, count;
  const GeneralizedAlpha& c;

  // Theirs as one array.
  Eigen::Map<Eigen::ArrayXd> numbers(std::vector<Vec3>& vectors) const {
    return {vectors[first].data(), 3 * count};
  }
};

class ImplicitStep {
 public:
  ImplicitStep(BodySystem& system, const StepSpan& span, const GeneralizedAlpha& coefficients, State& state,
               IntegratorScratch& scratch)
      : s_(system),
        span_(span),
        h_(span.h),
        c_(coefficients),
        of_rigid_(coefficients.of_rigid()),
        nodes_{0, system.count - static_cast<int>(system.rigid.size()), c_},
        state_(state),
        w_(scratch) {}

  Attempt solve();
  /// Solves again until no section breaks.
  Attempt solve_with_fracture();
  void accept(StepEnergy& energy);

 private:
  // f of the nodes that are integrated alike.
  template <class F>
  void each_alike(F f) const {
    f(nodes_);
    if (!s_.rigid.empty()) f(Alike{nodes_.count, static_cast<int>(s_.rigid.size()), of_rigid_});
  }
  const GeneralizedAlpha& coefficients(const NodePack& pack) const { return pack.rigid ? of_rigid_ : c_; }
  void take_accelerations();
  void predict();
  void evaluate();
  bool beyond_reach() const;
  void start_from_pose();
  void update_trial();
  void form_tangent();
  double correct(int& node);
  double share_of_correction();
  void add_inertia_tangent();
  PackVector<Four> momentum_rate(const NodePack& pack, const PackVector<Four>& omega) const;
  void fill_residual();

  BodySystem& s_;
  const StepSpan& span_;
  const double h_;
  const GeneralizedAlpha &c_, of_rigid_;
  const Alike nodes_;
  State& state_;
  IntegratorScratch& w_;
  bool predicted_ = false;
  bool every_tangent_ = false;
};

void ImplicitStep::take_accelerations() {
  s_.take(state_.acceleration, w_.balance0);
  s_.take(state_.angular_acceleration, w_.angular_balance0);
  s_.take(state_.algorithmic_acceleration, w_.algorithmic0);
  s_.take(state_.algorithmic_angular_acceleration, w_.algorithmic_angular0);
  for (const auto& [body, own, first, count] : s_.rigid) {
    const BodyState& s = state_.bodies[body];
    const Mat3& inertia = s_.node_inertia[own];
    const Vec3 rate =
        s.rotation.conjugate() * s.moment - s.angular_velocity.cross(inertia * s.angular_velocity);
    w_.balance0[own] = w_.algorithmic0[own] = s.force / s_.node_mass[own];
    w_.angular_balance0[own] = w_.algorithmic_angular0[own] = inertia.inverse() * rate;
  }
}

void ImplicitStep::predict() {
  const int n = s_.count;
  s_.load(state_, w_.start);
  s_.load_memory(state_, w_.start);
  w_.trial.resize(n);
  for (auto* array : {&w_.travel, &w_.turn, &w_.acceleration, &w_.angular_acceleration, &w_.algorithmic,
                      &w_.algorithmic_angular, &w_.balance0, &w_.angular_balance0, &w_.algorithmic0,
                      &w_.algorithmic_angular0, &w_.coasting, &w_.coasting_turn})
    array->resize(n);
  w_.right_hand_side.resize(6 * n);
  for (auto* array : {&w_.kept_residual, &w_.way}) array->reserve(6 * n);
  for (auto* array : {&w_.kept_travel, &w_.kept_turn}) array->reserve(n);
  take_accelerations();
  const auto begin = [&](std::vector<Vec3>& v0, std::vector<Vec3>& a0, std::vector<Vec3>& step,
                         std::vector<Vec3>& coasting) {
    each_alike([&](const Alike& of) {
      of.numbers(step) = h_ * (of.numbers(v0) + h_ / 2 * of.numbers(a0));
      of.numbers(coasting) = h_ * (of.numbers(v0) + h_ * (0.5 - of.c.beta) * of.numbers(a0));
    });
  };
  begin(w_.start.velocity, w_.algorithmic0, w_.travel, w_.coasting);
  begin(w_.start.angular_velocity, w_.algorithmic_angular0, w_.turn, w_.coasting_turn);
  for (int i = 0; i < n; ++i) {
    if (s_.fixed[i] == 0) continue;
    Vec3 spin = w_.start.rotation[i] * w_.turn[i];
    s_.clear_fixed(i, w_.travel[i], spin);
    w_.turn[i] = w_.start.rotation[i].conjugate() * spin;
  }
  predicted_ = true;
}

// Forces at the end of the step.
void ImplicitStep::evaluate() {
  s_.evaluate(span_.parameters, span_.end, w_.trial, state_.stick, w_.start.position);
}

// Where the step is long for stiff members, velocities and accelerations ring about the motion, and what
// they predict strains the members far beyond what the body can do. Compressed members make the tangent
// indefinite there: Newton goes astray, or finds them folded. The forces of the predicted pose over the way
// to it bound the rise of a convex potential.
bool ImplicitStep::beyond_reach() const {
  Four rise(0);
  for (const NodePack& pack : s_.node_packs) {
    const PackVector<Four> spin =
        rotate(gather(w_.start.rotation.data(), pack.node), gather(w_.turn.data(), pack.node));
    rise = rise - pack.real * (dot(gather(s_.force.data(), pack.node), gather(w_.travel.data(), pack.node)) +
                               dot(gather(s_.moment.data(), pack.node), spin));
  }
  return sum(rise) > k_reach * s_.kinetic_energy(w_.start);
}

// The tangent of the pose in which the step starts leads along what is stiff there.
void ImplicitStep::start_from_pose() {
  std::fill(w_.travel.begin(), w_.travel.end(), Vec3::Zero());
  std::fill(w_.turn.begin(), w_.turn.end(), Vec3::Zero());
  every_tangent_ = true;
}

void ImplicitStep::update_trial() {
  const auto advance = [&](std::vector<Vec3>& step, std::vector<Vec3>& coasting, std::vector<Vec3>& v0,
                           std::vector<Vec3>& a0, std::vector<Vec3>& balance0, std::vector<Vec3>& v1,
                           std::vector<Vec3>& a1, std::vector<Vec3>& balance1) {
    each_alike([&](const Alike& of) {
      const auto& [am, af, gamma, beta] = of.c;
      const auto numbers = [&](std::vector<Vec3>& vectors) { return of.numbers(vectors); };
      numbers(a1) = (numbers(step) - numbers(coasting)) / (beta * h_ * h_);
      numbers(v1) = numbers(v0) + h_ * ((1 - gamma) * numbers(a0) + gamma * numbers(a1));
      numbers(balance1) = ((1 - am) * numbers(a1) + am * numbers(a0) - af * numbers(balance0)) / (1 - af);
    });
  };
  advance(w_.travel, w_.coasting, w_.start.velocity, w_.algorithmic0, w_.balance0, w_.trial.velocity,
          w_.algorithmic, w_.acceleration);
  advance(w_.turn, w_.coasting_turn, w_.start.angular_velocity, w_.algorithmic_angular0, w_.angular_balance0,
          w_.trial.angular_velocity, w_.algorithmic_angular, w_.angular_acceleration);
  each_alike([&](const Alike& of) {
    of.numbers(w_.trial.position) = of.numbers(w_.start.position) + of.numbers(w_.travel);
  });
  for (const NodePack& pack : s_.node_packs)
    scatter(normalized(gather(w_.start.rotation.data(), pack.node) *
                       exponential(gather(w_.turn.data(), pack.node))),
            w_.trial.rotation.data(), pack.node);
  s_.place_carried(w_.trial);
}

// Rate of the angular momentum in material axes.
PackVector<Four> ImplicitStep::momentum_rate(const NodePack& pack, const PackVector<Four>& omega) const {
  return pack.inertia * gather(w_.angular_acceleration.data(), pack.node) +
         cross(omega, pack.inertia * omega);
}

void ImplicitStep::add_inertia_tangent() {
  const PackMatrix<Four> zero = diagonal(PackVector<Four>{0, 0, 0});
  for (const NodePack& pack : s_.node_packs) {
    const auto& [alpha_m, alpha_f, gamma, beta] = coefficients(pack);
    const double ca = (1 - alpha_m) / ((1 - alpha_f) * beta * h_ * h_), cv = gamma / (beta * h_);
    const PackVector<Four> omega = gather(w_.trial.angular_velocity.data(), pack.node);
    const PackVector<Four> turn = gather(w_.turn.data(), pack.node);
    const PackMatrix<Four> r0 = rotation_matrix(gather(w_.start.rotation.data(), pack.node)),
                           r1 = rotation_matrix(gather(w_.trial.rotation.data(), pack.node));
    const PackVector<Four> rate = r1 * momentum_rate(pack, omega);
    const PackMatrix<Four> by_turn =
        Four(ca) * pack.inertia + Four(cv) * (skew_times(omega, pack.inertia) - skew(pack.inertia * omega));
    const Four mass = Four(ca) * pack.mass;
    s_.lu.add(pack.diagonal, diagonal(PackVector<Four>{mass, mass, mass}), zero, zero,
              r1 * (by_turn * (inverse_left_jacobian(turn) * transposed(r0))) - skew(rate));
  }
}

void ImplicitStep::fill_residual() {
  for (const NodePack& pack : s_.node_packs) {
    const PackVector<Four> omega = gather(w_.trial.angular_velocity.data(), pack.node);
    const PackVector<Four> force =
        gather(s_.force.data(), pack.node) - pack.mass * gather(w_.acceleration.data(), pack.node);
    const PackVector<Four> moment =
        gather(s_.moment.data(), pack.node) -
        rotate(gather(w_.trial.rotation.data(), pack.node), momentum_rate(pack, omega));
    const std::array<Four, 4> forces = lanes(force), moments = lanes(moment);
    for (int k = 0; k < 4 && pack.real[k] > 0; ++k) {
      store_three(&w_.right_hand_side[6 * pack.node[k]], forces[k]);
      store_three(&w_.right_hand_side[6 * pack.node[k] + 3], moments[k]);
    }
  }
  for (int i = 0; i < s_.count; ++i)
    for (int k = 0; s_.fixed[i] != 0 && k < 6; ++k)
      if (s_.is_fixed(i, k)) w_.right_hand_side[6 * i + k] = 0;
}

// Applies the solution; returns its greatest length, rotations times the body's size.
double ImplicitStep::correct(int& node) {
  double greatest = 0;                // squared
  for (int i = 0; i < s_.count; ++i)  // no stiffness brings back what rounding moves a support
    s_.clear_fixed(i, Eigen::Map<Vec3>(&w_.right_hand_side[6 * i]),
                   Eigen::Map<Vec3>(&w_.right_hand_side[6 * i + 3]));
  const Four size2(s_.size * s_.size);
  for (const NodePack& pack : s_.node_packs) {
    const auto part = [&](int which) {
      std::array<int, 4> at;
      for (int k = 0; k < 4; ++k) at[k] = 2 * pack.node[k] + which;
      return gather(reinterpret_cast<const Vec3*>(w_.right_hand_side.data()), at);
    };
    const PackVector<Four> shift = part(0), spin = part(1);
    const PackVector<Four> turn = gather(w_.turn.data(), pack.node);
    const PackQuaternion<Four> back = conjugate(gather(w_.start.rotation.data(), pack.node));
    scatter(gather(w_.travel.data(), pack.node) + shift, w_.travel.data(), pack.node);
    scatter(turn + inverse_left_jacobian(turn) * rotate(back, spin), w_.turn.data(), pack.node);
    const Four shift2 = dot(shift, shift), spin2 = size2 * dot(spin, spin);
    for (int k = 0; k < 4; ++k) {
      const double length = shift2[k] > spin2[k] ? shift2[k] : spin2[k];
      if (length <= greatest || std::isnan(greatest)) continue;
      greatest = length;
      node = s_.node[pack.node[k]];
    }
  }
  return std::sqrt(greatest);
}

// Newton jumps to and fro over a contact that opens or closes within the step: the normal damping, a steep
// step in the speed of a light node between two plains, points from either plain beyond the other. Along a
// correction the residual falls steadily; where it turns lies the place to go on from (Matthies & Strang
// 1979). Takes the residual in `kept_residual`, the correction in `right_hand_side`, and leaves both.
double ImplicitStep::share_of_correction() {
  const auto along = [this](const std::vector<double>& residual) {
    return std::inner_product(residual.begin(), residual.end(), w_.way.begin(), 0.);
  };
  w_.way = w_.right_hand_side;
  w_.kept_travel = w_.travel;
  w_.kept_turn = w_.turn;
  const double first = along(w_.kept_residual);
  if (!(first > 0)) return k_unguided;
  double low = 0, high = 1, share = 1;
  for (int look = 0; look < k_most_looks; ++look) {
    for (std::size_t k = 0; k < w_.way.size(); ++k) w_.right_hand_side[k] = share * w_.way[k];
    int node = 0;
    correct(node);
    update_trial();
    evaluate();
    fill_residual();
    const double left = along(w_.right_hand_side);
    w_.travel = w_.kept_travel;
    w_.turn = w_.kept_turn;
    if (std::abs(left) <= k_turned * first || (share == 1 && left > 0)) break;
    (left > 0 ? low : high) = share;
    share = (low + high) / 2;
  }
  w_.right_hand_side = w_.way;
  return share;
}

Attempt ImplicitStep::solve_with_fracture() {
  predict();
  Attempt attempt = solve();
  while (attempt.outcome == Outcome::converged && break_sections(s_, w_.trial)) {
    const int before = attempt.iterations;
    attempt = solve();
    attempt.iterations += before;
  }
  if (attempt.outcome != Outcome::converged || s_.candidate_pairs.empty()) return attempt;
  const int passed =
      passed_unseen(s_.contacts.members, s_.member_pairs(), w_.start.position, w_.trial.position);
  if (passed >= 0) {
    attempt.outcome = Outcome::too_far;
    attempt.node = s_.node[s_.member_pairs()[passed].node[0]];
  }
  return attempt;
}

void ImplicitStep::form_tangent() {
  const InPhase phase(w_.profile, Phase::tangent);
  s_.lu.set_zero();
  s_.evaluate_with_tangent(span_.parameters, span_.end, w_.trial, state_.stick, w_.start.position,
                           c_.gamma / (c_.beta * h_));
  add_inertia_tangent();
  for (int i = 0; i < s_.count; ++i)
    for (int k = 0; k < 6; ++k)
      if (s_.is_fixed(i, k)) s_.lu.fix(i, k);
}

Attempt ImplicitStep::solve() {
  const double tolerance = k_convergence * s_.size;
  double last = 0;
  bool fresh = true, cycling = false;
  int node = s_.node.front();
  for (int iteration = 1; iteration <= k_most_iterations; ++iteration) {
    update_trial();
    if (fresh) {
      form_tangent();
      if (predicted_ && beyond_reach()) {
        start_from_pose();
        update_trial();
        form_tangent();
      }
      predicted_ = false;
      const int singular = [&] {
        const InPhase phase(w_.profile, Phase::factor);
        return s_.lu.factor();
      }();
      if (singular >= 0) {
        fill_residual();
        const double* const left = &w_.right_hand_side[6 * singular];
        const bool finite = std::all_of(left, left + 6, [](double x) { return std::isfinite(x); });
        return {finite ? Outcome::singular : Outcome::not_finite, iteration, s_.node[singular]};
      }
    } else {
      evaluate();
    }
    fill_residual();
    if (cycling) w_.kept_residual = w_.right_hand_side;
    {
      const InPhase phase(w_.profile, Phase::solve);
      s_.lu.solve(w_.right_hand_side.data());
    }
    const double share = cycling ? share_of_correction() : 1;
    if (share < 1)
      for (double& x : w_.right_hand_side) x *= share;
    const double size = correct(node) / share;
    if (!std::isfinite(size)) return {Outcome::not_finite, iteration, node};
    if (size > 10 * s_.size) return {Outcome::diverged, iteration, node};
    const double rate = iteration > 1 ? size / last : 1;
    if (size < tolerance || (rate < 0.5 && size * rate / (1 - rate) < tolerance)) {
      update_trial();
      return {Outcome::converged, iteration, node};
    }
    cycling = cycling || (iteration >= k_patience && rate > k_cycling_rate);
    fresh = every_tangent_ || (rate > k_good_rate && iteration > 1);
    last = size;
  }
  return {Outcome::diverged, k_most_iterations, node};
}

void ImplicitStep::accept(StepEnergy& energy) {
  const std::span<const Vec3> stick(state_.stick);
  s_.find_contacts(span_.start.law, w_.start, stick, w_.start.position, w_.contacts_start);
  s_.find_contacts(span_.end.law, w_.trial, stick, w_.start.position, s_.contacts);
  book_work(s_, span_, w_.start, w_.trial, w_.contacts_start, s_.contacts, energy);
  energy.plastic += commit_hinges(s_, w_.start, w_.trial, state_);
  // Work of the inertia forces over the travel against the gain of kinetic energy: what the method itself
  // takes out.
  const Four half(0.5);
  Four taken(0);
  for (const NodePack& pack : s_.node_packs) {
    const auto at = [&](const std::vector<Vec3>& array) { return gather(array.data(), pack.node); };
    const PackVector<Four> v0 = at(w_.start.velocity), v1 = at(w_.trial.velocity);
    const PackVector<Four> w0 = at(w_.start.angular_velocity), w1 = at(w_.trial.angular_velocity);
    const PackVector<Four> rate0 = pack.inertia * at(w_.angular_balance0) + cross(w0, pack.inertia * w0);
    taken =
        taken +
        half *
            (pack.mass * (dot(at(w_.balance0) + at(w_.acceleration), at(w_.travel)) - dot(v1 + v0, v1 - v0)) +
             dot(rate0 + momentum_rate(pack, w1), at(w_.turn)) - dot(w1 + w0, pack.inertia * (w1 - w0)));
  }
  energy.numerical += sum(taken);
  s_.store(w_.trial, state_);
  s_.put(w_.acceleration, state_.acceleration);
  s_.put(w_.angular_acceleration, state_.angular_acceleration);
  s_.put(w_.algorithmic, state_.algorithmic_acceleration);
  s_.put(w_.algorithmic_angular, state_.algorithmic_angular_acceleration);
  for (const auto& [body, own, first, count] : s_.rigid) {
    BodyState& s = state_.bodies[body];
    const Mat3& inertia = s_.node_inertia[own];
    s.force = s_.node_mass[own] * w_.acceleration[own];
    s.moment = s.rotation * (inertia * w_.angular_acceleration[own] +
                             s.angular_velocity.cross(inertia * s.angular_velocity));
  }
  s_.store_stick(s_.contacts, state_);
}

}  // namespace

GeneralizedAlpha GeneralizedAlpha::newmark(double beta, double gamma) {
  GeneralizedAlpha c(1);
  c.alpha_m = c.alpha_f = 0;
  c.beta = beta;
  c.gamma = gamma;
  return c;
}

StepStatus advance_generalized_alpha(BodySystem& system, const StepSpan& span, const GeneralizedAlpha& c,
                                     State& state, IntegratorScratch& scratch, StepEnergy& energy) {
  StepStatus status;
  status.time = span.end.time;
  ImplicitStep implicit(system, span, c, state, scratch);
  const Attempt attempt = implicit.solve_with_fracture();
  status.newton_iterations = attempt.iterations;
  if (attempt.outcome == Outcome::converged) {
    implicit.accept(energy);
    return status;
  }
  if (span.halvings == 0) {
    status.kind = attempt.outcome == Outcome::not_finite ? StepStatus::Kind::not_finite
                  : attempt.outcome == Outcome::singular ? StepStatus::Kind::singular
                  : attempt.outcome == Outcome::too_far  ? StepStatus::Kind::passed_through
                                                         : StepStatus::Kind::newton_diverged;
    status.node = attempt.node;
    status.body = system.model.node_body[attempt.node];
    status.element = system.element_at(attempt.node);
    return status;
  }
  int iterations = attempt.iterations, rejected = 1;
  const double half = span.h / 2;
  const StepInputs middle(span.parameters, span.start.time + half), end(span.parameters, middle.time + half);
  for (const auto& [from, to] : {std::pair(&span.start, &middle), std::pair(&middle, &end)}) {
    const StepSpan part{span.parameters, *from, *to, half, span.halvings - 1};
    status = advance_generalized_alpha(system, part, c, state, scratch, energy);
    status.newton_iterations = iterations += status.newton_iterations;
    status.rejected = rejected += status.rejected;
    if (!status.ok()) return status;
  }
  return status;
}

}  // namespace topple
