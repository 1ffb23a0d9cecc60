#include "solver/reduced/implicit_substep.h"

#include <cmath>

#include "solver/element/damping.h"
#include "solver/math/rotation.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_gamma = SubstepSpan::k_gamma;
constexpr double k_substep_error = 0.1;  // of the tolerance times the speed: local error of the velocity
constexpr double k_speed_floor = 0.01;   // of the speed of a fall through the reach

// Of what acts: what a method of third order with the same stages takes over h, less what this one does
// (Hosea and Shampine 1996).
template <class T>
T third_order(const T& start, const T& first, const T& second) {
  constexpr double k_early = SubstepSpan::k_early;
  return 1. / 3 * ((1 - 4 * k_early) * start + first - 2 * k_gamma * second);
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
  const ContactPower power =
      body.contacts_.power({packed(s.velocity), r0_ * packed(s.angular_velocity), s.rate});
  start_.damping_power = power.damping;
  start_.friction_power = power.friction;
  body.contacts_.begin_substep();
  start_.force = packed(s.force);
  start_.moment = packed(s.moment);
  omega0_ = r0_ * packed(s.angular_velocity);
  gravity_ = packed(span.parameters.gravity);
  field_ = gravity_ - packed(span.middle.floor);
  const double gamma_dt = span.gamma_dt;
  velocity0_ = packed(s.velocity);
  spin0_ = r0_ * (body.inertia_ * packed(s.angular_velocity));
  from_.position = mul_add(gamma_dt, velocity0_, packed(s.position));
  from_.turn = gamma_dt * omega0_;
  from_.momentum = mul_add(gamma_dt, start_.force, body.mass_ * velocity0_);
  from_.spin = mul_add(gamma_dt, start_.moment, spin0_);
  one_.u.linear = mul_add(2 * gamma_dt / body.mass_, start_.force, velocity0_);
  one_.u.angular = omega0_ + 2 * gamma_dt * (inverse_inertia_ * start_.moment);
  if (modes_ == 0) return;
  damping_ = damping_time(body.model_, span.parameters, body.body_);
  start_.load = s.load;
  for (int k = 0; k < modes_; ++k) {
    from_.amplitude[k] = s.amplitude[k] + gamma_dt * s.rate[k];
    from_.rate[k] = s.rate[k] + gamma_dt * pull(start_, s.amplitude[k], s.rate[k], k);
  }
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
  const StepInputs& inputs = now_ == &one_ ? span_.middle : span_.end;
  const PreparedLaw& law = inputs.law;
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
  anchors.take(inputs.pulls);
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

void ImplicitSubstep::correct(const BodyVelocity& by) {
  BodyVelocity& u = now_->u;
  u.linear = u.linear - by.linear;
  u.angular = u.angular - by.angular;
  for (int k = 0; k < modes_; ++k) u.rate[k] -= by.rate[k];
}

double ImplicitSubstep::size_of(const BodyVelocity& correction) const {
  double size = 0;
  for (int k = 0; k < modes_; ++k) size += std::abs(correction.rate[k]);
  if (modes_ > 0) size /= std::sqrt(body_.mass_);
  return size + velocity_size(body_.reach_, correction.linear, correction.angular);
}

double ImplicitSubstep::scale() const {
  return velocity_scale(body_.reach_, now_->u);
}

void ImplicitSubstep::end_stage() {
  Stage& stage = *now_;
  const double gamma_dt = span_.gamma_dt, early = span_.early;
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
  from_.position = mul_add(early, velocity0_ + one_.u.linear, packed(before_.position));
  from_.turn = early * (omega0_ + turning_);
  from_.momentum = mul_add(early, start_.force + acted.force, body_.mass_ * velocity0_);
  from_.spin = mul_add(early, start_.moment + acted.moment, spin0_);
  now_ = &two_;
  field_ = gravity_ - packed(span_.end.floor);
  two_.u.linear = 1 / body_.mass_ * mul_add(gamma_dt, acted.force, from_.momentum);
  two_.u.angular = omega0_ + span_.h * (inverse_inertia_ * acted.moment);
  if (modes_ == 0) return;
  for (int k = 0; k < modes_; ++k) {
    const double first = (one_.u.rate[k] - from_.rate[k]) / gamma_dt;
    from_.rate[k] =
        before_.rate[k] + early * (pull(start_, before_.amplitude[k], before_.rate[k], k) + first);
    from_.amplitude[k] = before_.amplitude[k] + early * (before_.rate[k] + one_.u.rate[k]);
  }
  guess_rates(acted.load);
}

BodyVelocity ImplicitSubstep::error() const {
  BodyVelocity error;
  error.linear = third_order(start_.force, one_.acting.force, two_.acting.force);
  error.angular = third_order(start_.moment, one_.acting.moment, two_.acting.moment);
  const double gamma_dt = span_.gamma_dt;
  for (int k = 0; k < modes_; ++k) {
    const double first = before_.amplitude[k] + gamma_dt * (before_.rate[k] + one_.u.rate[k]),
                 second = from_.amplitude[k] + gamma_dt * two_.u.rate[k];
    error.rate[k] = third_order(pull(start_, before_.amplitude[k], before_.rate[k], k),
                                pull(one_.acting, first, one_.u.rate[k], k),
                                pull(two_.acting, second, two_.u.rate[k], k));
  }
  return error;
}

double ImplicitSubstep::over_allowed(const BodyVelocity& error) const {
  double bent = 0;
  for (int k = 0; k < modes_; ++k) bent += std::abs(error.rate[k]);
  if (modes_ > 0) bent /= std::sqrt(body_.mass_);
  return span_.h * (norm(error.linear) + body_.reach_ * norm(error.angular) + bent) / allowed_;
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
    const double r0 = before_.rate[k], r1 = one_.u.rate[k], r2 = two_.u.rate[k];
    const auto gain = [](double from, double to) { return 0.5 * (to + from) * (to - from); };
    const double damped = damping_ * spring(k) * span_.integral(r0 * r0, r1 * r1, r2 * r2);
    booked.damping += damped;
    booked.numerical +=
        span_.integral(start_.load[k] * r0, one_.acting.load[k] * r1, two_.acting.load[k] * r2) - damped -
        gain(before_.rate[k], s_.rate[k]) - spring(k) * gain(before_.amplitude[k], s_.amplitude[k]);
  }
}

void ImplicitSubstep::finish(StepEnergy& booked) {
  const double mass = body_.mass_;
  const Parameters& parameters = span_.parameters;
  const PackVec3 floor0 = packed(span_.start.floor), floor1 = packed(span_.middle.floor),
                 floor2 = packed(span_.end.floor);
  const Vec3 shift = s_.position - before_.position;
  const auto along_path = [&](const PackVec3& f0, const PackVec3& f1, const PackVec3& f2, auto integral) {
    return (span_.*integral)(dot(f0, velocity0_), dot(f1, one_.u.linear), dot(f2, two_.u.linear));
  };
  const double from_gravity = mass * parameters.gravity.dot(shift),
               from_floor = -mass * along_path(floor0, floor1, floor2, &SubstepSpan::by_method);
  const auto of_contacts = [&](const Acting& acting, const PackVec3& floor) {
    return acting.force - mass * (gravity_ - floor);
  };
  BodyContacts& contacts = body_.contacts_;
  booked.gravity -= from_gravity;
  booked.input += from_floor + body_.anchors_.pull_work(span_.start.pulls, span_.end.pulls, before_, s_);
  booked.normal_damping +=
      span_.integral(start_.damping_power, one_.acting.damping_power, two_.acting.damping_power);
  booked.friction +=
      span_.integral(start_.friction_power, one_.acting.friction_power, two_.acting.friction_power) -
      contacts.stick_energy_gained();
  booked.numerical += from_gravity + from_floor +
                      along_path(of_contacts(start_, floor0), of_contacts(one_.acting, floor1),
                                 of_contacts(two_.acting, floor2), &SubstepSpan::integral) +
                      span_.integral(dot(start_.moment, omega0_), dot(one_.acting.moment, one_.u.angular),
                                     dot(two_.acting.moment, two_.u.angular)) -
                      0.5 * mass * (s_.velocity + before_.velocity).dot(s_.velocity - before_.velocity) -
                      0.5 * (dot(two_.spin, two_.u.angular) - dot(spin0_, omega0_));
  book_modes(booked);
  contacts.book_law_change(span_.start.law, span_.end.law, booked);
  // not the stage's forces: springs that slipped are shorter now, and the next substep compares its forces
  // with these
  body_.finish_substep(span_.end.law, parameters.gravity - span_.end.floor, s_, stick_);
}

void ImplicitSubstep::give_up() {
  s_ = before_;
  body_.contacts_.give_up_substep();
}

void ReducedBody::find_contacts_after(const BodyState& before, const PreparedLaw& law, const BodyState& s,
                                      std::span<const Vec3> stick) {
  const PackMat3 r = rotation_matrix(packed(s.rotation));
  contacts_.begin_substep();
  contacts_.find(s, r, stick);
  contacts_.follow(before, rotation_matrix(packed(before.rotation)), s, r);
  respond_at<ContactSums::none>(law, s);
}

void ReducedBody::finish_substep(const PreparedLaw& law, const Vec3& field, BodyState& s,
                                 std::span<Vec3> stick) {
  contacts_.keep_sticks(law, stick);
  const ContactLoads loads = respond_at<ContactSums::loads>(law, s);
  s.force = unpacked(loads.force + mass_ * packed(field));
  s.moment = unpacked(loads.moment);
  if (modes(s) > 0) {
    s.load.setZero();
    contacts_.modal_loads(modes(s), s.load);
    anchors_.modal_loads(s, modes(s), s.load);
  }
  if (!anchors_.any()) return;
  s.force += anchors_.force();
  s.moment += anchors_.moment();
}

// A first guess at a substep that follows a touch.
double ReducedBody::first_substep(const ContactLaw& law) const {
  const double contact =
      std::sqrt(contacts_.share_of_mass() * contacts_.least_length() / (law.alpha * std::max(1., law.q)));
  return k_resolved_bounce *
         (anchors_.holds() ? std::min(contact, std::sqrt(mass_ / anchors_.greatest_stiffness())) : contact);
}

double ReducedBody::next_landing(const BodyState& s, double within) const {
  return contacts_.next_landing(s, s.force / mass_, angular_acceleration(s), within);
}

double ReducedBody::next_kink(const BodyState& s, double within) const {
  const Vec3 acceleration = s.force / mass_, turn = angular_acceleration(s);
  return std::min(contacts_.next_landing(s, acceleration, turn, within),
                  contacts_.next_stop(s, acceleration, turn, within));
}

namespace {

// Newton for the velocity of a stage.
bool solve_stage(ImplicitSubstep& substep, const SubstepSpan& span, const PreparedLaw& law,
                 StageNewton& newton, RigidSolver& solver, RigidSolver& sticks) {
  newton.begin_stage();
  for (int iteration = 0; iteration < k_newton_iterations; ++iteration) {
    substep.reach(newton.fresh);
    BodyVelocity left = substep.residual();
    if (newton.fresh) {
      solver = substep.solver();
      sticks = substep.stick_solver();
    }
    solver.solve(left.linear, left.angular);
    substep.correct(left);
    const double size = substep.size_of(left), rate = newton.rate(size, law);
    if (size * rate <= StageNewton::error(span.parameters.tolerance) * substep.scale()) {
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
  double next_kink(double within) const { return body.next_kink(s, within); }
  double wanted() const { return s.substep; }
  void want(double size) { s.substep = size; }
  ImplicitOutcome substep(const SubstepSpan& span) {
    ImplicitSubstep substep(body, span, s, stick, ImplicitSubstep::speed_of(body, s));
    StageNewton newton;
    RigidSolver solver, sticks;
    for (const PreparedLaw* law : {&span.middle.law, &span.end.law})
      if (!solve_stage(substep, span, *law, newton, solver, sticks)) {
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
