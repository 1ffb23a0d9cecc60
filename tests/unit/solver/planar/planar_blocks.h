// Blocks, floors and runs of the planar block's tests.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "solver/planar/integrator.h"

namespace topple::planar::test {

/// A uniform rectangle of these half sizes, m.
inline Block uniform_block(double half_base, double half_height, double friction) {
  Block block;
  block.mass = 40;
  block.inertia = block.mass * (half_base * half_base + half_height * half_height) / 3;
  block.left = block.right = half_base;
  block.height = half_height;
  block.static_friction = block.kinetic_friction = friction;
  return block;
}

/// Accelerations that do not change, m/s^2.
struct SteadyFloor {
  double horizontal, vertical = 0;
};
inline Floor moved(const SteadyFloor& floor) {
  return {[](const void* of, double, Series<double>& horizontal, Series<double>& vertical) {
            horizontal = static_cast<const SteadyFloor*>(of)->horizontal;
            vertical = static_cast<const SteadyFloor*>(of)->vertical;
            return k_never;
          },
          &floor};
}

inline Shake sine_shake(double amplitude, double frequency, const Vec3& direction = Vec3::UnitX()) {
  Shake shake;
  shake.amplitude = amplitude, shake.frequency = frequency, shake.direction = direction;
  return shake;
}

struct PlanarEvent {
  Event event;
  State before, after;
};
using SeenStep = std::function<void(const Step&)>;

struct PlanarRun {
  State state;
  std::vector<PlanarEvent> events;
  Event last = Event::none;

  bool overturned() const { return last == Event::overturn; }
  const PlanarEvent& first(Event kind) const {
    static const PlanarEvent none{Event::none, {.time = std::nan("")}, {.time = std::nan("")}};
    for (const PlanarEvent& one : events)
      if (one.event == kind) return one;
    return none;
  }
};

/// Until a time, an overturn or so many events.
inline PlanarRun run_planar(const Block& block, const Floor& floor, State start, double until,
                            const Controls& controls = {},
                            std::size_t most_events = std::numeric_limits<std::size_t>::max(),
                            const SeenStep& seen = nullptr) {
  PlanarRun run{start, {}};
  Step step;
  while (run.state.time < until && run.events.size() < most_events) {
    run.last = advance(block, floor, controls, until, run.state, step);
    if (seen) seen(step);
    if (run.last != Event::none)
      run.events.push_back({run.last, state_within(step, step.start.time + step.length), run.state});
    if (run.last == Event::overturn || run.last == Event::stalled) break;
  }
  return run;
}

}  // namespace topple::planar::test
