#include "bench/engines/edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "bench/engines/block.h"
#include "solver/study/common/measure.h"

namespace topple::bench {
namespace {

constexpr double k_step = 1e-3, k_fine_step = 1e-4;  // s
constexpr double k_seconds = 20;                     // simulated
constexpr int k_turns = 9;
constexpr double k_frequencies[] = {1.5, 2};  // Hz
constexpr double k_amplitude = 3;             // m/s^2

struct Row {
  const char* name;
  Setting setting;
  double least = std::numeric_limits<double>::infinity();  ///< s, of a step
};

double peak(const Setting& setting, const Case& c) {
  const Simulation simulation = setting.start(c);
  double most = 0;
  for (double time = 0; time < k_seconds;) {
    time = simulation.advance();
    most = std::max(most, std::abs(simulation.tilt()));
  }
  return most;
}

double step_time(const Setting& setting, const Case& c) {
  const Simulation simulation = setting.start(c);
  double time = 0;
  return study::cpu_time_of(
             [&] {
               while (time < k_seconds) time = simulation.advance();
             },
             0) *
         k_step / k_seconds;
}

}  // namespace

void run_edges() {
  std::vector<Row> rows{{"topple", cabinet_on_edges(k_step, "")},
                        {"topple, rigid", cabinet_on_edges(k_step, "model = \"rigid\"\n")}};
#ifdef WITH_ODE
  rows.push_back({"ODE", ode_box(k_step)});
#endif
  for (int turn = 0; turn < k_turns; ++turn)
    for (Row& row : rows) row.least = std::min(row.least, step_time(row.setting, {0, k_amplitude, 2}));
  const Setting frame = cabinet_on_edges(k_fine_step, "model = \"frame\"\n");
  fmt::print(
      "\nA cabinet on edges, {:g} gal, steps of {:g} ms: time of a step at 2 Hz, peak tilt beside a "
      "frame's\n",
      k_amplitude / k_gal, 1e3 * k_step);
  for (const Row& row : rows) {
    fmt::print("{:14} {:.2f} us", row.name, 1e6 * row.least);
    for (const double frequency : k_frequencies) {
      const Case c{0, k_amplitude, frequency};
      fmt::print(", {:g} Hz: {:.3f} deg for {:.3f}", frequency, peak(row.setting, c) / k_degree,
                 peak(frame, c) / k_degree);
    }
    fmt::print("\n");
  }
}

}  // namespace topple::bench
