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
using host::FileKind;
using nlohmann::ordered_json;

namespace {

constexpr std::pair<const char*, FileKind> k_results[] = {
    {".csv", FileKind::csv}, {".json", FileKind::json}, {".svg", FileKind::svg}, {".png", FileKind::png}};

}  // namespace

std::string place_for_results(const std::string& folder, const std::string& kind, bool force) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw BadInput(folder + ": cannot be created: " + error.message());
  std::string stem = (fs::path(folder) / kind).string();
  for (const auto& [extension, holds] : k_results)
    require_writable_file("--output", {stem + extension, force}, holds, "");
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

void write_study(const host::Target& stem, const ordered_json& rows, const ordered_json& document,
                 const std::function<std::string(study::ChartFormat)>& script) {
  const std::string begin = stem.path.string();
  const auto write = [&](const char* extension, FileKind kind, const std::string& content) {
    write_whole_file({begin + extension, stem.force}, kind, content);
  };
  write(".csv", FileKind::csv, study::csv_text(rows));
  write(".json", FileKind::json, json_text(document, 2) + "\n");
  const auto draw = [&](const char* extension, FileKind kind, study::ChartFormat format) {
    try {
      write(extension, kind, study::run_gnuplot(script(format)));
    } catch (const study::ChartError& error) {
      throw std::runtime_error(
          fmt::format("{0}{1}: {2}; {0}.csv and {0}.json are written", begin, extension, error.what()));
    }
  };
  draw(".svg", FileKind::svg, study::ChartFormat::svg);
  draw(".png", FileKind::png, study::ChartFormat::png);
}

}  // namespace topple::app
