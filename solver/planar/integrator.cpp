#include "solver/planar/integrator.h"

#include <array>
#include <cmath>

namespace topple::planar {
namespace {

constexpr int k_most_without_progress = 100;
constexpr double k_together = 1e-12;  // s, within which events count as simultaneous
constexpr double k_margin = 1e-9;     // m/s^2, within which the guards of a block at rest decide

template <class P>
void set_series(const PerLane<P, Leg*>& legs, Series<double> Leg::*of, Series<P>& to) {
  int degree = 0;
  for (int k = 0; k < k_lanes<P>; ++k) degree = std::max(degree, (of_lane(legs, k)->*of).degree);
  for (int i = 0; i <= degree; ++i)
    to[i] = pack_of<P>([&](int k) { return (of_lane(legs, k)->*of).or_zero(i); });
  to.end(degree, pack_of<P>([&](int k) { return (of_lane(legs, k)->*of).last(); }));
}

/// First terms of the motion.
template <class P>
void set_motion(const PerLane<P, Leg*>& legs, Solution<P>& s) {
  set_series(legs, &Leg::horizontal, s.horizontal);
  set_series(legs, &Leg::vertical, s.vertical);
  const auto of_states = [&](double State::*of) {
    return pack_of<P>([&](int k) { return of_lane(legs, k)->start.*of; });
  };
  s.tilt = of_states(&State::tilt), s.rate = of_states(&State::rate);
  s.x = of_states(&State::x), s.x_velocity = of_states(&State::x_velocity);
  s.z = of_states(&State::z), s.z_velocity = of_states(&State::z_velocity);
  const auto levers = per_lane<P>([&](int k) {
    const Leg& leg = *of_lane(legs, k);
    const elementary::SinCos of = leg.known.of;
    return leg.start.mode == Mode::flight ? Lever{of.cosine, of.sine} : lever(*leg.block, leg.start.side, of);
  });
  s.lever_x = pack_of<P>([&](int k) { return of_lane(levers, k).x; });
  s.lever_z = pack_of<P>([&](int k) { return of_lane(levers, k).z; });
}

template <class P>
Coefficients<P> coefficients(const PerLane<P, Leg*>& legs) {
  const auto of_blocks = [&](const auto& value) {
    return pack_of<P>([&](int k) { return value(*of_lane(legs, k)->block, of_lane(legs, k)->start); });
  };
  return {
      of_blocks([](const Block& block, const State&) { return block.inertia_over_mass(); }),
      of_blocks([](const Block& block, const State& state) { return block.kinetic_friction * state.slip; }),
      of_blocks([](const Block& block, const State&) {
        const double widest = std::max(std::abs(block.left), std::abs(block.right));
        return std::sqrt(widest * widest + block.height * block.height);
      })};
}

/// Time in which the rocking after an impact surely comes to an end were the accelerations constant, s: small
/// rises need few terms.
double rise(const Leg& leg) {
  if (leg.start.tilt != 0 || leg.start.rate == 0) return k_never;
  const double turn = edge_forces(leg.situation(), leg.start, leg.start.slip).acceleration;
  return turn * leg.start.rate < 0 ? -4 * leg.start.rate / turn : k_never;
}

template <class P>
PerLane<P, State> states_after(const PackStep<P>& step, P since) {
  const Solution<P>& s = step.solution;
  const P tilt = s.tilt.at(since), rate = s.rate.at(since), x = s.x.at(since),
          x_velocity = s.x_velocity.at(since), z = s.z.at(since), z_velocity = s.z_velocity.at(since);
  return per_lane<P>([&](int k) {
    State state = of_lane(step.start, k);
    state.time += of_lane(since, k);
    state.tilt = of_lane(tilt, k), state.rate = of_lane(rate, k);
    state.x = of_lane(x, k), state.x_velocity = of_lane(x_velocity, k);
    state.z = of_lane(z, k), state.z_velocity = of_lane(z_velocity, k);
    return state;
  });
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

/// Index of the first guard that falls, after which the step ends; -1: none.
template <class P>
P first_guard(PackStep<P>& step, int highest) {
  P first(-1), when = step.length;
  const Falls<P> falls(when, highest);
  for (int i = 0; i < step.guards.count; ++i) {
    const Guard<P>& guard = step.guards.guard[static_cast<std::size_t>(i)];
    const P fall = falls.first(*guard.of, guard.sign, guard.offset);
    const auto sooner = fall <= when - choose(first < P(0), P(0), P(k_together));
    first = choose(sooner, P(i), first), when = choose(sooner, fall, when);
  }
  step.length = when;
  return first;
}

Event event_of(Event event, const State& before, const State& after) {
  const bool slips_on = after.slip != 0 && after.mode == before.mode;
  if (event == Event::stick && slips_on) return Event::reversal;
  if (event == Event::impact && (after.mode == Mode::rest || after.mode == Mode::slide))
    return Event::settled;
  return event;
}

}  // namespace

bool begin(const Block& block, const Floor& floor, const Controls& controls, double until, const State& state,
           Leg& leg) {
  leg.block = &block, leg.controls = &controls;
  leg.floor_end = floor.series(floor.floor, state.time, leg.horizontal, leg.vertical);
  leg.vertical[0] += block.gravity;
  leg.known = leg.known_at_start = {state.tilt, leg.known.at(state.tilt)};
  leg.start = state.undecided ? decided(leg.situation(), state) : state;
  leg.end = std::min(until, leg.floor_end);
  if (leg.start.mode != Mode::rest) return true;
  const double calm = rest_end(block, floor, leg.start, until, leg.floor_end);
  if (calm <= leg.floor_end) return true;
  leg.end = leg.floor_end = calm, leg.without_progress = 0;
  return false;
}

State rested(const Leg& leg) {
  State state = leg.start;
  state.time = leg.end, state.undecided = true;
  return state;
}

template <class P>
PerLane<P, Event> finish(const PerLane<P, Leg*>& legs, int count, PackStep<P>& step,
                         PerLane<P, State>& after) {
  Solution<P>& s = step.solution;
  const auto of_legs = [&](const auto& value) {
    return pack_of<P>([&](int k) { return value(*of_lane(legs, k)); });
  };
  set_motion(legs, s);
  step.start = per_lane<P>([&](int k) { return of_lane(legs, k)->start; });
  Truncation<P> truncation(
      of_legs([](const Leg& leg) { return std::min(leg.end - leg.start.time, leg.controls->longest); }),
      of_legs([](const Leg& leg) { return leg.controls->tolerance * leg.block->gravity; }),
      of_legs([](const Leg& leg) { return leg.controls->order; }));
  const Mode mode = of_lane(legs, 0)->start.mode;
  if (mode == Mode::rock || mode == Mode::slide_rock) truncation.limit(of_legs(rise));
  traits<P>(mode).solve(coefficients<P>(legs), s, truncation);
  step.length = truncation.length();

  step.guards.count = 0;
  const PerLane<P, const Block*> blocks =
      per_lane<P>([&](int k) -> const Block* { return of_lane(legs, k)->block; });
  traits<P>(mode).guard(
      {blocks, step.start, s, of_legs([](const Leg& leg) { return leg.controls->last_tilt; })}, step.guards);
  const P first = first_guard(step, truncation.greatest() + 2);
  after = states_after(step, step.length);
  P horizontal(0), vertical(0), growth(0);
  if (bits(P(0) <= first) != 0) {
    horizontal = s.horizontal.at(step.length), vertical = s.vertical.at(step.length);
    growth = s.horizontal.slope_at(step.length);
  }
  const elementary::SinCosOf<P> turned =
      elementary::sin_cos_of_lanes(pack_of<P>([&](int k) { return of_lane(after, k).tilt; }));

  const auto end = [&](int k) {
    Leg& leg = *of_lane(legs, k);
    State& state = of_lane(after, k);
    const double length = of_lane(step.length, k);
    if (!std::isfinite(length)) return state = leg.start, Event::stalled;
    leg.known = {state.tilt, {of_lane(turned.sine, k), of_lane(turned.cosine, k)}};
    const int fallen = static_cast<int>(of_lane(first, k));
    if (fallen < 0) {
      leg.without_progress = 0;
      if (leg.start.time + length >= leg.end)
        state.time = leg.end, state.undecided = leg.end == leg.floor_end;
      return Event::none;
    }
    leg.without_progress = length > k_together ? 0 : leg.without_progress + 1;
    if (leg.without_progress > k_most_without_progress) return Event::stalled;
    const Guard<P>& guard = step.guards.guard[static_cast<std::size_t>(fallen)];
    const State before = state;
    state =
        guard.next({*leg.block, of_lane(horizontal, k), of_lane(vertical, k), of_lane(growth, k), leg.known},
                   before, of_lane(guard.side, k));
    return event_of(guard.event, before, state);
  };
  PerLane<P, Event> events{};
  for (int k = 0; k < count; ++k) of_lane(events, k) = end(k);
  return events;
}
template Event finish(Leg* const&, int, PackStep<double>&, State&);
template std::array<Event, 4> finish(const std::array<Leg*, 4>&, int, PackStep<Four>&, std::array<State, 4>&);

Event advance(const Block& block, const Floor& floor, const Controls& controls, double until, State& state,
              Step& step) {
  Leg* const leg = &step.leg;
  if (begin(block, floor, controls, until, state, *leg)) return finish<double>(leg, 1, step, state);
  set_motion<double>(leg, step.solution);
  step.start = leg->start, step.length = leg->end - leg->start.time, step.guards.count = 0;
  state = rested(*leg);
  return Event::none;
}

State state_within(const Step& step, double time) {
  State state = states_after<double>(step, time - step.start.time);
  state.time = time;
  return state;
}

}  // namespace topple::planar
