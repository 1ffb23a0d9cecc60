#include "solver/planar/floor_exchange.h"

#include <algorithm>
#include <cmath>

namespace topple::planar {
namespace {

/// Integral of a product over the step, up to the degree to which the velocity is known.
double integral(const Series<double>& a, const Series<double>& velocity, double length) {
  const bool shorter = a.degree < velocity.degree;
  const Series<double>&high = shorter ? velocity : a, &low = shorter ? a : velocity;
  double sum = 0, power = length;
  for (int i = 0; i <= velocity.degree; ++i, power *= length)
    sum += power * k_reciprocal[static_cast<std::size_t>(i + 1)] * product_term(high, low, i, low.degree);
  return sum;
}

/// Of the centre of gravity, along one axis.
Series<double> centre_velocity(const Step& step, Series<double> Solution<double>::*velocity,
                               Series<double> Solution<double>::*lever) {
  const Series<double>&reference = step.solution.*velocity, &arm = step.solution.*lever;
  if (step.start.mode == Mode::slide || step.start.mode == Mode::flight) return reference;
  Series<double> to;
  to.degree = std::max({reference.degree, arm.degree - 1, 0});
  for (int i = 0; i <= to.degree; ++i) to[i] = reference.or_zero(i) - (i + 1) * arm.or_zero(i + 1);
  return to;
}

}  // namespace

FloorForces floor_forces(const Situation& now, const State& given) {
  const State state = given.undecided ? decided(now, given) : given;
  const Block& block = now.block;
  FloorForces f;
  if (state.mode == Mode::flight) return f;
  if (state.mode == Mode::rock || state.mode == Mode::slide_rock) {
    const EdgeForces on_edge = edge_forces(now, state, state.slip);
    return {on_edge.tangential, on_edge.normal, state.side == Side::right ? 1. : 0.};
  }
  f.normal = now.vertical;
  f.tangential =
      state.mode == Mode::rest ? now.horizontal : -block.kinetic_friction * state.slip * now.vertical;
  const double place = f.normal > 0 ? -block.height * f.tangential / f.normal : 0;
  f.right = std::clamp((place + block.left) / (block.left + block.right), 0., 1.);
  return f;
}

double kinetic_energy(const Block& block, const State& state, const Turned& known) {
  const Motion v = centre_of_gravity(block, state, known);
  return (v.x_velocity * v.x_velocity + v.z_velocity * v.z_velocity +
          block.inertia_over_mass() * state.rate * state.rate) /
         2;
}

void add_exchange(const Block& block, const State& before, const Step& step, const State& after, Event event,
                  Exchanged& sum) {
  const Solution<double>& s = step.solution;
  const Turned &at_start = step.leg.known_at_start, &at_end = step.leg.known;
  if (before.undecided || event != Event::none) {
    const State end = state_within(step, step.start.time + step.length);
    // at a lift from the floor, which had bent the springs
    const auto exchange = [&](const State& from, const State& to, const Turned& known) {
      const double gain = kinetic_energy(block, to, known) - kinetic_energy(block, from, known);
      const bool lifts = from.mode == Mode::rest && to.mode == Mode::rock;
      (lifts ? sum.input : sum.impact) += lifts ? gain : -gain;
    };
    exchange(before, step.start, at_start);
    exchange(end, after, at_end);
  }
  sum.gravity += block.gravity *
                 (centre_of_gravity(block, after, at_end).z - centre_of_gravity(block, before, at_start).z);
  if (step.start.mode == Mode::rest || step.length == 0) return;
  using Parts = Solution<double>;
  sum.input -=
      integral(s.horizontal, centre_velocity(step, &Parts::x_velocity, &Parts::lever_x), step.length);
  Series<double> upward = s.vertical;
  upward[0] -= block.gravity;
  if (upward.degree > 0 || upward[0] != 0)
    sum.input -= integral(upward, centre_velocity(step, &Parts::z_velocity, &Parts::lever_z), step.length);
  if (step.start.slip == 0) return;
  const Series<double>& normal = step.start.mode == Mode::slide ? s.vertical : s.normal;
  sum.friction += block.kinetic_friction * step.start.slip * integral(normal, s.x_velocity, step.length);
}

}  // namespace topple::planar
