#include "solver/planar/planar_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/model/excitation.h"

namespace topple::planar {
namespace {

/// Of the shakes that begin at this instant.
State jumped(const PlanarCase& of, const std::vector<Shake>& shakes, const State& state) {
  const Vec3 jump = floor_velocity_jump(shakes, state.time, std::nextafter(state.time, k_never));
  return jump.isZero(0) ? state : left_behind(state, jump.dot(of.along));
}

}  // namespace

PlanarRun::PlanarRun(const PlanarCase& of, std::vector<Shake> shakes, double duration)
    : case_(of),
      shakes_(std::move(shakes)),
      plane_{shakes_, of.along},
      duration_(duration),
      critical_{of.critical(Side::left), of.critical(Side::right)},
      state_(jumped(of, shakes_, of.start)),
      middle_at_start_(middle(centre_of_gravity(of.block, state_).x)) {
  observe(step_, 0);
}

double PlanarRun::next_jump() const {
  double next = k_never;
  for (const Shake& shake : shakes_)
    if (shake.initial_velocity == Shake::Start::jump && shake.start > state_.time)
      next = std::min(next, shake.start);
  return next;
}

Event PlanarRun::advance() {
  jump_ = next_jump();
  const Event event = topple::planar::advance(case_.block, shaken(plane_), case_.controls,
                                              std::min(duration_, jump_), state_, step_);
  end(step_, 0, state_, event);
  return event;
}

bool PlanarRun::begin() {
  jump_ = next_jump();
  if (topple::planar::begin(case_.block, shaken(plane_), case_.controls, std::min(duration_, jump_), state_,
                            step_.leg))
    return true;
  end(step_, 0, rested(step_.leg), Event::none);
  return false;
}

template <class P>
void PlanarRun::end(const PackStep<P>& step, int lane, const State& after, Event event) {
  state_ = after, last_ = event;
  observe(step, lane);
  if (state_.time == jump_) state_ = jumped(case_, shakes_, state_);
}
template void PlanarRun::end(const PackStep<double>&, int, const State&, Event);
template void PlanarRun::end(const PackStep<Four>&, int, const State&, Event);

bool PlanarRun::over() const {
  return state_.time >= duration_ || last_ == Event::overturn || last_ == Event::stalled || left_;
}

/// m, x of the middle of the base, given that of the centre of gravity.
double PlanarRun::middle(double centre) const {
  const Block& block = case_.block;
  return centre + lever(step_.leg.known.at(state_.tilt), (block.right - block.left) / 2, -block.height).x;
}

template <class P>
void PlanarRun::observe(const PackStep<P>& step, int lane) {
  const double length = of_lane(step.length, lane);
  const Series<double> tilt = step.solution.tilt.alone(lane);
  // When it first leans further than an angle to that side in the step, s.
  const auto first_beyond = [&](double sense, double angle) {
    const double after = length > 0 ? Falls<double>(length, tilt.degree).first(tilt, -sense, angle) : k_never;
    return after < k_never ? of_lane(step.start, lane).time + after : k_never;
  };
  const auto rocks = [](Mode mode) { return mode != Mode::rest && mode != Mode::slide; };
  if (!lifted_ && (rocks(state_.mode) || rocks(of_lane(step.start, lane).mode)))
    if (const double time = std::min(first_beyond(1, k_uplift_angle), first_beyond(-1, k_uplift_angle));
        time < k_never)
      lifted_ = time;
  const double centre = centre_of_gravity(case_.block, state_, step_.leg.known).x;
  left_ = std::abs(centre) > case_.farthest;
  const double sign = state_.tilt < 0 ? -1 : 1;
  const double critical = critical_[state_.tilt < 0 ? 0 : 1];
  if (sign * state_.tilt <= critical) {
    beyond_since_.reset();
    peak_slide_ = std::max(peak_slide_, std::abs(middle(centre) - middle_at_start_));
  } else if (!beyond_since_) {
    const double time = first_beyond(sign, critical);
    beyond_since_ = time < k_never ? time : state_.time;
  }
}

}  // namespace topple::planar
