#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/files.h"
#include "app/interrupt.h"
#include "app/log.h"
#include "app/progress.h"
#include "app/summary.h"
#include "solver/study/elements.h"
#include "solver/study/elements_chart.h"
#include "solver/study/gnuplot.h"
#include "solver/study/measure.h"
#include "solver/study/rows.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

// s of the 40 that --quick has; the rest is for the solutions that are under way then, and for the charts.
constexpr double k_quick = 34;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

ordered_json document(const study::ElementsStudy& results, const StudyOptions& options, double wall_s) {
  return {
      {"topple", TOPPLE_VERSION},
      {"schema", 1},
      {"study", "elements"},
      {"title", "Error of three beam schemes against the number of elements and against CPU time"},
      {"units", {{"error", "1, |computed - reference|/|reference|"}, {"cpu_s", "s"}, {"wall_s", "s"}}},
      {"machine", {{"processor", study::processor_name()}, {"cores", study::core_count()}}},
      {"settings",
       {{"jobs", options.jobs},
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

/// Creates the folder; throws BadInput unless the results can be put there.
void require_place_for_results(const std::string& folder, const std::string& stem) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw BadInput(folder + ": cannot be created: " + error.message());
  for (const char* extension : {".csv", ".json", ".svg", ".png"})
    require_writable_file("--output", stem + extension, "");
}

/// Numbers first: they stand even where no chart can be drawn.
void write_results(const study::ElementsStudy& results, const ordered_json& json, const std::string& stem) {
  write_whole_file(stem + ".csv", study::csv_text(json["rows"]));
  write_whole_file(stem + ".json", json_text(json, 2) + "\n");
  const std::string origin =
      fmt::format("topple {} on {}, {} cores; solutions at a time: {}", TOPPLE_VERSION,
                  study::processor_name(), study::core_count(), json["settings"]["jobs"].get<int>());
  const auto draw = [&](const char* extension, study::ChartFormat format) {
    try {
      write_whole_file(stem + extension, study::run_gnuplot(elements_chart(results, origin, format)));
    } catch (const study::ChartError& error) {
      throw std::runtime_error(
          fmt::format("{0}{1}: {2}; {0}.csv and {0}.json are written", stem, extension, error.what()));
    }
  };
  draw(".svg", study::ChartFormat::svg);
  draw(".png", study::ChartFormat::png);
}

}  // namespace

int study_command(const StudyOptions& options) {
  const std::string stem = (fs::path(options.folder) / "elements").string();
  require_place_for_results(options.folder, stem);
  defer_interrupts();
  const auto start = Clock::now();
  std::optional<Progress> progress;
  const study::ElementsStudy results = study::study_elements({.jobs = options.jobs}, [&](int done, int of) {
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
  write_results(results, document(results, options, wall_s), stem);
  const char* const covered = !options.quick                 ? ""
                              : results.solved == results.of ? ": --quick left nothing out"
                                                             : ": --quick left out the finest";
  fmt::print("{}{} of {} solutions in {:.1f} s{}\n{}.csv, .json, .svg, .png\n", table(results),
             results.solved, results.of, wall_s, covered, stem);
  return k_done;
}

}  // namespace topple::app
