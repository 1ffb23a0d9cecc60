// What the studies of the command line have in common: their files and their clock.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "solver/io/host/staged_file.h"
#include "solver/study/common/chart.h"

namespace topple::app {

/// s of the 40 that --quick has; the rest is for the charts, and for runs under way that are not given up.
inline constexpr double k_quick = 34;

/// DIR/KIND, to which the extensions are added. Creates the folder; throws BadInput unless the results can be
/// put there. `force`: in place of files of any kind.
std::string place_for_results(const std::string& folder, const std::string& kind, bool force);

/// "topple 0.1.0 on AMD EPYC 7763, 2 cores", for charts.
std::string origin_text();

/// "machine" of a study's JSON.
nlohmann::ordered_json machine_json();

/// Writes STEM.csv (of `rows`), .json, .svg and .png, numbers first: they stand even where no chart can be
/// drawn. `script`: the chart for gnuplot.
void write_study(const host::Target& stem, const nlohmann::ordered_json& rows,
                 const nlohmann::ordered_json& document,
                 const std::function<std::string(study::ChartFormat)>& script);

}  // namespace topple::app
