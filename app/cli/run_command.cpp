#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/batch/recorded_run.h"
#include "app/batch/run_profile.h"
#include "app/batch/scene_warnings.h"
#include "app/batch/summary.h"
#include "app/cli/command.h"
#include "app/cli/modes_command.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/terms.h"
#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

struct RunOptions {
  std::string scene;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string recording;               ///< empty: none
  std::string json;                    ///< file, "-" or empty
  bool quiet = false;
  bool profile = false;     ///< tells where the time of steps went
  std::optional<int> jobs;  ///< threads; absent: as many as pay
  bool estimate = false;    ///< runs it again at finer steps for the error
  bool force = false;       ///< in place of files of any kind
};

int run_command(const RunOptions& options) {
  const io::Scene scene = io::load_scene(options.scene, options.overrides);
  if (scene.setup.run.analysis == Analysis::modes) {
    if (!options.recording.empty()) throw BadInput("--output: modes are not recorded; --json writes them");
    if (options.profile) throw BadInput("--profile: modes take no steps of time");
    if (options.estimate) throw BadInput("--estimate: modes take no steps of time");
    return modes_command({.scene = options.scene,
                          .overrides = options.overrides,
                          .json = options.json,
                          .force = options.force});
  }
  if (options.profile && is_static(scene.setup)) throw BadInput("--profile: statics take no steps of time");
  if (options.estimate && is_static(scene.setup)) throw BadInput("--estimate: statics take no steps of time");
  const bool json_to_output = options.json == "-";
  defer_interrupts();
  if (!options.recording.empty()) {
    require_no_record("--output", options.recording, options.scene, scene);
    require_writable_file("--output", {options.recording, options.force}, host::FileKind::hdf5,
                          options.scene);
  }
  if (!options.json.empty() && !json_to_output) {
    require_no_record("--json", options.json, options.scene, scene);
    require_writable_text("--json", {options.json, options.force}, host::FileKind::json, options.scene);
    if (same_file(options.json, options.recording))
      throw BadInput("--json: " + options.json + " is the recording; choose another name");
  }
  if (const std::string bending = bending_warning(scene.setup); !bending.empty() && !is_static(scene.setup))
    log_message("warning: " + bending);
  const RecordedRun result = record(scene, {options.recording, options.force},
                                    {.quiet = options.quiet,
                                     .profile = options.profile,
                                     .jobs = options.jobs,
                                     .estimate = options.estimate});
  if (!result.trouble.empty())
    log_message(result.trouble + (result.recorded
                                      ? fmt::format("; {} holds everything up to {:.6g}{}", options.recording,
                                                    result.summary["simulated_s"].get<double>(),
                                                    extent_unit(is_static(scene.setup)))
                                      : ""));
  for (const auto& warning : result.summary["warnings"])
    log_message("warning: " + warning.get<std::string>());
  if (json_to_output) {
    fmt::print("{}\n", json_text(result.summary, 2));
  } else {
    const bool began = result.trouble.empty() || result.summary["simulated_s"].get<double>() > 0;
    if (began) fmt::print("{}", summary_table(result.summary));
    if (options.profile) fmt::print("\n{}", profile_table(result.summary["profile"]));
    if (result.recorded) fmt::print("recording: {}\n", options.recording);
    if (!options.json.empty())
      write_whole_file({options.json, options.force}, host::FileKind::json,
                       json_text(result.summary, 2) + "\n");
  }
  return result.exit_code;
}

}  // namespace

void add_run(Commands& commands) {
  const auto [command, run] =
      commands.add("run", "step a scene to its end, record it, print a summary",
                   "run paper-a --set shake.1.amplitude=\"150 gal\" --json -", run_command);
  add_scene(command, run.scene);
  add_path(command, "-o,--output", run.recording, "REC.h5",
           "recording to write (HDF5), in place of an older one");
  add_set(command, run.overrides);
  add_json(command, run.json, "write the summary as JSON");
  add_quiet(command, run.quiet);
  add_force(command, run.force);
  CLI::Option& jobs =
      add_jobs(command, run.jobs, "threads for bodies that are apart, default as many as pay");
  command.add_flag("--profile", run.profile, "tell where the time of steps goes, on one thread")
      ->excludes(&jobs);
  command.add_flag(
      "--estimate", run.estimate,
      "run it again at half the step (or a hundredth of the tolerance) for the error, at three times "
      "the cost");
}

}  // namespace topple::app
