#include <fmt/format.h>

#include "app/study/study.h"
#include "solver/study/common/measure.h"
#include "solver/study/elements/elements.h"
#include "solver/study/elements/elements_chart.h"

namespace topple::app {
namespace {

/// Errors of one quantity and scheme, and the CPU times of the coarsest and the finest, in a line.
std::string elements_table(const study::ElementsStudy& results) {
  std::string text = fmt::format("{:<20}{:<10}{:^54}{:>16}\n{:<30}", "relative error", "",
                                 "elements per member", "CPU time, ms", "");
  for (const int n : study::k_elements_per_member) text += fmt::format("{:>9}", n);
  text += fmt::format("{:>8}{:>8}\n", study::k_elements_per_member[0],
                      *std::rbegin(study::k_elements_per_member));
  constexpr std::size_t k_columns = std::size(study::k_elements_per_member);
  for (std::size_t k = 0; k + k_columns <= results.rows.size(); k += k_columns) {
    const auto row = results.rows.begin() + static_cast<std::ptrdiff_t>(k);
    text += fmt::format("{:<20}{:<10}", row->scheme == k_schemes[0].kind ? row->quantity : "",
                        traits(row->scheme).word);
    for (std::size_t c = 0; c < k_columns; ++c)
      text += row[c].error ? fmt::format("{:>9.1e}", *row[c].error) : fmt::format("{:>9}", row[c].status);
    for (const std::size_t c : {std::size_t{0}, k_columns - 1})
      text += row[c].cpu ? fmt::format("{:>8.2g}", 1e3 * *row[c].cpu) : fmt::format("{:>8}", "");
    text += '\n';
  }
  return text;
}

}  // namespace

const Study k_elements_study = {
    .name = "elements",
    .about = "error of the three schemes against elements and CPU time",
    .takes_scene = false,
    .timed = true,
    .runs = "solutions",
    .solve = [](io::Scene, const StudyOptions& options) -> Solve {
      return [jobs =
                  options.jobs.value_or(1)](const std::function<bool(int done, int of)>& go_on) -> Findings {
        const study::ElementsStudy results = study::study_elements({.jobs = jobs}, go_on);
        return {.title = "Error of three beam schemes against the number of elements and against CPU time",
                .units = {{"error", "1, |computed - reference|/|reference|"}, {"cpu_s", "s"}},
                .settings = {{"cpu_time",
                              fmt::format(
                                  "CPU time of the solving thread for one solution, without reading the "
                                  "scene; mean of the fastest sample of at least {:g} s, of {:g} s in all",
                                  study::k_sample, study::k_timed)}},
                .entries = {{"solved", results.solved},
                            {"of", results.of},
                            {"cases", quantities_as_json(results)},
                            {"rows", rows_as_json(results)}},
                .chart =
                    [results, jobs](const std::string& origin, study::ChartFormat format) {
                      return elements_chart(results, fmt::format("{}; solutions at a time: {}", origin, jobs),
                                            format);
                    },
                .text = elements_table(results),
                .run = results.solved,
                .of = results.of};
      };
    }};

}  // namespace topple::app
