// What the bench leaves: a table of all trials, the fronts in Markdown, a chart.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/engines/trial.h"
#include "solver/study/common/chart.h"

namespace topple::bench {

struct Results {
  std::vector<Engine> engines;
  Reference theory;
  std::vector<Trial> trials;
};

/// A row for each case of each trial.
nlohmann::ordered_json rows(const Results& results);

/// Both fronts of each engine, and what each of them takes for some errors.
std::string tables(const Results& results);

/// gnuplot script: error against CPU time per simulated second, a panel for each case.
std::string chart(const Results& results, study::ChartFormat format);

}  // namespace topple::bench
