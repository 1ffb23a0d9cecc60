#include "solver/reduced/implicit_substep.h"

#include <cmath>

#include "solver/element/damping.h"
#include "solver/math/rotation.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_gamma = SubstepSpan::k_gamma;
constexpr double k_error_constant = 3 * k_gamma * k_gamma - 2 * k_gamma * k_gamma * k_gamma - 1. / 6;
constexpr double k_substep_error = 0.03;  // of the tolerance times the speed: local error of the velocity
constexpr double k_speed_floor = 0.01;    // of the speed of a fall through the reach

// |a''| times h^2/2, from what acts at the ends of the stages.
template <class T>
T bend(const T& start, const T& first, const T& second) {
  return 1 / (1 - k_gamma) * (second - first) - 1 / k_gamma * (first - start);
}

double norm(const PackVec3& v) {
  return std::sqrt(dot(v, v));
}

}  // namespace

ImplicitSubstep::ImplicitSubstep(ReducedBody& body, const SubstepSpan& span, BodyState& s,
                                 std::span<Vec3> stick, double speed)
    : body_(body),
      span_(span),
      s_(s),
      stick_(stick),
      before_(s),
      modes_(body.modes(s)),
      r0_(rotation_matrix(packed(s.rotation))),
      inverse_inertia_(r0_ * body.inverse_inertia_ * transposed(r0_)),
      allowed_(k_substep_error * span.parameters.tolerance *
               std::max(speed, k_speed_floor * std::sqrt(span.parameters.gravity.norm() * body.reach_))) {
  body.contacts_.begin_substep();
  start_.force = packed(s.force);
  start_.moment = packed(s.moment);
  omega0_ = r0_ * packed(s.angular_velocity);
  gravity_ = packed(span.parameters.gravity);
  field_ = gravity_ - packed(span.middle.floor);
  from_.position = packed(s.position);
  from_.turn = {0, 0, 0};
  from_.momentum = body.mass_ * packed(s.velocity);
  from_.spin = spin0_ = r0_ * (body.inertia_ * packed(s.angular_velocity));
  one_.u.linear = mul_add(span.gamma_dt / body.mass_, start_.force, packed(s.velocity));
  one_.u.angular = omega0_ + span.gamma_dt * (inverse_inertia_ * start_.moment);
  if (modes_ == 0) return;
  damping_ = damping_time(body.model_, span.parameters, body.body_);
  start_.load = s.load;
  from_.amplitude = s.amplitude;
  from_.rate = s.rate;
  guess_rates(s.load);
}

// As they would be if nothing else acted than at the instant before.
void ImplicitSubstep::guess_rates(const Amplitudes& load) {
  for (int k = 0; k < modes_; ++k)
    now_->u.rate[k] =
        (from_.rate[k] + span_.gamma_dt * (load[k] - spring(k) * from_.amplitude[k])) / modal_mass(k);
}

void ImplicitSubstep::reach(bool with_slope) {
  const double gamma_dt = span_.gamma_dt;
  const BodyVelocity& u = now_->u;
  s_.position = unpacked(mul_add(gamma_dt, u.linear, from_.position));
  PackVec3 turn = mul_add(gamma_dt, u.angular, from_.turn);
  const PackVec3 once = cross(turn, u.angular);
  turning_ = u.angular - 0.5 * once + 1. / 12 * cross(turn, once);  // inverse tangent of the exponential
  turn = mul_add(gamma_dt, turning_, from_.turn);
  const PackQuaternion<double> q =
      normalized(packed(exp_quaternion(unpacked(turn))) * packed(before_.rotation));
  s_.rotation.coeffs() << q.v.x, q.v.y, q.v.z, q.w;
  for (int k = 0; k < modes_; ++k) s_.amplitude[k] = from_.amplitude[k] + gamma_dt * u.rate[k];
  r_ = rotation_matrix(q);
  BodyContacts& contacts = body_.contacts_;
  contacts.find(s_, r_, stick_);
  contacts.follow(before_, r0_, s_, r_);
  const PreparedLaw& law = now_ == &one_ ? span_.middle.law : span_.end.law;
  const ContactLoads loads = with_slope ? contacts.evaluate_forces<true>(law, u, gamma_dt)
                                        : contacts.evaluate_forces<false>(law, u, gamma_dt);
  Acting& acting = now_->acting;
  acting.force = loads.force;
  acting.moment = loads.moment;
  acting.damping_power = loads.damping_power;
  acting.friction_power = loads.friction_power;
  if (modes_ > 0) {
    acting.load.setZero();
    contacts.modal_loads(modes_, acting.load);
  }
  BodyAnchors& anchors = body_.anchors_;
  if (!anchors.any()) return;
  anchors.find(s_);
  acting.force = acting.force + packed(anchors.force());
  acting.moment = acting.moment + packed(anchors.moment());
  anchors.modal_loads(s_, modes_, acting.load);
}

void ImplicitSubstep::add(const BodyVelocity& load) {
  Acting& acting = now_->acting;
  acting.force = acting.force + load.linear;
  acting.moment = acting.moment + load.angular;
  for (int k = 0; k < modes_; ++k) acting.load[k] += load.rate[k];
}

BodyVelocity ImplicitSubstep::residual() const {
  const double gamma_dt = span_.gamma_dt;
  const BodyVelocity& u = now_->u;
  const Acting& acting = now_->acting;
  BodyVelocity left;
  left.linear = body_.mass_ * u.linear - from_.momentum - gamma_dt * (acting.force + body_.mass_ * field_);
  left.angular = spin() - from_.spin - gamma_dt * acting.moment;
  for (int k = 0; k < modes_; ++k)
    left.rate[k] = u.rate[k] - from_.rate[k] -
                   gamma_dt * (acting.load[k] - spring(k) * (s_.amplitude[k] + damping_ * u.rate[k]));
  return left;
}

RigidSolver ImplicitSubstep::solver() const {
  ContactSlope slope = body_.contacts_.slope();
  body_.anchors_.add_slope(s_, span_.gamma_dt, slope);
  return {body_.mass_, body_.inertia_at(r_), span_.gamma_dt, slope};
}

RigidSolver ImplicitSubstep::stick_solver() const {
  return {body_.mass_, body_.inertia_at(r_), span_.gamma_dt, body_.contacts_.stick_slope()};
}

void ImplicitSubstep::fill(ModeMatrix& matrix) const {
  const double gamma_dt = span_.gamma_dt;
  ContactSlope slope = body_.contacts_.slope();
  body_.anchors_.add_slope(s_, gamma_dt, slope);
  body_.fill(gamma_dt, body_.inertia_at(r_), slope, modes_, matrix);
  if (modes_ == 0) return;
  for (int k = 0; k < modes_; ++k) matrix[6 + k][6 + k] = modal_mass(k);
  body_.contacts_.add_slope_of_modes(-gamma_dt, modes_, matrix);
  if (!body_.anchors_.any()) return;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(6 + modes_, 6 + modes_);
  body_.anchors_.add_stiffness(s_, modes_, stiffness);
  for (int i = 0; i < 6 + modes_; ++i)
    for (int k = 0; k < 6 + modes_; ++k)
      if (i >= 6 || k >= 6) matrix[i][k] += gamma_dt * gamma_dt * stiffness(i, k);
}

void ImplicitSubstep::fill_with_sticks(ModeMatrix& matrix) const {
  body_.fill(span_.gamma_dt, body_.inertia_at(r_), body_.contacts_.stick_slope(), modes_, matrix);
  for (int k = 0; k < modes_; ++k) matrix[6 + k][6 + k] = modal_mass(k);
  if (modes_ > 0) body_.contacts_.add_stick_slope_of_modes(-span_.gamma_dt, modes_, matrix);
}

double ImplicitSubstep::correct(const BodyVelocity& by) {
  BodyVelocity& u = now_->u;
  u.linear = u.linear - by.linear;
  u.angular = u.angular - by.angular;
  double size = 0;
  for (int k = 0; k < modes_; ++k) {
    u.rate[k] -= by.rate[k];
    size += std::abs(by.rate[k]);
  }
  if (modes_ > 0) size /= std::sqrt(body_.mass_);
  return size + velocity_size(body_.reach_, by.linear, by.angular);
}

double ImplicitSubstep::scale() const {
  return velocity_scale(body_.reach_, now_->u);
}

void ImplicitSubstep::end_stage() {
  Stage& stage = *now_;
  const double gamma_dt = span_.gamma_dt, rest = span_.rest;
  stage.spin = spin();
  stage.acting.force = 1 / gamma_dt * (body_.mass_ * stage.u.linear - from_.momentum);
  stage.acting.moment = 1 / gamma_dt * (stage.spin - from_.spin);
  for (int k = 0; k < modes_; ++k) {
    const double amplitude = from_.amplitude[k] + gamma_dt * stage.u.rate[k];
    stage.acting.load[k] =
        (stage.u.rate[k] - from_.rate[k]) / gamma_dt + spring(k) * (amplitude + damping_ * stage.u.rate[k]);
  }
  if (now_ == &two_) return;
  const Acting& acted = one_.acting;
  from_.position = mul_add(rest, one_.u.linear, from_.position);
  from_.turn = rest * turning_;
  from_.momentum = mul_add(rest, acted.force, from_.momentum);
  from_.spin = mul_add(rest, acted.moment, from_.spin);
  now_ = &two_;
  field_ = gravity_ - packed(span_.end.floor);
  two_.u.linear = 1 / body_.mass_ * mul_add(gamma_dt, acted.force, from_.momentum);
  two_.u.angular = omega0_ + span_.h * (inverse_inertia_ * acted.moment);
  if (modes_ == 0) return;
  for (int k = 0; k < modes_; ++k) {
    from_.rate[k] += rest / gamma_dt * (one_.u.rate[k] - from_.rate[k]);
    from_.amplitude[k] += rest * one_.u.rate[k];
  }
  guess_rates(acted.load);
}

BodyVelocity ImplicitSubstep::error() const {
  BodyVelocity error;
  error.linear = bend(start_.force, one_.acting.force, two_.acting.force);
  error.angular = bend(start_.moment, one_.acting.moment, two_.acting.moment);
  const auto pull = [&](const Acting& acting, double amplitude, double rate, int k) {
    return acting.load[k] - spring(k) * (amplitude + damping_ * rate);
  };
  for (int k = 0; k < modes_; ++k) {
    const double first = before_.amplitude[k] + span_.gamma_dt * one_.u.rate[k],
                 second = from_.amplitude[k] + span_.gamma_dt * two_.u.rate[k];
    error.rate[k] =
        bend(pull(start_, before_.amplitude[k], before_.rate[k], k),
             pull(one_.acting, first, one_.u.rate[k], k), pull(two_.acting, second, two_.u.rate[k], k));
  }
  return error;
}

double ImplicitSubstep::over_allowed(const BodyVelocity& error) const {
  double bent = 0;
  for (int k = 0; k < modes_; ++k) bent += std::abs(error.rate[k]);
  if (modes_ > 0) bent /= std::sqrt(body_.mass_);
  return 2 * k_error_constant * span_.h * (norm(error.linear) + body_.reach_ * norm(error.angular) + bent) /
         allowed_;
}

void ImplicitSubstep::arrive() {
  const Acting acted = two_.acting;
  reach(false);
  two_.acting = acted;
  s_.velocity = unpacked(two_.u.linear);
  s_.angular_velocity = unpacked(transposed_times(r_, two_.u.angular));
  for (int k = 0; k < modes_; ++k) s_.rate[k] = two_.u.rate[k];
}

// What the modes lose by damping and by the method.
void ImplicitSubstep::book_modes(StepEnergy& booked) const {
  for (int k = 0; k < modes_; ++k) {
    const auto mean = [&](double first, double second) {
      return span_.rest * first + span_.gamma_dt * second;
    };
    const double r1 = one_.u.rate[k], r2 = two_.u.rate[k];
    const auto gain = [](double from, double to) { return 0.5 * (to + from) * (to - from); };
    const double damped = damping_ * spring(k) * mean(r1 * r1, r2 * r2);
    booked.damping += damped;
    booked.numerical += mean(one_.acting.load[k] * r1, two_.acting.load[k] * r2) - damped -
                        gain(before_.rate[k], s_.rate[k]) -
                        spring(k) * gain(before_.amplitude[k], s_.amplitude[k]);
  }
}

void ImplicitSubstep::finish(StepEnergy& booked) {
  const double mass = body_.mass_;
  const Parameters& parameters = span_.parameters;
  const PackVec3 floor1 = packed(span_.middle.floor), floor2 = packed(span_.end.floor);
  const Vec3 shift = s_.position - before_.position;
  const auto mean = [&](double first, double second) { return span_.rest * first + span_.gamma_dt * second; };
  const auto work = [&](const PackVec3& f1, const PackVec3& v1, const PackVec3& f2, const PackVec3& v2) {
    return mean(dot(f1, v1), dot(f2, v2));
  };
  BodyContacts& contacts = body_.contacts_;
  booked.gravity -= mass * parameters.gravity.dot(shift);
  booked.input -= mass * work(floor1, one_.u.linear, floor2, two_.u.linear);
  booked.normal_damping += mean(one_.acting.damping_power, two_.acting.damping_power);
  booked.friction +=
      mean(one_.acting.friction_power, two_.acting.friction_power) - contacts.stick_energy_gained();
  booked.numerical += work(one_.acting.force, one_.u.linear, two_.acting.force, two_.u.linear) +
                      work(one_.acting.moment, one_.u.angular, two_.acting.moment, two_.u.angular) -
                      0.5 * mass * (s_.velocity + before_.velocity).dot(s_.velocity - before_.velocity) -
                      0.5 * (dot(two_.spin, two_.u.angular) - dot(spin0_, omega0_));
  book_modes(booked);
  contacts.book_law_change(span_.start.law, span_.end.law, booked);
  contacts.keep_sticks(span_.end.law, stick_);
  // not the stage's: springs that slipped are shorter now, and the next substep compares its forces with
  // these
  const ContactLoads loads = body_.respond_at<ContactSums::loads>(span_.end.law, s_);
  s_.force = unpacked(loads.force + mass * (gravity_ - floor2));
  s_.moment = unpacked(loads.moment);
  if (modes_ > 0) {
    s_.load.setZero();
    contacts.modal_loads(modes_, s_.load);
    body_.anchors_.modal_loads(s_, modes_, s_.load);
  }
  if (body_.anchors_.any()) {
    s_.force += body_.anchors_.force();
    s_.moment += body_.anchors_.moment();
  }
}

void ImplicitSubstep::give_up() {
  s_ = before_;
  body_.contacts_.give_up_substep();
}

// A first guess at a substep that follows a touch.
double ReducedBody::first_substep(const ContactLaw& law) const {
  const double contact =
      std::sqrt(contacts_.share_of_mass() * contacts_.least_length() / (law.alpha * std::max(1., law.q)));
  return k_resolved_bounce *
         (anchors_.any() ? std::min(contact, std::sqrt(mass_ / anchors_.greatest_stiffness())) : contact);
}

double ReducedBody::next_landing(const BodyState& s, double within) const {
  return contacts_.next_landing(s, s.force / mass_, angular_acceleration(s), within);
}

namespace {

// Newton for the velocity of a stage.
bool solve_stage(ImplicitSubstep& substep, const PreparedLaw& law, StageNewton& newton, RigidSolver& solver,
                 RigidSolver& sticks) {
  newton.begin_stage();
  for (int iteration = 0; iteration < k_newton_iterations; ++iteration) {
    substep.reach(newton.fresh);
    BodyVelocity left = substep.residual();
    if (newton.fresh) {
      solver = substep.solver();
      sticks = substep.stick_solver();
    }
    solver.solve(left.linear, left.angular);
    const double size = substep.correct(left), rate = newton.rate(size, law);
    if (size * rate <= StageNewton::k_error * substep.scale()) {
      newton.fresh = false;
      substep.end_stage();
      return true;
    }
    newton.go_on(size, rate, iteration);
  }
  return false;
}

// Of advance_by_substeps.
struct BodyAlone {
  ReducedBody& body;
  BodyState& s;
  std::span<Vec3> stick;
  StepEnergy& booked;

  double first(const ContactLaw& law) const { return body.first_substep(law); }
  double next_landing(double within) const { return body.next_landing(s, within); }
  double wanted() const { return s.substep; }
  void want(double size) { s.substep = size; }
  ImplicitOutcome substep(const SubstepSpan& span) {
    ImplicitSubstep substep(body, span, s, stick, ImplicitSubstep::speed_of(body, s));
    StageNewton newton;
    RigidSolver solver, sticks;
    for (const PreparedLaw* law : {&span.middle.law, &span.end.law})
      if (!solve_stage(substep, *law, newton, solver, sticks)) {
        substep.give_up();
        return ImplicitOutcome::given_up(ImplicitOutcome::k_no_stage);
      }
    BodyVelocity bent = substep.error();
    sticks.solve(bent.linear, bent.angular);
    const double error = substep.over_allowed(bent);
    if (!(error <= 1)) {
      substep.give_up();
      return ImplicitOutcome::given_up(error);
    }
    substep.arrive();
    substep.finish(booked);
    return {SubstepEnd::reached, error};
  }
};

}  // namespace

StepStatus::Kind ReducedBody::advance_implicit(const Parameters& parameters, const StepInputs& start,
                                               const StepInputs& end, double h, BodyState& s,
                                               std::span<Vec3> stick, StepEnergy& booked) {
  BodyAlone alone{*this, s, stick, booked};
  return advance_by_substeps(alone, parameters, start, end, h);
}

}  // namespace topple
