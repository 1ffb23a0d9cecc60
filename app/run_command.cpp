#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/files.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/recorded_run.h"
#include "app/summary.h"
#include "solver/io/recording.h"
#include "solver/io/scene.h"

namespace topple::app {

RecordedRun record(const io::Scene& scene, const std::string& path, bool quiet) {
  std::optional<io::Recorder> recorder;
  if (!path.empty()) {
    require_writable_folder(std::filesystem::absolute(path).parent_path().string(), path);
    recorder.emplace(path, scene.name, scene.text, scene.setup.model);
  }
  const auto start = std::chrono::steady_clock::now();
  Run run(scene.setup);
  const bool started = run.status().ok();
  if (recorder && started) recorder->observe(run);
  {
    Progress progress(scene.name, "s simulated", scene.setup.run.duration, quiet);
    while (!run.over() && !interrupted()) {
      if (!run.advance().ok()) break;
      if (recorder) recorder->observe(run);
      progress.update(run.state().time);
    }
  }
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string status = !run.status().ok()    ? "diverged"
                             : run.stopped_early() ? "stopped"
                             : run.over()          ? "completed"
                                                   : "interrupted";
  nlohmann::ordered_json result = summary(scene, run, status, wall);
  if (recorder && started) recorder->finish(run, status, result.dump());
  const int exit_code = status == "diverged" ? k_failed : status == "interrupted" ? k_interrupted : k_done;
  if (status == "diverged") {
    fmt::print(stderr, "topple: {}: {}\n", scene.name, run.status().message(scene.setup.model));
    if (recorder && started)
      fmt::print(stderr, "topple: {}: holds everything up to {:.6g} s\n", path, run.state().time);
  }
  if (status == "interrupted")
    fmt::print(stderr, "topple: interrupted at {:.6g} s{}\n", run.state().time,
               recorder ? "; " + path + " holds everything up to there" : std::string());
  return {std::move(result), exit_code};
}

int run_command(const RunOptions& options) {
  const io::Scene scene = io::load_scene(options.scene, options.overrides);
  if (!options.json.empty() && options.json != "-")
    require_writable_folder(std::filesystem::absolute(options.json).parent_path().string(), options.json);
  const RecordedRun result = record(scene, options.recording, options.quiet);
  if (options.json == "-") {
    fmt::print("{}\n", result.summary.dump(2));
  } else {
    fmt::print("{}", summary_table(result.summary));
    if (!options.recording.empty() && std::filesystem::exists(options.recording))
      fmt::print("recording: {}\n", options.recording);
    if (!options.json.empty()) write_whole_file(options.json, result.summary.dump(2) + "\n");
  }
  return result.exit_code;
}

}  // namespace topple::app
