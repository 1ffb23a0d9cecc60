// Cost of looking for elements that may touch, per body: the same from one cabinet to a thousand.
#include <benchmark/benchmark.h>

#include <cmath>

#include "solver/contact/proximity.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

/// Cabinets in square rows, 30 mm apart.
Model warehouse(int count) {
  Model model = steel_model();
  const int row = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int k = 0; k < count; ++k) {
    CabinetSpec spec = tall_cabinet();
    spec.name = "cabinet-" + std::to_string(k);
    spec.at = Vec3(0.44 * (k % row), 0.94 * (k / row), 0);
    add_cabinet(model, spec);
  }
  return model;
}

void near_elements_of(benchmark::State& state) {
  const Model model = warehouse(static_cast<int>(state.range(0)));
  NearSearch search(model);
  std::size_t pairs = 0;
  for (auto _ : state) pairs = search.find(model.node_position, 0.05).size();
  state.counters["pairs"] = static_cast<double>(pairs);
  state.counters["s/body"] =
      benchmark::Counter(static_cast<double>(state.range(0)),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(near_elements_of)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace topple::test

BENCHMARK_MAIN();
