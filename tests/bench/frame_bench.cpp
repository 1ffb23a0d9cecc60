// Cost of a step of a frame of 36 elements, explicit and implicit, with the error that it makes beside it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "solver/body_system.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_implicit_step = 1e-3;  // s
constexpr double k_explicit_share = 0.9;  // of the greatest stable step

/// Twelve edges and one diagonal in each face, two elements each: 36 elements, 26 nodes that all may touch
/// the floor under them.
Setup box(double amplitude) {
  Setup setup;
  setup.model = steel_model();
  FrameSpec spec;
  spec.name = "box";
  spec.mass = 40;
  const Vec3 size(0.38, 0.88, 1.79);
  for (int corner = 0; corner < 8; ++corner)
    spec.nodes.emplace_back((corner & 1) * size.x(), (corner >> 1 & 1) * size.y(),
                            0.03 + (corner >> 2 & 1) * size.z());
  const int lines[18][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4},
                            {1, 5}, {2, 6}, {3, 7}, {0, 3}, {4, 7}, {0, 5}, {2, 7}, {0, 6}, {1, 7}};
  for (const auto& line : lines) spec.members.push_back({{line[0], line[1]}, 0, 0});
  setup.starts = add_frame(setup.model, spec);
  setup.model.planes.push_back(ground(0));
  // rotary inertia as an explicit step asks for it
  for (Mat3& inertia : setup.model.node_inertia) inertia += 2e-3 * Mat3::Identity();
  if (amplitude > 0) shake(setup, amplitude, 1);
  return setup;
}

Simulation start(const Setup& setup) {
  return Simulation(setup.model, setup.starts, setup.parameters, true);
}

double greatest_distance(const State& a, const State& b) {
  double greatest = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    greatest = std::max(greatest, (a.position[i] - b.position[i]).norm());
  return greatest;
}

State after(const Setup& setup, double duration, double h) {
  Simulation sim = start(setup);
  sim.parameters.time_step = h;
  sim.advance(static_cast<int>(std::lround(duration / h)));
  return sim.state;
}

/// Multiply-adds on ten independent vectors of four, flops a second.
double measured_peak() {
  using Four = double __attribute__((vector_size(32)));
  constexpr int k_rounds = 2000000, k_lanes = 10;
  Four x[k_lanes];
  for (int k = 0; k < k_lanes; ++k) x[k] = Four{1. + k, 2, 3, 4};
  Four a{0.999, 0.998, 0.997, 0.996}, b{1e-3, 2e-3, 3e-3, 4e-3};
  double best = 0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    benchmark::DoNotOptimize(a);
    const auto from = std::chrono::steady_clock::now();
    for (int round = 0; round < k_rounds; ++round)
#pragma GCC unroll 10
      for (int k = 0; k < k_lanes; ++k) x[k] = Four(__builtin_ia32_vfmaddpd256(x[k], a, b));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
    for (Four& v : x) benchmark::DoNotOptimize(v);
    best = std::max(best, 8. * k_lanes * k_rounds / took.count());
  }
  return best;
}

/// Steps from rest under a floor that moves with `amplitude` gal.
void explicit_step(benchmark::State& bench) {
  constexpr int k_steps = 2000;
  Setup setup = box(bench.range(0) * k_gal);
  setup.parameters.integrator = Integrator::central_difference;
  BodySystem system(setup.model, 0);
  Simulation first = start(setup);
  first.parameters.time_step = 1e-9;
  first.advance();
  const double h = setup.parameters.time_step = k_explicit_share * *explicit_limit(first.workspace());
  const int begin = static_cast<int>(0.3 / h);
  Simulation sim = start(setup);
  sim.advance(begin);
  const State state = sim.state;
  std::size_t touching = 0;
  for (auto _ : bench) {
    sim.state = state;
    sim.advance(k_steps);
    touching += sim.contacts().size();
  }
  const double end = (begin + k_steps) * h;
  bench.counters["s/step"] = benchmark::Counter(
      k_steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  bench.counters["step"] = h;
  bench.counters["touching"] = static_cast<double>(touching) / bench.iterations();
  bench.counters["balance"] = sim.state.energy.balance_error();
  Simulation fine = start(setup);
  fine.parameters.time_step = h / 2;
  fine.advance(2 * (begin + k_steps));
  bench.counters["error_m"] = greatest_distance(sim.state, fine.state);
  bench.counters["time"] = end;
}
BENCHMARK(explicit_step)->Arg(0)->Arg(400)->Unit(benchmark::kMillisecond);

/// One simulated second from rest likewise; a factorisation and a solution of the same matrix beside it.
void implicit_second(benchmark::State& bench) {
  Setup setup = box(bench.range(0) * k_gal);
  const int steps = static_cast<int>(std::lround(1 / k_implicit_step));
  setup.parameters.time_step = k_implicit_step;
  Simulation sim = start(setup);
  const State state = sim.state;
  int iterations = 0;
  for (auto _ : bench) {
    sim.state = state;
    iterations = 0;
    for (int i = 0; i < steps; ++i) iterations += sim.advance().newton_iterations;
  }
  bench.counters["s/step"] =
      benchmark::Counter(steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  bench.counters["iterations"] = static_cast<double>(iterations) / steps;
  bench.counters["touching"] = static_cast<double>(sim.contacts().size());
  bench.counters["balance"] = sim.state.energy.balance_error();
  bench.counters["error_m"] = greatest_distance(sim.state, after(setup, 1, k_implicit_step / 8));
}
BENCHMARK(implicit_second)->Arg(0)->Arg(400)->Unit(benchmark::kMillisecond);

void factor_and_solve(benchmark::State& bench) {
  const Setup setup = box(0);
  Simulation sim = start(setup);
  BodySystem system(setup.model, 0);
  BodyMotion motion;
  system.load(sim.state, motion);
  std::vector<double> b(6 * system.count, 1.);
  double forming = 0;
  for (auto _ : bench) {
    const auto from = std::chrono::steady_clock::now();
    system.lu.set_zero();
    system.evaluate_with_tangent(sim.parameters, 0, motion, sim.state.stick, motion.position, 0);
    for (int i = 0; i < system.count; ++i) system.lu.add(i, i, Mat6(1e6 * Mat6::Identity()));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
    forming += took.count();
    bench.SetIterationTime(0);
    const auto begin = std::chrono::steady_clock::now();
    system.lu.factor();
    system.lu.solve(b.data());
    const std::chrono::duration<double> solving = std::chrono::steady_clock::now() - begin;
    bench.SetIterationTime(solving.count());
  }
  bench.counters["forming"] = forming / bench.iterations();
}
BENCHMARK(factor_and_solve)->UseManualTime()->Unit(benchmark::kMicrosecond);

void peak(benchmark::State& bench) {
  for (auto _ : bench) bench.counters["flops/s"] = measured_peak();
}
BENCHMARK(peak)->Iterations(1);

}  // namespace
}  // namespace topple::test

BENCHMARK_MAIN();
