#include "app/cli/run_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/batch/recorded_run.h"
#include "app/batch/run_profile.h"
#include "app/batch/summary.h"
#include "app/cli/modes_command.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/terms.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

int run_command(const RunOptions& options) {
  const io::Scene scene = io::load_scene(options.scene, options.overrides);
  if (scene.setup.run.analysis == Analysis::modes) {
    if (!options.recording.empty()) throw BadInput("--output: modes are not recorded; --json writes them");
    if (options.profile) throw BadInput("--profile: modes take no steps of time");
    if (options.estimate) throw BadInput("--estimate: modes take no steps of time");
    return modes_command({.scene = options.scene, .overrides = options.overrides, .json = options.json});
  }
  if (options.profile && is_static(scene.setup)) throw BadInput("--profile: statics take no steps of time");
  if (options.estimate && is_static(scene.setup)) throw BadInput("--estimate: statics take no steps of time");
  const bool json_to_output = options.json == "-";
  defer_interrupts();
  if (!options.recording.empty()) {
    require_writable_file("--output", options.recording, options.scene);
    require_no_record("--output", options.recording, options.scene, scene);
  }
  if (!options.json.empty() && !json_to_output) {
    require_writable_text("--json", options.json, options.scene);
    require_no_record("--json", options.json, options.scene, scene);
    if (same_file(options.json, options.recording))
      throw BadInput("--json: " + options.json + " is the recording; choose another name");
  }
  const RecordedRun result = record(scene, options.recording,
                                    {.quiet = options.quiet,
                                     .profile = options.profile,
                                     .jobs = options.jobs,
                                     .estimate = options.estimate});
  if (!result.trouble.empty())
    say(result.trouble +
        (result.recorded
             ? fmt::format("; {} holds everything up to {:.6g}{}", options.recording,
                           result.summary["simulated_s"].get<double>(), extent_unit(is_static(scene.setup)))
             : ""));
  for (const auto& warning : result.summary["warnings"]) say("warning: " + warning.get<std::string>());
  if (json_to_output) {
    fmt::print("{}\n", json_text(result.summary, 2));
  } else {
    fmt::print("{}", summary_table(result.summary));
    if (options.profile) fmt::print("\n{}", profile_table(result.summary["profile"]));
    if (result.recorded) fmt::print("recording: {}\n", options.recording);
    if (!options.json.empty()) write_whole_file(options.json, json_text(result.summary, 2) + "\n");
  }
  return result.exit_code;
}

}  // namespace topple::app
