// Cost of a step of a cabinet on the rungs rigid and elastic, and of many, with the error beside it.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "solver/elastic_basis.h"
#include "solver/overturn.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_step = 1e-3;  // s
constexpr double k_degrees = 180 / k_pi;

/// paper-a's cabinet beside a wall, shaken.
Setup beside_wall(Rung rung, int count) {
  Setup setup;
  setup.model = steel_model();
  setup.model.planes.push_back(ground());
  setup.model.planes.push_back({"wall", Vec3(-0.215, 0, 0), Vec3::UnitX(), 0.09});
  for (int k = 0; k < count; ++k) {
    CabinetSpec spec = tall_cabinet();
    spec.name = "cabinet-" + std::to_string(k);
    spec.at = Vec3(0, 1.5 * k, 0);
    setup.starts.push_back(add_cabinet(setup.model, spec));
    if (rung == Rung::elastic) setup.model.bodies.back().elastic = elastic_basis(setup.model, k);
  }
  setup.parameters.models.assign(count, rung == Rung::rigid     ? BodyModel::rigid
                                        : rung == Rung::elastic ? BodyModel::elastic
                                                                : BodyModel::frame);
  setup.parameters.contact.restitution = 0.5;
  Shake shake;
  shake.amplitude = 1.9;
  shake.frequency = 0.5;
  setup.parameters.shakes.push_back(shake);
  setup.parameters.time_step = k_step;
  return setup;
}

/// Steps through two seconds, over and over.
void steps(benchmark::State& state, Rung rung) {
  const int count = static_cast<int>(state.range(0));
  const Setup setup = beside_wall(rung, count);
  Workspace workspace(setup.model);
  State start = start_state(setup.model, setup.starts);
  if (!settle(setup.model, setup.parameters, start, workspace).ok()) return state.SkipWithError("not settled");
  prepare(setup.model, setup.parameters, start, workspace);
  State now = start;
  std::int64_t taken = 0;
  for (auto _ : state) {
    if (now.time > 2) {
      state.PauseTiming();
      now = start;
      state.ResumeTiming();
    }
    if (!step(setup.model, setup.parameters, now, workspace).ok()) return state.SkipWithError("step failed");
    ++taken;
  }
  state.counters["s/body"] =
      benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["ms/s"] = benchmark::Counter(
      k_step * 1e-3, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(steps, rigid, Rung::rigid)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(steps, elastic, Rung::elastic)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace topple::test

BENCHMARK_MAIN();
