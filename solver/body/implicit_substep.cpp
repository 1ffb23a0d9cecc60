// The stiff method of ReducedBody.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/body/reduced_body.h"
#include "solver/body/rigid_solver.h"
#include "solver/math/elementary.h"
#include "solver/math/rotation.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_gamma = 0.29289321881345254;  // 1 - 1/sqrt(2)
constexpr double k_error_constant = 3 * k_gamma * k_gamma - 2 * k_gamma * k_gamma * k_gamma - 1. / 6;
constexpr double k_stage_error = 1e-7;    // of the speed
constexpr double k_substep_error = 0.03;  // of the tolerance times the speed: local error of the velocity
constexpr double k_speed_floor = 0.01;    // of the speed of a fall through the reach
constexpr double k_resolved = 0.3;        // rad, of a contact's bounce, in the first substep after a touch
constexpr double k_safety = 0.9, k_most_growth = 3, k_most_shrinking = 5;
constexpr double k_least_substep = 1e-4;  // of the first one
constexpr double k_no_stage = 1e3;        // counts as this error

// |a''| times h^2/2, from what acts at the ends of the stages.
PackVec3 bend(const PackVec3& start, const PackVec3& first, const PackVec3& second) {
  return 1 / (1 - k_gamma) * (second - first) - 1 / k_gamma * (first - start);
}

double norm(const PackVec3& v) {
  return std::sqrt(dot(v, v));
}

}  // namespace

struct ReducedBody::ImplicitSubstep {
  const BodyState& start;
  PackMat3 r0;
  std::span<const Vec3> stick;
  double gamma_dt;  // s, gamma h
  RigidSolver solver, sticks;
  bool fresh;  // the solver is to be made anew
};

// Places `at` where the stage's velocity leads, with rotation matrix r, and finds the forces there.
ContactLoads ReducedBody::reach_stage(const ImplicitSubstep& substep, const PreparedLaw& law,
                                      const Origin& from, bool with_slope, BodyState& at, Stage& stage,
                                      PackMat3& r) {
  const BodyVelocity& u = stage.u;
  at.position = unpacked(mul_add(substep.gamma_dt, u.linear, from.position));
  PackVec3 turn = mul_add(substep.gamma_dt, u.angular, from.turn);
  const PackVec3 once = cross(turn, u.angular);
  stage.turning = u.angular - 0.5 * once + 1. / 12 * cross(turn, once);  // inverse tangent of the exponential
  turn = mul_add(substep.gamma_dt, stage.turning, from.turn);
  const PackQuaternion<double> q =
      normalized(packed(exp_quaternion(unpacked(turn))) * packed(substep.start.rotation));
  at.rotation.coeffs() << q.v.x, q.v.y, q.v.z, q.w;
  r = rotation_matrix(q);
  contacts_.find(at, r, substep.stick);
  contacts_.follow(substep.start, substep.r0, at, r);
  ContactLoads loads = with_slope ? contacts_.evaluate_forces<true>(law, u, substep.gamma_dt)
                                  : contacts_.evaluate_forces<false>(law, u, substep.gamma_dt);
  if (!anchors_.any()) return loads;
  anchors_.find(at);
  loads.force = loads.force + packed(anchors_.force());
  loads.moment = loads.moment + packed(anchors_.moment());
  return loads;
}

// Newton for the velocity of a stage:  M u = momentum of `from` + gamma_dt (field + contacts).
ReducedBody::Solution ReducedBody::solve_stage(ImplicitSubstep& substep, const StepInputs& now,
                                               const PackVec3& field, const Origin& from, BodyState& at,
                                               Stage& stage) {
  BodyVelocity& u = stage.u;
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < k_newton_iterations; ++iteration) {
    PackMat3 r;
    const ContactLoads loads = reach_stage(substep, now.law, from, substep.fresh, at, stage, r);
    const auto spin = [&] { return r * (inertia_ * transposed_times(r, u.angular)); };
    PackVec3 x = mass_ * u.linear - from.momentum - substep.gamma_dt * (loads.force + mass_ * field),
             y = spin() - from.spin - substep.gamma_dt * loads.moment;
    if (substep.fresh) {
      ContactSlope slope = contacts_.slope();
      anchors_.add_slope(at, substep.gamma_dt, slope);
      substep.solver = RigidSolver(mass_, inertia_at(r), substep.gamma_dt, slope);
      substep.sticks = RigidSolver(mass_, inertia_at(r), substep.gamma_dt, contacts_.stick_slope());
    }
    substep.solver.solve(x, y);
    u.linear = u.linear - x;
    u.angular = u.angular - y;
    const double size = velocity_size(reach_, x, y);
    // what is left after the correction: its rate, or its square over that of the smoothing
    const double rate = substep.fresh ? std::min(1., size / now.law.bend) : size / last;
    if (size * rate <= k_stage_error * velocity_scale(reach_, u)) {
      substep.fresh = false;
      stage.spin = spin();
      stage.damping_power = loads.damping_power;
      stage.friction_power = loads.friction_power;
      return Solution::found;
    }
    substep.fresh = rate > k_newton_good_rate && (!substep.fresh || iteration > 0);
    last = size;
  }
  return Solution::none;
}

// too_long: the error of the velocity is greater than allowed, m/s. unsolved: a stage is not found.
ReducedBody::ImplicitOutcome ReducedBody::implicit_substep(const Parameters& parameters,
                                                           const StepInputs& start, const StepInputs& end,
                                                           double h, double allowed, BodyState& s,
                                                           std::span<Vec3> stick, StepEnergy& booked) {
  const double gamma_dt = k_gamma * h, rest = (1 - k_gamma) * h;
  const StepInputs middle(parameters, start.time + gamma_dt);
  const BodyState before = s;
  contacts_.begin_substep();
  ImplicitSubstep substep{before, rotation_matrix(packed(before.rotation)), stick, gamma_dt, {}, {}, true};
  const PackVec3 omega0 = substep.r0 * packed(before.angular_velocity), force0 = packed(before.force),
                 moment0 = packed(before.moment), gravity = packed(parameters.gravity),
                 floor1 = packed(middle.floor), floor2 = packed(end.floor);
  const PackMat3 inverse_inertia = substep.r0 * inverse_inertia_ * transposed(substep.r0);
  const auto give_up = [&](double error) {
    s = before;
    contacts_.give_up_substep();
    return error < k_no_stage ? ImplicitOutcome{SubstepEnd::too_long, error}
                              : ImplicitOutcome{SubstepEnd::unsolved, k_no_stage};
  };

  Origin from{packed(before.position),
              {0, 0, 0},
              mass_ * packed(before.velocity),
              substep.r0 * (inertia_ * packed(before.angular_velocity))};
  const PackVec3 spin0 = from.spin;
  Stage one;
  one.u.linear = mul_add(gamma_dt / mass_, force0, packed(before.velocity));
  one.u.angular = omega0 + gamma_dt * (inverse_inertia * moment0);
  if (solve_stage(substep, middle, gravity - floor1, from, s, one) == Solution::none)
    return give_up(k_no_stage);
  const PackVec3 force1 = 1 / gamma_dt * (mass_ * one.u.linear - from.momentum),
                 moment1 = 1 / gamma_dt * (one.spin - from.spin);

  from = {mul_add(rest, one.u.linear, from.position), rest * one.turning,
          mul_add(rest, force1, from.momentum), mul_add(rest, moment1, from.spin)};
  Stage two;
  two.u.linear = 1 / mass_ * mul_add(gamma_dt, force1, from.momentum);
  two.u.angular = omega0 + h * (inverse_inertia * moment1);
  if (solve_stage(substep, end, gravity - floor2, from, s, two) == Solution::none) return give_up(k_no_stage);
  const PackVec3 force2 = 1 / gamma_dt * (mass_ * two.u.linear - from.momentum),
                 moment2 = 1 / gamma_dt * (two.spin - from.spin);

  PackVec3 bent = bend(force0, force1, force2), twisted = bend(moment0, moment1, moment2);
  substep.sticks.solve(bent, twisted);
  const double error = 2 * k_error_constant * h * (norm(bent) + reach_ * norm(twisted)) / allowed;
  if (!(error <= 1)) return give_up(error);

  // where the last correction of Newton leads
  PackMat3 r;
  reach_stage(substep, end.law, from, false, s, two, r);
  s.velocity = unpacked(two.u.linear);
  s.angular_velocity = unpacked(transposed_times(r, two.u.angular));

  const Vec3 shift = s.position - before.position;
  const auto work = [&](const PackVec3& f1, const PackVec3& v1, const PackVec3& f2, const PackVec3& v2) {
    return rest * dot(f1, v1) + gamma_dt * dot(f2, v2);
  };
  booked.gravity -= mass_ * parameters.gravity.dot(shift);
  booked.input -= mass_ * work(floor1, one.u.linear, floor2, two.u.linear);
  booked.normal_damping += rest * one.damping_power + gamma_dt * two.damping_power;
  booked.friction +=
      rest * one.friction_power + gamma_dt * two.friction_power - contacts_.stick_energy_gained();
  booked.numerical += work(force1, one.u.linear, force2, two.u.linear) +
                      work(moment1, one.u.angular, moment2, two.u.angular) -
                      0.5 * mass_ * (s.velocity + before.velocity).dot(s.velocity - before.velocity) -
                      0.5 * (dot(two.spin, two.u.angular) - dot(spin0, omega0));
  contacts_.book_law_change(start.law, end.law, booked);
  contacts_.keep_sticks(end.law, stick);
  // not force2: springs that slipped are shorter now, and the next substep compares its forces with these
  const ContactLoads loads = respond_at<ContactSums::loads>(end.law, s);
  s.force = unpacked(loads.force + mass_ * (gravity - floor2));
  s.moment = unpacked(loads.moment);
  if (anchors_.any()) {
    s.force += anchors_.force();
    s.moment += anchors_.moment();
  }
  return {SubstepEnd::reached, error};
}

// A first guess at a substep that follows a touch.
double ReducedBody::first_substep(const ContactLaw& law) const {
  const double contact =
      std::sqrt(contacts_.share_of_mass() * contacts_.least_length() / (law.alpha * std::max(1., law.q)));
  return k_resolved *
         (anchors_.any() ? std::min(contact, std::sqrt(mass_ / anchors_.greatest_stiffness())) : contact);
}

double ReducedBody::next_landing(const BodyState& s, double within) const {
  return contacts_.next_landing(s, s.force / mass_, angular_acceleration(s), within);
}

StepStatus::Kind ReducedBody::advance_implicit(const Parameters& parameters, const StepInputs& start,
                                               const StepInputs& end, double h, BodyState& s,
                                               std::span<Vec3> stick, StepEnergy& booked) {
  const double floor = k_speed_floor * std::sqrt(parameters.gravity.norm() * reach_);
  StepInputs from = start;
  double left = h, growth = k_most_growth;
  while (left > 0) {
    const double first = first_substep(from.law);
    double size = s.substep > 0 ? s.substep : first;
    if (const double landing = next_landing(s, std::min(size, left)); landing < size)
      size = std::max(landing, std::min(size, first));
    const double wanted = size;
    if (left < 2 * size) size = left <= size ? left : left / 2;
    const bool last = size == left;
    const StepInputs to = last ? end : StepInputs(parameters, from.time + size);
    const double allowed = k_substep_error * parameters.tolerance *
                           std::max(s.velocity.norm() + reach_ * s.angular_velocity.norm(), floor);
    const ImplicitOutcome substep = implicit_substep(parameters, from, to, size, allowed, s, stick, booked);
    const bool good = substep.end == SubstepEnd::reached;
    const double next = size * std::clamp(k_safety / elementary::cbrt(substep.error), 1 / k_most_shrinking,
                                          good ? growth : k_safety);
    if (!good) {
      if (size < k_least_substep * first)
        return parameters.adaptive && substep.end == SubstepEnd::too_long ? StepStatus::Kind::not_accurate
                                                                          : StepStatus::Kind::newton_diverged;
      growth = 1;
      s.substep = next;
      continue;
    }
    growth = k_most_growth;
    s.substep = size < wanted ? std::max(next, wanted) : next;
    left = last ? 0 : left - size;
    from = to;
  }
  return StepStatus::Kind::ok;
}

}  // namespace topple
