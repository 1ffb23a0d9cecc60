#include "solver/body/planar_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/body/body_pose.h"
#include "solver/body/model_level.h"
#include "solver/contact/contact_default.h"
#include "solver/contact/contact_law.h"
#include "solver/math/rotation.h"
#include "solver/model/excitation.h"
#include "solver/planar/integrator.h"
#include "solver/reduced/tipping.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

using planar::Event;
using planar::PlanarCase;
using planar::Side;

constexpr double k_time_slack = 1e-9;  // s, as of the jumps of other bodies
// Steps of a run are short, so that this takes few terms more: what is left is rounding.
constexpr double k_tolerance = 1e-16;
constexpr double k_growth = 30;         // hard_floor_error()
constexpr double k_noise = 1e-12;       // rad, m/s, rad/s: what a best fit makes of nothing
constexpr double k_longest = 0.01;      // s, step of an adaptive run while it rocks or flies,
constexpr double k_shortest = 1e-5;     // s, but for one that ends
constexpr double k_after_event = 1e-7;  // s after an event
constexpr double k_wall_margin = 1e-3;  // m

/// A jump of the floor's velocity from `after` on, s; k_never: none before `end`.
double next_jump(const Parameters& parameters, double after, double end) {
  double next = planar::k_never;
  for (const Shake& shake : parameters.shakes)
    if (shake.initial_velocity == Shake::Start::jump && shake.start >= after && shake.start < end)
      next = std::min(next, shake.start);
  return next;
}

/// Advances to a time; adds to `sum` where there is one. Event::none: it got there.
Event advance_to(const PlanarCase& of, const Parameters& parameters, double until, planar::State& motion,
                 planar::Step& step, planar::Exchanged* sum) {
  const planar::ShakenPlane plane{parameters.shakes, of.along};
  const planar::Floor floor = planar::shaken(plane);
  const double end = until - k_time_slack;
  double jump = next_jump(parameters, motion.time - k_time_slack, end);
  while (motion.time < until || jump <= motion.time) {
    const planar::State before = motion;
    if (jump <= motion.time) {
      const double after = std::nextafter(jump, planar::k_never);
      motion = planar::left_behind(motion, floor_velocity_jump(parameters.shakes, jump, after).dot(of.along));
      if (sum) sum->input += kinetic_energy(of.block, motion) - kinetic_energy(of.block, before);
      jump = next_jump(parameters, after, end);
      continue;
    }
    const Event event = advance(of.block, floor, of.controls, std::min(until, jump), motion, step);
    if (sum && event != Event::stalled) add_exchange(of.block, before, step, motion, event, *sum);
    if (event == Event::overturn || event == Event::stalled) return event;
  }
  return Event::none;
}

bool is_flat(const planar::State& motion) {
  return motion.mode == planar::Mode::rest || motion.mode == planar::Mode::slide;
}

/// Numbers of the law but for friction.
bool same_springs(ContactLaw a, const ContactLaw& b) {
  a.friction = b.friction;
  a.friction_static = b.friction_static;
  return a == b;
}

LevelReason reason_of(planar::Obstacle obstacle) {
  if (obstacle == planar::Obstacle::held) return LevelReason::held;
  return obstacle == planar::Obstacle::law ? LevelReason::contact : LevelReason::plane;
}

/// The block that a run begins with, or why there is none.
struct Beginning {
  std::optional<PlanarCase> block;
  std::string_view why;
};
Beginning beginning(const Model& model, const Parameters& parameters, const State& state, int body,
                    bool asked) {
  BodyState s = state.bodies[body];
  if (traits(s.level).moves_nodes) s = reduce(model, state, body, ModelLevel::rigid);
  const auto clean = [](const Vec3& v) { return v.norm() > k_noise ? v : Vec3(Vec3::Zero()); };
  const planar::RigidMotion motion{s.position, clean(log_quaternion(s.rotation)), clean(s.velocity),
                                   clean(s.rotation * s.angular_velocity)};
  std::vector<Vec3> centres;
  for (int b = 0; !asked && b < static_cast<int>(model.bodies.size()); ++b)
    centres.push_back(body_pose(model, state, b).centre);
  planar::Obstacle obstacle = planar::Obstacle::none;
  Beginning out{planar::planar_case(model, parameters, motion, centres, body, &obstacle), {}};
  if (!out.block)
    out.why = traits(obstacle).phrase;
  else if (out.block->bounces)
    out.why = "its contacts bounce";
  else if (!asked && parameters.contact.excess() > 0)
    out.why = "its friction falls as it slips, that of a block at once";
  else if (!asked && hard_floor_error(model, body, *out.block, parameters.contact) +
                             rigid_error(model, parameters, body) >
                         parameters.accuracy)
    out.why = "its contacts are too soft for a hard floor within run.accuracy";
  if (!out.why.empty()) out.block.reset();
  return out;
}

/// m, by which a body sinks on an edge whose points bear `force`, N, together.
double sinking(const ContactLaw& law, double force, const std::vector<int>& points, const Model& model,
               int floor) {
  if (points.empty() || !(force > 0)) return 0;
  const double L = contact_length(model.contact_points[points.front()], model.planes[floor]);
  return L * elementary::pow(force / (static_cast<double>(points.size()) * law.alpha), 1 / law.q);
}

}  // namespace

double hard_floor_error(const Model& model, int body, const PlanarCase& found, const ContactLaw& law) {
  const planar::Block& block = found.block;
  const std::vector<planar::BaseLine> base = planar::base_lines(model, body, found.along);
  double greatest = 0;
  for (const Side side : {Side::left, Side::right}) {
    const double b = side == Side::right ? block.right : block.left;
    if (!(b > 0)) return std::numeric_limits<double>::infinity();
    const std::vector<int>& edge = side == Side::right ? base.back().points : base.front().points;
    const double d = sinking(law, block.mass * block.gravity, edge, model, found.floor);
    greatest = std::max(greatest, k_growth * d * block.height / (2 * b * b));
  }
  return stands_for_hard_floor(model, law, Vec3(0, 0, -block.gravity)) ? 0 : greatest;
}

std::string_view why_not_planar(const Model& model, const Parameters& parameters, const State& state,
                                int body, bool asked) {
  return beginning(model, parameters, state, body, asked).why;
}

std::optional<BlockState> PlanarBody::begin(const Parameters& parameters, const State& state, bool asked) {
  const std::optional<PlanarCase> found = beginning(model_, parameters, state, body_, asked).block;
  if (!found) return std::nullopt;
  BlockState out;
  out.motion = found->start;
  out.motion.time = state.time;
  out.along = found->along;
  if (!block(parameters, out.along)) return std::nullopt;
  out.floor = floor_acceleration(parameters.shakes, state.time);
  out.static_friction = found->block.static_friction;
  out.kinetic_friction = found->block.kinetic_friction;
  return out;
}

const PlanarCase* PlanarBody::block(const Parameters& parameters, const Vec3& along) {
  if (!known_ || case_.along != along) {
    known_ = true;
    limited_.reset();
    const auto found = planar::planar_case_along(model_, parameters, along, body_, &obstacle_);
    case_ = found ? *found : planar::block_along(model_, parameters, along, body_);
    case_.along = along;
    case_.controls.tolerance = k_tolerance;
    base_ = planar::base_lines(model_, body_, along);
    error_ = topple::hard_floor_error(model_, body_, case_, parameters.contact);
  }
  return obstacle_ == planar::Obstacle::none ? &case_ : nullptr;
}

planar::Situation PlanarBody::situation(const StepInputs& now) const {
  return {case_.block, now.floor.dot(case_.along), case_.block.gravity + now.floor.z(), 0, step_.leg.known};
}

bool PlanarBody::near_wall(const planar::State& motion, double h, double push) const {
  const Body& body = model_.bodies[body_];
  const planar::Motion v = planar::centre_of_gravity(case_.block, motion);
  const double speed = elementary::hypot(v.x_velocity, v.z_velocity) + body.reach * std::abs(motion.rate);
  const double margin = k_wall_margin + 2 * h * (speed + h * push);
  const planar::Pose pose = planar::pose(case_, motion);
  for (int p = 0; p < static_cast<int>(model_.planes.size()); ++p) {
    const Plane& plane = model_.planes[p];
    if (p == case_.floor ||
        plane.normal.dot(pose.centre - plane.point) > body.reach + margin + k_wall_margin * 100)
      continue;
    for (int i = 0; i < body.contact_point_count; ++i) {
      const ContactPoint& point = model_.contact_points[body.first_contact_point + i];
      const Vec3 at =
          pose.centre + pose.rotation * (model_.node_position[point.node] - body.centre_of_gravity);
      if (plane.normal.dot(at - plane.point) < point.width / 2 + margin) return true;
    }
  }
  return false;
}

bool PlanarBody::spreads(const planar::State& motion) const {
  return base_.size() > 2 && is_flat(motion);
}

// What lies between the edges of the base bears where it is flat: with depths on a line, which has the
// resultant and moment of the forces on the edges alone.
void PlanarBody::divide(const ContactLaw& law, const planar::FloorForces& forces,
                        const planar::State& motion) {
  const auto count = [&](std::size_t k) { return static_cast<double>(base_[k].points.size()); };
  const std::size_t last = base_.size() - 1;
  shares_.assign(base_.size(), 0);
  shares_.front() = 1 - forces.right, shares_.back() = forces.right;
  if (!spreads(motion)) return;
  // the depths of the edges are (1, 1 + 2 w) for w from -1 to 0 and (1 - 2 w, 1) from there to 1
  const double wide = case_.block.left + case_.block.right;
  double sum = 0;
  const auto off = [&](double w) {  // the resultant, from where it is to be, over the width
    sunk_ = {std::min(1., 1 - 2 * w), std::min(1., 1 + 2 * w)};
    double moment = 0;
    sum = 0;
    for (std::size_t k = 0; k <= last; ++k) {
      const double there = (base_[k].place + case_.block.left) / wide,
                   depth = std::max(0., (1 - there) * sunk_[0] + there * sunk_[1]);
      shares_[k] = count(k) * (law.q == 1 ? depth : elementary::pow(depth, law.q));
      sum += shares_[k];
      moment += there * shares_[k];
    }
    return moment / sum - forces.right;
  };
  constexpr int k_halvings = 50;
  double low = -1, high = 1;
  for (int k = 0; k < k_halvings; ++k) {
    const double middle = (low + high) / 2;
    (off(middle) < 0 ? low : high) = middle;
  }
  off((low + high) / 2);
  for (double& share : shares_) share /= sum;
  const double scale = law.q == 1 ? 1 / sum : elementary::pow(sum, -1 / law.q);
  for (double& sunk : sunk_) sunk *= scale;
}

std::optional<LevelReason> PlanarBody::plan(const Parameters& parameters, const StepInputs& start,
                                            const StepInputs& end, const BlockState& from) {
  const PlanarCase* of = block(parameters, from.along);
  if (!of) return reason_of(obstacle_);
  const bool edited =
      parameters.contact_ramp.over > 0 && !same_springs(parameters.contact, parameters.contact_before);
  if (edited || of->bounces) return LevelReason::contact;
  const double push = of->block.gravity + std::max(start.floor.norm(), end.floor.norm());
  if (model_.planes.size() > 1 && near_wall(from.motion, end.time - start.time, push))
    return LevelReason::neighbour;
  planned_ = from;
  planned_.motion.undecided |= start.floor != from.floor ||
                               of->block.static_friction != from.static_friction ||
                               of->block.kinetic_friction != from.kinetic_friction;
  exchanged_ = {};
  const Event event = advance_to(*of, parameters, end.time, planned_.motion, step_, &exchanged_);
  planned_.floor = end.floor;
  planned_.static_friction = of->block.static_friction;
  planned_.kinetic_friction = of->block.kinetic_friction;
  if (event == Event::none) return std::nullopt;
  return event == Event::overturn ? LevelReason::fall : LevelReason::jammed;
}

void PlanarBody::take_planned(State& next, StepEnergy& energy) const {
  const double mass = case_.block.mass;
  next.blocks[body_] = planned_;
  energy.input += mass * exchanged_.input;
  energy.gravity += mass * exchanged_.gravity;
  energy.friction += mass * exchanged_.friction;
  energy.normal_damping += mass * exchanged_.impact;
}

void PlanarBody::place_within(const Parameters& parameters, const State& from, const State& end, double time,
                              State& at) {
  BlockState& s = at.blocks[body_] = from.blocks[body_];
  const PlanarCase* of = block(parameters, s.along);
  if (!of) return;
  planar::Step step;
  const StepInputs start(parameters, from.time), now(parameters, time);
  s.motion.undecided |= start.floor != s.floor || of->block.static_friction != s.static_friction ||
                        of->block.kinetic_friction != s.kinetic_friction;
  planar::Exchanged until;
  advance_to(*of, parameters, time, s.motion, step, &until);
  // what lies between the step's ends in `at` is as far as the time is: this is what has been exchanged
  const double part = (time - from.time) / (end.time - from.time), mass = of->block.mass;
  EnergyLedger& books = at.energy;
  books.input += mass * (until.input - part * exchanged_.input);
  books.gravity += mass * (until.gravity - part * exchanged_.gravity);
  books.friction += mass * (until.friction - part * exchanged_.friction);
  books.normal_damping += mass * (until.impact - part * exchanged_.impact);
  books.kinetic +=
      balance(parameters, now, at).kinetic - (1 - part) * energy(from).kinetic - part * energy(end).kinetic;
}

BodyEnergy PlanarBody::balance(const Parameters& parameters, const StepInputs& now, State& state) {
  const BlockState& from = state.blocks[body_];
  BodyState& s = state.bodies[body_];
  const PlanarCase* of = block(parameters, from.along);
  if (!of) return energy(state);
  const planar::Turned turned{from.motion.tilt, step_.leg.known.at(from.motion.tilt)};
  const planar::Pose pose = planar::pose(*of, from.motion, turned);
  const planar::Motion v = planar::centre_of_gravity(of->block, from.motion, turned);
  const planar::FloorForces f = planar::floor_forces(situation(now), from.motion);
  const double mass = of->block.mass;
  s.position = pose.centre;
  s.rotation = pose.rotation;
  s.velocity = v.x_velocity * of->along + v.z_velocity * Vec3::UnitZ();
  s.angular_velocity = from.motion.rate * of->across;
  s.force = mass * (parameters.gravity - now.floor + f.tangential * of->along + f.normal * Vec3::UnitZ());
  s.moment.setZero();
  for (const Side side : {Side::left, Side::right}) {
    const double share = side == Side::right ? f.right : 1 - f.right;
    const planar::Lever r = planar::lever(of->block, side, turned.of);
    s.moment += share * mass * (r.z * f.tangential - r.x * f.normal) * of->across;
  }
  return energy(state);
}

BodyEnergy PlanarBody::energy(const State& state) const {
  const BodyState& s = state.bodies[body_];
  const Body& body = model_.bodies[body_];
  return {.kinetic = 0.5 * body.mass * s.velocity.squaredNorm() +
                     0.5 * s.angular_velocity.dot(body.inertia * s.angular_velocity)};
}

double PlanarBody::hard_floor_error(const Parameters& parameters, const State& state) {
  block(parameters, state.blocks[body_].along);
  return error_;
}

bool PlanarBody::stands(const Parameters& parameters, const State& state) {
  const BlockState& s = state.blocks[body_];
  const PlanarCase* of = block(parameters, s.along);
  return of && s.motion.mode == planar::Mode::rest && of->block.left >= 0 && of->block.right >= 0;
}

double PlanarBody::time_limit(const Parameters& parameters, const State& state) {
  const BlockState& s = state.blocks[body_];
  const PlanarCase* of = block(parameters, s.along);
  if (!of) return k_longest;
  const std::array key{s.motion.time, s.motion.tilt, s.motion.rate, s.motion.x_velocity};
  if (limited_ == key) return limit_;
  limited_ = key;
  const planar::ShakenPlane plane{parameters.shakes, of->along};
  const planar::Floor floor = planar::shaken(plane);
  planar::State motion = s.motion;
  const double longest = is_flat(motion) ? k_longest_step : k_longest, until = state.time + longest;
  while (motion.time < until)
    if (advance(of->block, floor, of->controls, until, motion, step_) != Event::none)
      return limit_ = std::clamp(motion.time + k_after_event - state.time, k_shortest, longest);
  return limit_ = longest;
}

void PlanarBody::list_contacts(const Parameters& parameters, const StepInputs& now, const State& state,
                               std::vector<ContactForce>& forces) {
  const BlockState& s = state.blocks[body_];
  const PlanarCase* of = block(parameters, s.along);
  if (!of) return;
  const planar::FloorForces f = planar::floor_forces(situation(now), s.motion);
  divide(now.law, f, s.motion);
  for (std::size_t k = 0; k < base_.size(); ++k) {
    const std::vector<int>& points = base_[k].points;
    const double share = shares_[k] * of->block.mass / static_cast<double>(points.size());
    if (!(share * f.normal > 0)) continue;
    const Vec3 force = share * (f.tangential * of->along + f.normal * Vec3::UnitZ());
    for (const int point : points) forces.push_back({point, case_.floor, 0, share * f.normal, force});
  }
}

void PlanarBody::sink(const Parameters& parameters, const StepInputs& now, State& state) {
  const BlockState& from = state.blocks[body_];
  block(parameters, from.along);
  BodyState& s = state.bodies[body_];
  const planar::Block& block = case_.block;
  const planar::FloorForces f = planar::floor_forces(situation(now), from.motion);
  divide(now.law, f, from.motion);
  for (std::size_t k = 0; k < base_.size(); ++k) {
    const std::vector<int>& points = base_[k].points;
    const double share = shares_[k] * block.mass;
    if (!(share * f.normal > 0) || !traits(now.law).sticks) continue;
    for (const int point : points) {
      const double L = contact_length(model_.contact_points[point], model_.planes[case_.floor]);
      const double stiffness = k_stick_stiffness * now.law.alpha / L * static_cast<double>(points.size());
      state.stick[point * model_.planes.size() + case_.floor] =
          -share * f.tangential / stiffness * case_.along;
    }
  }
  const auto sunk = [&](std::size_t end) {
    if (spreads(from.motion)) return sunk_[end];
    const double share = end == 0 ? shares_.front() : shares_.back();
    const std::vector<int>& points = end == 0 ? base_.front().points : base_.back().points;
    return elementary::pow(share / static_cast<double>(points.size()), 1 / now.law.q);
  };
  const double L = contact_length(model_.contact_points[base_.front().points.front()],
                                  model_.planes[case_.floor]),
               alone =
                   L * elementary::pow(std::max(0., block.mass * f.normal) / now.law.alpha, 1 / now.law.q),
               down[] = {alone * sunk(0), alone * sunk(1)};
  if (!is_flat(from.motion)) {
    s.position.z() -= std::max(down[0], down[1]);
    return;
  }
  const double turn = (down[1] - down[0]) / (block.left + block.right);
  s.position.z() -= (down[0] * block.right + down[1] * block.left) / (block.left + block.right);
  s.position += block.height * turn * case_.along;
  s.rotation = (exp_quaternion(turn * case_.across) * s.rotation).normalized();
}

}  // namespace topple
