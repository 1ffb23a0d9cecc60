#include "solver/planar/integrator.h"

#include <array>
#include <cmath>

namespace topple::planar {
namespace {

constexpr int k_most_without_progress = 100;
constexpr double k_together = 1e-12;  // s, within which events count as simultaneous
constexpr double k_margin = 1e-9;     // m/s^2, within which the guards of a block at rest decide

/// First terms of the motion.
void set_motion(const Block& block, const State& state, Solution<double>& s) {
  s.tilt = state.tilt, s.rate = state.rate;
  s.x = state.x, s.x_velocity = state.x_velocity;
  s.z = state.z, s.z_velocity = state.z_velocity;
  const bool flies = state.mode == Mode::flight;
  const Lever r = flies ? lever(-state.tilt, 1, 0) : lever(block, state.side, state.tilt);
  s.lever_x = r.x, s.lever_z = r.z;
}

Coefficients<double> coefficients(const Block& block, const State& state) {
  const double widest = std::max(std::abs(block.left), std::abs(block.right));
  return {block.inertia_over_mass(), block.kinetic_friction * state.slip,
          std::sqrt(widest * widest + block.height * block.height)};
}

/// Time in which the rocking after an impact surely comes to an end were the accelerations constant, s: small
/// rises need few terms.
double rise(const Situation& now, const State& state) {
  if (state.tilt != 0 || state.rate == 0) return k_never;
  const double turn = edge_forces(now, state, state.slip).acceleration;
  return turn * state.rate < 0 ? -4 * state.rate / turn : k_never;
}

State state_after(const Step& step, double since) {
  const Solution<double>& s = step.solution;
  State state = step.start;
  state.time += since;
  state.tilt = s.tilt.at(since), state.rate = s.rate.at(since);
  state.x = s.x.at(since), state.x_velocity = s.x_velocity.at(since);
  state.z = s.z.at(since), state.z_velocity = s.z_velocity.at(since);
  return state;
}

/// A kink of the floor up to which nothing wakes a block that rests, s; that of the series where none is
/// known.
double rest_end(const Block& block, const Floor& floor, const State& state, double until, double floor_end) {
  if (!floor.quiet || floor_end >= until) return floor_end;
  const double g = block.gravity, h = block.height, mu = block.static_friction;
  const std::array<FloorSign, 5> signs{{{0, 1, g - k_margin},
                                        {h, block.right, block.right * g - h * k_margin},
                                        {-h, block.left, block.left * g - h * k_margin},
                                        {1, mu, mu * g - k_margin},
                                        {-1, mu, mu * g - k_margin}}};
  return std::max(floor_end, floor.quiet(floor.floor, state.time, until, signs));
}

const Guard* first_guard(Step& step, int highest) {
  const Guard* first = nullptr;
  double when = step.length;
  const Falls falls(when, highest);
  for (int i = 0; i < step.guards.count; ++i) {
    const Guard& guard = step.guards.guard[static_cast<std::size_t>(i)];
    const double fall = falls.first(*guard.of, guard.sign, guard.offset);
    if (fall <= when - (first ? k_together : 0)) first = &guard, when = fall;
  }
  step.length = when;
  return first;
}

Event event_of(const Guard& guard, const State& before, const State& after) {
  const bool slips_on = after.slip != 0 && after.mode == before.mode;
  if (guard.event == Event::stick && slips_on) return Event::reversal;
  if (guard.event == Event::impact && (after.mode == Mode::rest || after.mode == Mode::slide))
    return Event::settled;
  return guard.event;
}

}  // namespace

Event advance(const Block& block, const Floor& floor, const Controls& controls, double until, State& state,
              Step& step) {
  Solution<double>& s = step.solution;
  step.floor_end = floor.series(floor.floor, state.time, s.horizontal, s.vertical);
  s.vertical[0] += block.gravity;
  const Situation start{block, s.horizontal[0], s.vertical[0]};
  if (state.undecided) state = decided(start, state);
  step.start = state;
  set_motion(block, state, s);
  if (state.mode == Mode::rest) {
    if (const double calm = rest_end(block, floor, state, until, step.floor_end); calm > step.floor_end) {
      step.floor_end = calm, step.length = calm - state.time, step.guards.count = 0,
      step.without_progress = 0;
      state.time = calm, state.undecided = true;
      return Event::none;
    }
  }

  const double end = std::min(until, step.floor_end);
  Truncation truncation(std::min(end - state.time, controls.longest), controls.tolerance * block.gravity,
                        controls.order);
  if (state.mode == Mode::rock || state.mode == Mode::slide_rock) truncation.limit(rise(start, state));
  const ModeTraits& mode = traits(state.mode);
  mode.solve(coefficients(block, state), s, truncation);
  step.length = truncation.length();

  step.guards.count = 0;
  mode.guard({block, state, s, controls.last_tilt}, step.guards);
  const Guard* guard = first_guard(step, truncation.last() + 2);
  if (!std::isfinite(step.length)) return Event::stalled;
  const bool at_end = !guard && state.time + step.length >= end;
  state = state_after(step, step.length);
  if (at_end) state.time = end, state.undecided = end == step.floor_end;
  if (!guard) return step.without_progress = 0, Event::none;

  step.without_progress = step.length > k_together ? 0 : step.without_progress + 1;
  if (step.without_progress > k_most_without_progress) return Event::stalled;
  const Situation now{block, s.horizontal.at(step.length), s.vertical.at(step.length)};
  const State before = state;
  state = guard->next(now, before, guard->side);
  return event_of(*guard, before, state);
}

State state_within(const Step& step, double time) {
  State state = state_after(step, time - step.start.time);
  state.time = time;
  return state;
}

}  // namespace topple::planar
