#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/cli/study_commands.h"
#include "app/study/study_results.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "solver/study/common/measure.h"
#include "solver/study/elements/elements.h"
#include "solver/study/elements/elements_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

ordered_json document(const study::ElementsStudy& results, const StudyOptions& options, double wall_s) {
  return {
      {"topple", TOPPLE_VERSION},
      {"schema", 1},
      {"study", "elements"},
      {"title", "Error of three beam schemes against the number of elements and against CPU time"},
      {"units", {{"error", "1, |computed - reference|/|reference|"}, {"cpu_s", "s"}, {"wall_s", "s"}}},
      {"machine", machine_json()},
      {"settings",
       {{"jobs", options.jobs.value_or(1)},
        {"quick", options.quick},
        {"cpu_time",
         fmt::format("CPU time of the solving thread for one solution, without reading the scene; mean of "
                     "the fastest sample of at least {:g} s, of {:g} s in all",
                     study::k_sample, study::k_timed)}}},
      {"solved", results.solved},
      {"of", results.of},
      {"wall_s", wall_s},
      {"cases", quantities_as_json(results)},
      {"rows", rows_as_json(results)}};
}

/// Errors of one quantity and scheme, and the CPU times of the coarsest and the finest, in a line.
std::string table(const study::ElementsStudy& results) {
  std::string text = fmt::format("{:<20}{:<10}{:^54}{:>16}\n{:<30}", "relative error", "",
                                 "elements per member", "CPU time, ms", "");
  for (const int n : study::k_elements_per_member) text += fmt::format("{:>9}", n);
  text += fmt::format("{:>8}{:>8}\n", study::k_elements_per_member[0],
                      *std::rbegin(study::k_elements_per_member));
  constexpr std::size_t k_columns = std::size(study::k_elements_per_member);
  for (std::size_t k = 0; k + k_columns <= results.rows.size(); k += k_columns) {
    const auto row = results.rows.begin() + static_cast<std::ptrdiff_t>(k);
    text += fmt::format("{:<20}{:<10}", row->scheme == study::k_schemes[0] ? row->quantity : "",
                        study::scheme_name(row->scheme));
    for (std::size_t c = 0; c < k_columns; ++c)
      text += row[c].error ? fmt::format("{:>9.1e}", *row[c].error) : fmt::format("{:>9}", row[c].status);
    for (const std::size_t c : {std::size_t{0}, k_columns - 1})
      text += row[c].cpu ? fmt::format("{:>8.2g}", 1e3 * *row[c].cpu) : fmt::format("{:>8}", "");
    text += '\n';
  }
  return text;
}

}  // namespace

int elements_command(const StudyOptions& options) {
  const std::string stem = place_for_results(options.folder, "elements");
  defer_interrupts();
  const auto start = Clock::now();
  std::optional<Progress> progress;
  const study::ElementsStudy results =
      study::study_elements({.jobs = options.jobs.value_or(1)}, [&](int done, int of) {
        if (!progress) progress.emplace("study elements", "solutions", of, options.quiet);
        progress->update(done);
        return !interrupted() && !(options.quick && seconds_since(start) > k_quick);
      });
  progress.reset();
  if (interrupted()) {
    say("interrupted before every case had run");
    return k_interrupted;
  }
  const double wall_s = seconds_since(start);
  const ordered_json json = document(results, options, wall_s);
  const std::string origin =
      fmt::format("{}; solutions at a time: {}", origin_text(), options.jobs.value_or(1));
  write_study(stem, json["rows"], json,
              [&](study::ChartFormat format) { return elements_chart(results, origin, format); });
  const char* const covered = !options.quick                 ? ""
                              : results.solved == results.of ? ": --quick left nothing out"
                                                             : ": --quick left out the finest";
  fmt::print("{}{} of {} solutions in {:.1f} s{}\n{}.csv, .json, .svg, .png\n", table(results),
             results.solved, results.of, wall_s, covered, stem);
  return k_done;
}

}  // namespace topple::app
