// engines_bench DIR [edges | rooms [ROOM] | tosses DATA]: the same rocking block in every engine that was
// found when this was built, a cabinet on edges beside ODE's box, then rooms of many boxes in topple and
// MuJoCo; or only one of these, or one room, or the measured tosses in a folder of data (topple validate
// tosses). Writes DIR/engines.csv, .svg and .png and DIR/rooms.csv, or DIR/tosses.csv, and prints the tables.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/engines/edges.h"
#include "bench/engines/files.h"
#include "bench/engines/results.h"
#include "bench/engines/rooms.h"
#include "bench/engines/tosses.h"
#include "solver/study/common/gnuplot.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/rows.h"

namespace {

using namespace topple;
using namespace topple::bench;

std::vector<Engine> engines() {
  std::vector<Engine> found{planar_engine(), topple_engine()};
#ifdef WITH_MUJOCO
  found.push_back(mujoco_engine());
#endif
#ifdef WITH_BULLET
  found.push_back(bullet_engine());
#endif
#ifdef WITH_ODE
  found.push_back(ode_engine());
#endif
  return found;
}

void run_block(const std::filesystem::path& folder) {
  Results results{engines(), reference(), {}};
  fmt::print("{}, one core\n", study::processor_name());
  for (const Engine& engine : results.engines)
    fmt::print("{} {}: {}, {} settings\n", engine.name, engine.version, engine.how, engine.grid.size());
  fmt::print(
      "The shaking floor is gravity (-a(t), 0, -g) to MuJoCo, Bullet and ODE, a taken at the middle of each "
      "step, and a [[shake]] to topple.\nThey are used as installed, topple as built.\n");
  fmt::print("Housner without sliding: impacts of free rocking at");
  for (const double impact : results.theory.impacts) fmt::print(" {:.4f}", impact);
  fmt::print(" s; 2 Hz, {:g} gal: {:g} deg at {:.4f} s\n\n", k_amplitudes[std::size(k_amplitudes) - 1],
             k_fall / k_degree, results.theory.falls[std::size(k_amplitudes) - 1]);
  // the engines take turns: other work on the machine meets all of them
  std::vector<std::pair<double, Trial>> order;
  for (int e = 0; e < static_cast<int>(results.engines.size()); ++e) {
    const int count = static_cast<int>(results.engines[e].grid.size());
    for (int k = 0; k < count; ++k) order.push_back({static_cast<double>(k) / count, {e, k, {}, {}}});
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [place, trial] : order) {
    const Setting& setting = results.engines[trial.engine].grid[trial.setting];
    fmt::print(stderr, "\r{:3.0f} % ", 100 * place);
    trial.rocking = free_rocking(setting, results.theory);
    trial.falling = falling(setting, results.theory);
    results.trials.push_back(trial);
  }
  fmt::print(stderr, "\n");
  write(folder / "engines.csv", study::csv_text(rows(results)));
  fmt::print("{}", tables(results));
  std::fflush(stdout);
  write(folder / "engines.svg", study::run_gnuplot(chart(results, study::ChartFormat::svg)));
  write(folder / "engines.png", study::run_gnuplot(chart(results, study::ChartFormat::png)));
}

}  // namespace

int main(int count, char** arguments) {
  const std::string only = count > 2 ? arguments[2] : "";
  const bool only_edges = only == "edges" && count == 3, only_rooms = only == "rooms",
             only_tosses = only == "tosses" && count == 4;
  if (count < 2 || count > 4 || (count > 2 && !only_edges && !only_rooms && !only_tosses)) {
    fmt::print(stderr, "usage: engines_bench DIR [edges | rooms [ROOM] | tosses DATA]\n");
    return 2;
  }
  try {
    const std::filesystem::path folder = arguments[1];
    std::filesystem::create_directories(folder);
    if (only_tosses) {
      run_tosses(folder, arguments[3]);
      return 0;
    }
    if (only.empty()) run_block(folder);
    if (!only_rooms) run_edges();
    if (!only_edges) run_rooms(folder, count > 3 ? arguments[3] : "");
  } catch (const std::exception& error) {
    fmt::print(stderr, "engines_bench: {}\n", error.what());
    return 1;
  }
}
