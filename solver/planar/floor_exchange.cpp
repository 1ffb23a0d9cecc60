#include "solver/planar/floor_exchange.h"

#include <algorithm>
#include <cmath>

namespace topple::planar {
namespace {

constexpr auto k_one_over = [] {  // 1/(1 + i)
  std::array<double, 2 * k_terms> of{};
  for (std::size_t i = 0; i < of.size(); ++i) of[i] = 1. / static_cast<double>(i + 1);
  return of;
}();

/// Integral of a product over the step.
double integral(const Series<double>& a, const Series<double>& b, double length) {
  std::array<double, k_terms> scaled;
  double power = length;
  for (int i = 0; i <= a.degree; ++i, power *= length) scaled[static_cast<std::size_t>(i)] = a[i] * power;
  double sum = 0;
  power = 1;
  for (int j = 0; j <= b.degree; ++j, power *= length) {
    double inner = 0;
    for (int i = 0; i <= a.degree; ++i)
      inner += scaled[static_cast<std::size_t>(i)] * k_one_over[static_cast<std::size_t>(i + j)];
    sum += b[j] * power * inner;
  }
  return sum;
}

Series<double> derivative(const Series<double>& of) {
  Series<double> to(0);
  to.degree = std::max(of.degree - 1, 0);
  for (int i = 1; i <= of.degree; ++i) to[i - 1] = i * of[i];
  return to;
}

/// a - b
Series<double> difference(const Series<double>& a, const Series<double>& b) {
  Series<double> to;
  to.degree = std::max(a.degree, b.degree);
  for (int i = 0; i <= to.degree; ++i) to[i] = a.or_zero(i) - b.or_zero(i);
  return to;
}

struct Velocity {
  Series<double> x, z;
};
/// Of the centre of gravity.
Velocity centre_velocity(const Step& step) {
  const Solution<double>& s = step.solution;
  switch (step.start.mode) {
    case Mode::rest:
      return {Series<double>(0), Series<double>(0)};
    case Mode::slide:
      return {s.x_velocity, Series<double>(0)};
    case Mode::flight:
      return {s.x_velocity, s.z_velocity};
    case Mode::rock:
    case Mode::slide_rock:
      break;
  }
  return {difference(s.x_velocity, derivative(s.lever_x)),
          difference(Series<double>(0), derivative(s.lever_z))};
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

double kinetic_energy(const Block& block, const State& state) {
  const Motion v = centre_of_gravity(block, state);
  return (v.x_velocity * v.x_velocity + v.z_velocity * v.z_velocity +
          block.inertia_over_mass() * state.rate * state.rate) /
         2;
}

void add_exchange(const Block& block, const State& before, const Step& step, const State& after,
                  Exchanged& sum) {
  const Solution<double>& s = step.solution;
  const State end = state_within(step, step.start.time + step.length);
  sum.impact += kinetic_energy(block, before) - kinetic_energy(block, step.start) +
                kinetic_energy(block, end) - kinetic_energy(block, after);
  sum.gravity += block.gravity * (centre_of_gravity(block, after).z - centre_of_gravity(block, before).z);
  if (step.start.mode == Mode::rest || step.length == 0) return;
  const Velocity v = centre_velocity(step);
  Series<double> upward = s.vertical;
  upward[0] -= block.gravity;
  sum.input -= integral(s.horizontal, v.x, step.length) + integral(upward, v.z, step.length);
  if (step.start.slip == 0) return;
  const Series<double>& normal = step.start.mode == Mode::slide ? s.vertical : s.normal;
  sum.friction += block.kinetic_friction * step.start.slip * integral(normal, s.x_velocity, step.length);
}

}  // namespace topple::planar
