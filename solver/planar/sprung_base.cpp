#include "solver/planar/sprung_base.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/contact_law.h"

namespace topple::planar {
namespace {

constexpr int k_landing_steps = 25, k_lift_steps = 8;  // in the time in which an edge sinks
constexpr double k_smooth_step = 0.3;  // of a lift, over the time in which its weight has the smoothing speed
constexpr int k_most_landing_steps = 10'000, k_most_lift_steps = 100'000;  // where contacts never let go
constexpr double k_slowest = 2;  // tilt over that of an edge alone, from which a landing is followed
// Over the time of a lean: how long before a rigid base would lift it is followed, and in which what the
// floor had pushed by then grows, long enough for both to die away.
constexpr double k_before = 40, k_first = 16;

}  // namespace

// Seen along the plane so that x, from below the centre of gravity, grows towards the edge that it stands on.
struct SprungBase::View {
  double sign, edge, far;  // of x; m, to that edge and to the other one
  double inertia;          // over mass, about the middle of the base, which friction holds, m^2
  double soonest;          // time in which the stiffest line sinks over that of this edge
  const SprungLine &on, &next, &last;

  double about_edge() const { return inertia + edge * edge; }
  double about_far() const { return inertia + far * far; }
  bool rights(double height, double turn) const { return -edge < height * turn && height * turn < far; }
};

// Motion of the base: rise of the point below the centre of gravity; turn lifts where x > 0.
struct SprungBase::Motion {
  double rise = 0, velocity = 0, turn = 0, rate = 0;
  double acceleration = 0, angular_acceleration = 0;  // of the step before
};

SprungBase::SprungBase(const Block& block, std::span<const BaseLine> base, const ContactLaw& law, double L)
    : q_(law.q), smoothing_(law.normal_speed) {
  for (const BaseLine& line : base)
    lines_.push_back({line.place, static_cast<double>(line.points.size()) * law.alpha /
                                      (block.mass * elementary::pow(L, law.q))});
  for (const Side side : {Side::left, Side::right}) {
    Slowest& slowest = slowest_[static_cast<std::size_t>(side)];
    const View on = view(block, other(side));
    const double tilt = std::min(k_slowest * tilt_alone(block, on), on.edge / (2 * block.height));
    slowest.rate = std::sqrt(std::max(0., work(block, on.edge, tilt)) / on.about_edge());
    slowest.factor = follow_landing(block, on, slowest.rate);
  }
}

SprungBase::View SprungBase::view(const Block& block, Side on) const {
  const bool right = on == Side::right;
  const std::size_t end = lines_.size() - 1;
  double stiffest = 0;
  for (const SprungLine& line : lines_) stiffest = std::max(stiffest, line.stiffness);
  return {right ? 1. : -1.,
          right ? block.right : block.left,
          right ? block.left : block.right,
          block.inertia_over_mass() + block.height * block.height,
          std::sqrt(lines_[right ? end : 0].stiffness / stiffest),
          lines_[right ? end : 0],
          lines_[right ? end - 1 : 1],
          lines_[right ? 0 : end]};
}

double SprungBase::depth(const SprungLine& line, double force) const {
  return q_ == 1 ? force / line.stiffness : elementary::pow(force / line.stiffness, 1 / q_);
}

// Tilt from which on a block at rest stands on the edge alone.
double SprungBase::tilt_alone(const Block& block, const View& on) const {
  return depth(on.on, block.gravity) / std::abs(on.next.place - on.on.place);
}

// Of gravity, from upright to a tilt about an edge, twice and per mass, m^2/s^2: what it takes.
double SprungBase::work(const Block& block, double edge, double tilt) {
  return block.gravity * tilt * (2 * edge - block.height * tilt);
}

// A step under a moment per mass; whether lines beside `alone` bear.
bool SprungBase::advance(const Block& block, const View& on, double h, double gravity, double moment,
                         const SprungLine& alone, Motion& s) const {
  s.rise += h / 2 * s.velocity;
  s.turn += h / 2 * s.rate;
  const double velocity = s.velocity + h / 2 * s.acceleration, rate = s.rate + h / 2 * s.angular_acceleration;
  double force = -gravity;
  moment += gravity * block.height * s.turn;
  bool others_bear = false;
  for (const SprungLine& line : lines_) {
    const double x = on.sign * line.place, deep = -(s.rise + x * s.turn);
    if (!(deep > 0)) continue;
    const double opening = velocity + x * rate,
                 loss = opening / std::sqrt(opening * opening + smoothing_ * smoothing_),
                 bears = (1 - loss) * line.stiffness * (q_ == 1 ? deep : elementary::pow(deep, q_));
    force += bears;
    moment += x * bears;
    others_bear |= &line != &alone;
  }
  s.acceleration = force, s.angular_acceleration = moment / on.inertia;
  s.velocity += h * s.acceleration;
  s.rate += h * s.angular_acceleration;
  s.rise += h / 2 * s.velocity;
  s.turn += h / 2 * s.rate;
  return others_bear;
}

// From where it stands on its edge alone to where it stands on the other one alone.
double SprungBase::follow_landing(const Block& block, const View& on, double rate) const {
  const double kept = on.inertia - on.edge * on.far;
  if (!(on.edge > 0 && on.far > 0 && kept > 0 && rate > 0)) return 1;
  const double g = block.gravity, start = std::min(tilt_alone(block, on), on.edge / (2 * block.height)),
               sunk = depth(on.on, g * on.inertia / on.about_edge());
  Motion s{.turn = -start};
  s.rate = std::sqrt(std::max(0., rate * rate - work(block, on.edge, start) / on.about_edge()));
  s.rise = on.edge * start - sunk, s.velocity = -on.edge * s.rate;

  const double speed = (on.edge + on.far) * rate,
               deep = elementary::pow(
                   (q_ + 1) / (4 * on.last.stiffness) * speed * speed / (1 + on.far * on.far / on.inertia),
                   1 / (q_ + 1)),
               h = std::min(std::sqrt(sunk / g), deep / speed) * on.soonest / k_landing_steps;
  bool others_bear = true;
  for (int step = 0; step < k_most_landing_steps && on.rights(block.height, s.turn) &&
                     (s.turn < 0 || (others_bear && s.rate > 0));
       ++step)
    others_bear = advance(block, on, h, g, 0, on.last, s);
  // about the edge on which it goes on, as if it did so from upright; gaining nothing
  const double after = std::max(0., on.inertia * s.rate + on.far * s.velocity) / on.about_far(),
               square = after * after + work(block, on.far, s.turn) / on.about_far();
  return std::min(std::sqrt(std::max(0., square)) * on.about_far() / (kept * rate),
                  std::sqrt(on.about_edge() * on.about_far()) / kept);
}

double SprungBase::landing_factor(const Block& block, Side side, double rate) const {
  const Slowest& slowest = slowest_[static_cast<std::size_t>(side)];
  return std::abs(rate) <= slowest.rate ? slowest.factor
                                        : follow_landing(block, view(block, other(side)), std::abs(rate));
}

double SprungBase::lift_rate(const Block& block, Side side, double horizontal, double growth,
                             double vertical) const {
  const View on = view(block, side);
  const double push = std::abs(horizontal), pushes_more = horizontal < 0 ? -growth : growth;
  if (!(on.edge > 0 && vertical > 0)) return 0;
  const double sunk = depth(on.on, vertical), lean = std::sqrt(on.inertia * sunk / vertical) / on.edge,
               h = std::min(std::sqrt(sunk / vertical) * on.soonest / k_lift_steps,
                            k_smooth_step * smoothing_ / vertical),
               before = pushes_more > 0 ? std::min(push / pushes_more, k_before * lean) : 0,
               at_first = before > 0 ? std::max(0., push - pushes_more * before) : 0,
               first = at_first > 0 ? std::min(k_first * lean, 2 * at_first / pushes_more) : 0;
  const auto pushed = [&](double time) {  // smoothly
    if (time >= -before) return push + pushes_more * time;
    const double part = 1 + (time + before) / first;
    return part * part * (at_first * (3 - 2 * part) - pushes_more * first * (1 - part));
  };
  double all = 0;
  for (const SprungLine& line : lines_) all += line.stiffness;
  Motion s{.rise = -depth({0, all}, vertical)};
  double time = -before - first;
  bool others_bear = true;
  for (int step = 0; step < k_most_lift_steps && on.rights(block.height, s.turn) && (time < 0 || others_bear);
       ++step, time += h)
    others_bear = advance(block, on, h, vertical, -block.height * pushed(time + h / 2), on.on, s);
  // Away from upright a + rate/p, a: the tilt, grows as exp(p t) but for what the floor adds, m + n t: that
  // at time 0 which comes to what it is now.
  const double about = on.about_edge(), p = std::sqrt(vertical * block.height / about),
               m = (block.height * push - on.edge * vertical) / about, n = block.height * pushes_more / about,
               now = -s.turn - (on.inertia * s.rate - on.edge * s.velocity) / (about * p);
  const double growing = now + (m + n * (time + 1 / p)) / (p * p), decay = elementary::exp(-p * time);
  const double rate = p * (growing * decay - (m + n / p) / (p * p));
  // no more than the floor does while it leans
  const double lean_tilt = std::min(tilt_alone(block, on), on.edge / block.height);
  return std::min(std::sqrt(2 * block.height * push * lean_tilt / about), std::max(0., rate));
}

}  // namespace topple::planar
