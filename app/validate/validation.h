// The comparisons of `topple validate` with what others measured, each a row of one table.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/study/sweep.h"
#include "solver/study/common/chart.h"
#include "solver/study/validate/data_table.h"

namespace topple::app {

struct ValidationOptions {
  std::string kind, data;   ///< of a row of the table; the user's folder, empty: none was named
  std::string folder;       ///< of the results, created when missing
  std::string fit;          ///< file that an earlier call wrote; empty: fits here
  std::optional<int> jobs;  ///< runs at a time; absent: one per core
  bool keep_going = false;  ///< leaves bad files out
  bool resume = false, quiet = false, force = false;
};

/// What a comparison found out.
struct Comparison {
  using Json = nlohmann::ordered_json;
  std::string title;
  Json entries = Json::object(), rows = Json::array();
  study::Skipped skipped = {};
  /// gnuplot script. `origin`: version and machine.
  std::function<std::string(const std::string& origin, study::ChartFormat format)> chart;
  std::string page;              ///< HTML of its sections; k_chart_here is where the chart comes
  std::string text;              ///< for a person
  std::optional<Json> fit = {};  ///< of what was fitted here
};
inline constexpr const char* k_chart_here = "<!-- chart -->";

struct Validation {
  const char *name, *about;
  const char* source;  ///< where the data are from, by whom, under which licence
  bool needs_data, takes_fit;
  /// None: interrupted. Throws io::InputError on data of another form.
  std::optional<Comparison> (*compare)(const ValidationOptions& options, const std::string& stem);
};

// In NAME_validation.cpp.
extern const Validation k_granite_validation, k_tosses_validation, k_furniture_validation;

/// In the order of --help.
inline constexpr const Validation* k_validations[] = {&k_granite_validation, &k_tosses_validation,
                                                      &k_furniture_validation};

/// Runs cases as of a sweep, rows kept in STEM.rows. None: interrupted. `label`: of the progress bar.
std::optional<std::vector<std::string>> run_cases(const ValidationOptions& options, const std::string& label,
                                                  const std::string& stem, nlohmann::ordered_json settings,
                                                  int count, const MakeWork& make);

/// Compares and writes DIR/KIND.csv, .json, .svg, .png, .html, and fit.json where it fitted. Returns the exit
/// code.
int carry_out(const Validation& validation, const ValidationOptions& options);

}  // namespace topple::app
