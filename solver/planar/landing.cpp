#include "solver/planar/landing.h"

#include <cmath>

namespace topple::planar {
namespace {

constexpr int k_steps = 200;  // in the time in which the edge would sink by 1 m at its first speed
constexpr int k_most_steps = 20 * k_steps;

}  // namespace

// Of mass 1, on points that bear depth^q each, at a rate for which depths come to about 1 m. `x`: from below
// the centre of gravity, away from the edge that lands, which lies at -u; the other one at `far`.
double landing_factor(const Block& block, Side side, std::span<const BaseLine> base, double q) {
  const double sign = side == Side::right ? -1 : 1, u = -sign * block.edge(side),
               far = block.left + block.right - u;
  // about the middle of the base, which friction holds
  const double inertia = block.inertia_over_mass() + block.height * block.height, kept = inertia - u * far;
  if (base.size() < 3 || !(kept > 0)) return 1;
  const BaseLine& edge = side == Side::right ? base.back() : base.front();
  const double on_edge = static_cast<double>(edge.points.size()),
               speed = std::sqrt(2 * on_edge * (1 + u * u / inertia) / (q + 1)), h = 1 / (speed * k_steps);
  const double rate0 = speed / (u + far);
  double velocity = -far * rate0, rate = rate0;  // of the base below the centre of gravity, upward
  double rise = 0, turn = 0;
  bool sinks = true;
  for (int step = 0; sinks && step < k_most_steps; ++step) {
    rise += h / 2 * velocity;
    turn += h / 2 * rate;
    double force = 0, moment = 0;
    sinks = false;
    for (const BaseLine& line : base) {
      const double x = sign * line.place, depth = -(rise + x * turn);
      if (!(depth > 0) || !(velocity + x * rate < 0)) continue;
      const double bears =
          static_cast<double>(line.points.size()) * (q == 1 ? depth : elementary::pow(depth, q));
      force += bears;
      moment += x * bears;
      sinks = true;
    }
    velocity += h * force;
    rate += h / inertia * moment;
    rise += h / 2 * velocity;
    turn += h / 2 * rate;
  }
  return (inertia * rate + u * velocity) / (kept * rate0);
}

}  // namespace topple::planar
