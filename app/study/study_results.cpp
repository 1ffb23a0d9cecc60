#include "app/study/study_results.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/batch/summary.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "solver/study/common/gnuplot.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/rows.h"

namespace topple::app {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string place_for_results(const std::string& folder, const std::string& kind) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw BadInput(folder + ": cannot be created: " + error.message());
  std::string stem = (fs::path(folder) / kind).string();
  for (const char* extension : {".csv", ".json", ".svg", ".png"})
    require_writable_file("--output", stem + extension, "");
  return stem;
}

std::string origin_text() {
  const int cores = study::core_count();
  return fmt::format("topple {} on {}, {} {}", TOPPLE_VERSION, study::processor_name(), cores,
                     cores == 1 ? "core" : "cores");
}

ordered_json machine_json() {
  return {{"processor", study::processor_name()}, {"cores", study::core_count()}};
}

void write_study(const std::string& stem, const ordered_json& rows, const ordered_json& document,
                 const std::function<std::string(study::ChartFormat)>& script) {
  write_whole_file(stem + ".csv", study::csv_text(rows));
  write_whole_file(stem + ".json", json_text(document, 2) + "\n");
  const auto draw = [&](const char* extension, study::ChartFormat format) {
    try {
      write_whole_file(stem + extension, study::run_gnuplot(script(format)));
    } catch (const study::ChartError& error) {
      throw std::runtime_error(
          fmt::format("{0}{1}: {2}; {0}.csv and {0}.json are written", stem, extension, error.what()));
    }
  };
  draw(".svg", study::ChartFormat::svg);
  draw(".png", study::ChartFormat::png);
}

}  // namespace topple::app
