#include "solver/generalized_alpha.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/hinges.h"
#include "solver/rotation.h"

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

class ImplicitStep {
 public:
  ImplicitStep(BodySystem& system, const Parameters& parameters, State& state, double t, double h,
               IntegratorScratch& scratch)
      : s_(system), p_(parameters), state_(state), t_(t), h_(h), c_(parameters), w_(scratch) {}

  Attempt solve();
  /// Solves again until the hinges agree with the solution.
  Attempt solve_with_hinges();
  void accept(StepEnergy& energy);

 private:
  void predict();
  void hold_supports(int i, Vec3& shift, Vec3& spin) const;
  bool beyond_reach() const;
  void start_from_pose();
  void update_trial();
  void form_tangent();
  double correct(int& node);
  double share_of_correction();
  void add_inertia_tangent();
  void fill_residual();

  BodySystem& s_;
  const Parameters& p_;
  State& state_;
  const double t_, h_;
  const GeneralizedAlpha c_;
  IntegratorScratch& w_;
  bool predicted_ = false;
  bool every_tangent_ = false;
};

void ImplicitStep::predict() {
  const int n = s_.count;
  s_.load(state_, w_.start);
  s_.load_memory(state_);
  w_.trial.resize(n);
  for (auto* array : {&w_.travel, &w_.turn, &w_.acceleration, &w_.angular_acceleration, &w_.algorithmic,
                      &w_.algorithmic_angular})
    array->resize(n);
  w_.right_hand_side.resize(6 * n);
  for (int i = 0; i < n; ++i) {
    const int g = s_.node[i];
    w_.travel[i] = h_ * (state_.velocity[g] + h_ / 2 * state_.algorithmic_acceleration[g]);
    w_.turn[i] = h_ * (state_.angular_velocity[g] + h_ / 2 * state_.algorithmic_angular_acceleration[g]);
    if (s_.fixed[i] == 0) continue;
    Vec3 spin = w_.start.rotation[i] * w_.turn[i];
    hold_supports(i, w_.travel[i], spin);
    w_.turn[i] = w_.start.rotation[i].conjugate() * spin;
  }
  predicted_ = true;
}

// No stiffness brings back what rounding moves a support.
void ImplicitStep::hold_supports(int i, Vec3& shift, Vec3& spin) const {
  for (int k = 0; k < 3; ++k) {
    if (s_.fixed[i] >> k & 1) shift[k] = 0;
    if (s_.fixed[i] >> (3 + k) & 1) spin[k] = 0;
  }
}

// Where the step is long for stiff members, velocities and accelerations ring about the motion, and what
// they predict strains the members far beyond what the body can do. Compressed members make the tangent
// indefinite there: Newton goes astray, or finds them folded. The forces of the predicted pose over the way
// to it bound the rise of a convex potential.
bool ImplicitStep::beyond_reach() const {
  double rise = 0;
  for (int i = 0; i < s_.count; ++i)
    rise -= s_.force[i].dot(w_.travel[i]) + s_.moment[i].dot(w_.start.rotation[i] * w_.turn[i]);
  return rise > k_reach * s_.kinetic_energy(w_.start);
}

// The tangent of the pose in which the step starts leads along what is stiff there.
void ImplicitStep::start_from_pose() {
  std::fill(w_.travel.begin(), w_.travel.end(), Vec3::Zero());
  std::fill(w_.turn.begin(), w_.turn.end(), Vec3::Zero());
  every_tangent_ = true;
}

void ImplicitStep::update_trial() {
  const double beta = c_.beta, gamma = c_.gamma, am = c_.alpha_m, af = c_.alpha_f;
  for (int i = 0; i < s_.count; ++i) {
    const int g = s_.node[i];
    const auto advance = [&](const Vec3& step, const Vec3& v0, const Vec3& a0, const Vec3& balance0, Vec3& v1,
                             Vec3& a1, Vec3& balance1) {
      a1 = (step - h_ * v0 - h_ * h_ * (0.5 - beta) * a0) / (beta * h_ * h_);
      v1 = v0 + h_ * ((1 - gamma) * a0 + gamma * a1);
      balance1 = ((1 - am) * a1 + am * a0 - af * balance0) / (1 - af);
    };
    advance(w_.travel[i], state_.velocity[g], state_.algorithmic_acceleration[g], state_.acceleration[g],
            w_.trial.velocity[i], w_.algorithmic[i], w_.acceleration[i]);
    advance(w_.turn[i], state_.angular_velocity[g], state_.algorithmic_angular_acceleration[g],
            state_.angular_acceleration[g], w_.trial.angular_velocity[i], w_.algorithmic_angular[i],
            w_.angular_acceleration[i]);
    w_.trial.position[i] = w_.start.position[i] + w_.travel[i];
    w_.trial.rotation[i] = w_.start.rotation[i] * exp_quaternion(w_.turn[i]);
    w_.trial.rotation[i].normalize();
  }
}

void ImplicitStep::add_inertia_tangent() {
  const double ca = (1 - c_.alpha_m) / ((1 - c_.alpha_f) * c_.beta * h_ * h_), cv = c_.gamma / (c_.beta * h_);
  for (int i = 0; i < s_.count; ++i) {
    const int g = s_.node[i];
    const Mat3& j = s_.model.node_inertia[g];
    const Vec3& omega = w_.trial.angular_velocity[i];
    const Mat3 r0 = w_.start.rotation[i].toRotationMatrix(), r1 = w_.trial.rotation[i].toRotationMatrix();
    const Vec3 momentum = j * omega;
    const Vec3 rate = r1 * (j * w_.angular_acceleration[i] + omega.cross(momentum));
    const Mat3 by_turn = ca * j + cv * (skew(omega) * j - skew(momentum));
    Mat6 block = Mat6::Zero();
    block.diagonal().head<3>().setConstant(ca * s_.model.node_mass[g]);
    block.bottomRightCorner<3, 3>() =
        r1 * by_turn * inverse_left_jacobian(w_.turn[i]) * r0.transpose() - skew(rate);
    s_.lu.add(i, i, block);
  }
}

void ImplicitStep::fill_residual() {
  for (int i = 0; i < s_.count; ++i) {
    const int g = s_.node[i];
    const Mat3& j = s_.model.node_inertia[g];
    const Vec3& omega = w_.trial.angular_velocity[i];
    const Vec3 force = s_.force[i] - s_.model.node_mass[g] * w_.acceleration[i];
    const Vec3 rate = j * w_.angular_acceleration[i] + omega.cross(j * omega);
    const Vec3 moment = s_.moment[i] - w_.trial.rotation[i] * rate;
    for (int k = 0; k < 3; ++k) {
      w_.right_hand_side[6 * i + k] = s_.fixed[i] >> k & 1 ? 0 : force[k];
      w_.right_hand_side[6 * i + 3 + k] = s_.fixed[i] >> (3 + k) & 1 ? 0 : moment[k];
    }
  }
}

// Applies the solution; returns its greatest length, rotations times the body's size.
double ImplicitStep::correct(int& node) {
  double greatest = 0;
  for (int i = 0; i < s_.count; ++i) {
    Vec3 shift(&w_.right_hand_side[6 * i]), spin(&w_.right_hand_side[6 * i + 3]);
    hold_supports(i, shift, spin);
    w_.travel[i] += shift;
    w_.turn[i] += inverse_left_jacobian(w_.turn[i]) * (w_.start.rotation[i].conjugate() * spin);
    const double length = std::max(shift.norm(), s_.size * spin.norm());
    if (!(length <= greatest)) {
      greatest = length;
      node = s_.node[i];
    }
  }
  return greatest;
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
    s_.evaluate(p_, t_ + h_, w_.trial, state_.stick, w_.start.position);
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

Attempt ImplicitStep::solve_with_hinges() {
  predict();
  Attempt attempt = solve();
  HingeStep hinges;
  while (attempt.outcome == Outcome::converged && update_hinges(s_, w_.trial, hinges)) {
    const int before = attempt.iterations;
    attempt = solve();
    attempt.iterations += before;
  }
  if (attempt.outcome != Outcome::converged || s_.near.empty()) return attempt;
  const int passed =
      passed_unseen(s_.contacts.members, s_.member_pairs(), w_.start.position, w_.trial.position);
  if (passed >= 0) {
    attempt.outcome = Outcome::too_far;
    attempt.node = s_.node[s_.member_pairs()[passed].node[0]];
  }
  return attempt;
}

void ImplicitStep::form_tangent() {
  s_.lu.set_zero();
  s_.evaluate_with_tangent(p_, t_ + h_, w_.trial, state_.stick, w_.start.position, c_.gamma / (c_.beta * h_));
  add_inertia_tangent();
  for (int i = 0; i < s_.count; ++i)
    for (int k = 0; k < 6; ++k)
      if (s_.fixed[i] >> k & 1) s_.lu.fix(i, k);
}

Attempt ImplicitStep::solve() {
  const std::span<const Vec3> stick(state_.stick);
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
      const int singular = s_.lu.factor();
      if (singular >= 0) {
        fill_residual();
        const double* const left = &w_.right_hand_side[6 * singular];
        const bool finite = std::all_of(left, left + 6, [](double x) { return std::isfinite(x); });
        return {finite ? Outcome::singular : Outcome::not_finite, iteration, s_.node[singular]};
      }
    } else {
      s_.evaluate(p_, t_ + h_, w_.trial, stick, w_.start.position);
    }
    fill_residual();
    if (cycling) w_.kept_residual = w_.right_hand_side;
    s_.lu.solve(w_.right_hand_side.data());
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
  s_.find_contacts(contact_law(p_, t_), w_.start, stick, w_.start.position, w_.contacts_start);
  s_.find_contacts(contact_law(p_, t_ + h_), w_.trial, stick, w_.start.position, s_.contacts);
  book_work(s_, p_, t_, h_, w_.start, w_.trial, w_.contacts_start, s_.contacts, energy);
  energy.plastic += commit_hinges(s_, w_.start, w_.trial, state_);
  // Work of the inertia forces over the travel against the gain of kinetic energy: what the method itself
  // takes out.
  for (int i = 0; i < s_.count; ++i) {
    const int g = s_.node[i];
    const Mat3& j = s_.model.node_inertia[g];
    const double m = s_.model.node_mass[g];
    const Vec3 &v0 = w_.start.velocity[i], &v1 = w_.trial.velocity[i];
    const Vec3 &w0 = w_.start.angular_velocity[i], &w1 = w_.trial.angular_velocity[i];
    const Vec3 rate0 = j * state_.angular_acceleration[g] + w0.cross(j * w0);
    const Vec3 rate1 = j * w_.angular_acceleration[i] + w1.cross(j * w1);
    energy.numerical += 0.5 * m * (state_.acceleration[g] + w_.acceleration[i]).dot(w_.travel[i]) -
                        0.5 * m * (v1 + v0).dot(v1 - v0) + 0.5 * (rate0 + rate1).dot(w_.turn[i]) -
                        0.5 * (w1 + w0).dot(j * (w1 - w0));
    state_.position[g] = w_.trial.position[i];
    state_.rotation[g] = w_.trial.rotation[i];
    state_.velocity[g] = v1;
    state_.angular_velocity[g] = w1;
    state_.acceleration[g] = w_.acceleration[i];
    state_.angular_acceleration[g] = w_.angular_acceleration[i];
    state_.algorithmic_acceleration[g] = w_.algorithmic[i];
    state_.algorithmic_angular_acceleration[g] = w_.algorithmic_angular[i];
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

GeneralizedAlpha::GeneralizedAlpha(const Parameters& p)
    : GeneralizedAlpha(p.integrator == Integrator::newmark ? newmark(p.beta, p.gamma)
                                                           : GeneralizedAlpha(p.spectral_radius)) {}

StepStatus advance_generalized_alpha(BodySystem& system, const Parameters& parameters, State& state, double t,
                                     double h, int halvings, IntegratorScratch& scratch, StepEnergy& energy) {
  StepStatus status;
  status.time = t + h;
  ImplicitStep implicit(system, parameters, state, t, h, scratch);
  const Attempt attempt = implicit.solve_with_hinges();
  status.newton_iterations = attempt.iterations;
  if (attempt.outcome == Outcome::converged) {
    implicit.accept(energy);
    return status;
  }
  if (halvings == 0) {
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
  for (int half = 0; half < 2; ++half) {
    status = advance_generalized_alpha(system, parameters, state, t + half * h / 2, h / 2, halvings - 1,
                                       scratch, energy);
    status.newton_iterations = iterations += status.newton_iterations;
    status.rejected = rejected += status.rejected;
    if (!status.ok()) return status;
  }
  return status;
}

}  // namespace topple
