// Runs a second of planar blocks, alone and in lanes side by side.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <random>

#include "solver/model/accelerogram.h"
#include "solver/planar/planar_lanes.h"

namespace topple::planar {
namespace {

/// 0.37 x 2.1 m.
PlanarCase cabinet() {
  PlanarCase of;
  const double half_base = 0.185, half_height = 1.05;
  of.block.mass = 40;
  of.block.inertia = of.block.mass * (half_base * half_base + half_height * half_height) / 3;
  of.block.left = of.block.right = half_base;
  of.block.height = half_height;
  of.block.static_friction = of.block.kinetic_friction = 0.4;
  of.along = Vec3::UnitX(), of.across = Vec3::UnitY(), of.origin = Vec3::Zero();
  of.farthest = k_never;
  return of;
}

/// 40 s at 100 Hz of noise about 1.5 Hz that swells and dies away, peak 1 m/s^2.
std::shared_ptr<const Accelerogram> record() {
  constexpr double k_interval = 0.01, k_turn = 2 * k_pi * 1.5, k_damping = 0.3;
  std::mt19937 rng(3);
  AccelerogramComponent of;
  of.direction = Vec3::UnitX(), of.interval = k_interval;
  double x = 0, v = 0, peak = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double t = i * k_interval, swell = t < 5 ? t / 5 : t < 15 ? 1 : std::exp((15 - t) / 6);
    const double restoring = k_turn * k_turn * x + 2 * k_damping * k_turn * v;
    v += k_interval * (static_cast<double>(rng()) / 0x1p31 - 1 - restoring), x += k_interval * v;
    of.samples.push_back(swell * restoring);
    peak = std::max(peak, std::abs(of.samples.back()));
  }
  for (double& sample : of.samples) sample /= peak;
  return make_accelerogram({std::move(of)});
}

constexpr int k_runs = 4000;

/// Runs of 20 to 300 gal; of a sine with 0.5 to 1.5 Hz, in no order.
void ensemble(benchmark::State& state, Shake::Kind kind, double duration) {
  const PlanarCase of = cabinet();
  const auto recorded = record();
  const auto make = [&](int i) {
    Shake shake;
    shake.kind = kind, shake.direction = Vec3::UnitX(), shake.record = recorded;
    shake.amplitude = shake.scale = 0.2 + 2.8 * (i * 0.7548776662 - std::floor(i * 0.7548776662));
    shake.frequency = 0.5 + (i * 0.5698402910 - std::floor(i * 0.5698402910));
    return std::make_unique<PlanarRun>(of, std::vector<Shake>{shake}, duration);
  };
  std::clock_t alone = 0, lanes = 0;
  double runs = 0, busy = 0;
  for (auto _ : state) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < k_runs; ++i)
      for (const auto run = make(i); !run->over();) run->advance();
    const std::clock_t middle = std::clock();
    busy = run_in_lanes(
               k_runs, make, [](int, const PlanarRun&) {}, [] { return false; })
               .share();
    lanes += std::clock() - middle, alone += middle - begin, runs += k_runs;
  }
  state.counters["alone_per_s"] = runs * CLOCKS_PER_SEC / static_cast<double>(alone);
  state.counters["in_lanes_per_s"] = runs * CLOCKS_PER_SEC / static_cast<double>(lanes);
  state.counters["ratio"] = static_cast<double>(alone) / static_cast<double>(lanes);
  state.counters["busy"] = busy;
}
BENCHMARK_CAPTURE(ensemble, sine_of_10_s, Shake::Kind::sine, 10)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ensemble, record_of_40_s, Shake::Kind::record, 40)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace topple::planar

BENCHMARK_MAIN();
