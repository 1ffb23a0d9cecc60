// engines_bench DIR: the same rocking block in every engine that was found when this was built. Writes
// DIR/engines.csv, .svg and .png and prints the tables.
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/engines/results.h"
#include "solver/study/gnuplot.h"
#include "solver/study/measure.h"
#include "solver/study/rows.h"

namespace {

using namespace topple;
using namespace topple::bench;

std::vector<Engine> engines() {
  std::vector<Engine> found{topple_engine()};
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

void write(const std::filesystem::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file << content;
  if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

void run(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  Results results{engines(), reference(), {}};
  fmt::print("{}, one core\n", study::processor_name());
  for (const Engine& engine : results.engines)
    fmt::print("{} {}: {}, {} settings\n", engine.name, engine.version, engine.how, engine.grid.size());
  fmt::print("Housner without sliding: impacts of free rocking at");
  for (const double impact : results.theory.impacts) fmt::print(" {:.4f}", impact);
  fmt::print(" s; 2 Hz, {:g} gal: {:g} deg at {:.4f} s\n\n", k_amplitudes[std::size(k_amplitudes) - 1],
             k_fall / k_degree, results.theory.falls[std::size(k_amplitudes) - 1]);
  for (int e = 0; e < static_cast<int>(results.engines.size()); ++e)
    for (int s = 0; s < static_cast<int>(results.engines[e].grid.size()); ++s) {
      const Setting& setting = results.engines[e].grid[s];
      fmt::print(stderr, "\r{} {}/{} ", results.engines[e].name, s + 1, results.engines[e].grid.size());
      results.trials.push_back(
          {e, s, free_rocking(setting, results.theory), falling(setting, results.theory)});
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
  if (count != 2) {
    fmt::print(stderr, "usage: engines_bench DIR\n");
    return 2;
  }
  try {
    run(arguments[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "engines_bench: {}\n", error.what());
    return 1;
  }
}
