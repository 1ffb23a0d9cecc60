#include "app/batch/recorded_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "app/batch/run_profile.h"
#include "app/batch/summary.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/progress.h"
#include "app/support/terms.h"
#include "solver/body/model_level.h"
#include "solver/io/recording/recording.h"
#include "solver/study/common/refinement.h"
#include "solver/study/common/team.h"

namespace topple::app {
namespace {

constexpr int k_many_bodies = 32;  // that are not frames: a step of fewer is over before it is shared out

using Keep = std::function<void(const io::Observation&)>;

/// Steps to the end of `run`, a failure or an interrupt. `keep`: empty, or what has the first instant
/// already.
void step_through(Run& run, io::Observer& observer, const Keep& keep, const RunManner& manner,
                  Progress& progress) {
  while (!run.over() && !manner.interrupted()) {
    if (!run.advance().ok()) break;
    if (keep) {
      const InPhase phase(&run.profile(), Phase::record);
      keep(observer.observe(run));
    }
    progress.update(run.time());
  }
  if (keep) {
    const InPhase phase(&run.profile(), Phase::record);
    keep(observer.last(run));
  }
}

/// Into the recorder, unless it is null, and to who observes; empty: nobody wants it.
Keep keep_in(io::Recorder* recorder, const RunManner& manner) {
  if (!recorder) return manner.observe;
  return [recorder, &manner](const io::Observation& observation) {
    if (manner.observe) manner.observe(observation);
    recorder->write(observation);
    recorder->flush_if_due();
  };
}

/// The error of a recording that broke off, and how far it can be read.
io::WriteError with_remains(const io::WriteError& error, const std::string& path, bool loads) {
  try {
    const io::Recording left(path);
    if (left.frame_count() == 0) return error;
    return io::WriteError(fmt::format("{}; it can be read up to {:.6g}{}", error.what(),
                                      left.index().back().time, extent_unit(loads)));
  } catch (const io::InputError&) {
    return error;
  }
}

std::string status_of(const Run& run) {
  return !run.status().ok()    ? "diverged"
         : run.stopped_early() ? "stopped"
         : run.over()          ? "completed"
                               : "interrupted";
}

/// "error_estimate" of the summary of `run`; null when an interrupt came first.
nlohmann::ordered_json estimate(const io::Scene& scene, const Run& run, std::optional<study::Team>& team,
                                const RunManner& manner) {
  const Setup finer = study::compared(scene.setup);
  Run second(finer);
  if (team) second.share(team->share());
  Progress progress(scene.name + ", " + refinement_in_words(finer), "s simulated", finer.run.duration,
                    manner.quiet);
  while (second.status().ok() && !second.over() && !manner.interrupted()) {
    if (!second.advance().ok()) break;
    progress.update(second.time());
  }
  if (!second.status().ok()) return failed_estimate(finer, second.status().message(finer.model));
  if (!second.over()) return nullptr;
  return error_estimate(scene.setup, run.outcome(), second.outcome());
}

void warn_of_open_verdicts(const nlohmann::ordered_json& error, nlohmann::ordered_json& warnings) {
  if (!error.contains("disagreements")) return;
  for (const auto& line : error["disagreements"])
    warnings.push_back("a finer run takes another course: " + line.get<std::string>() +
                       "; the share of many runs says more than one (study overturn --ensemble)");
}

}  // namespace

int paying_jobs(const Setup& setup) {
  if (is_static(setup)) return 1;
  int frames = 0, others = 0;
  for (int b = 0; b < setup.model.furniture_total(); ++b)
    ++(traits(base_level(setup.model, setup.parameters, b).level).moves_nodes ? frames : others);
  if (frames < 2 && others < k_many_bodies) return 1;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, frames + others);
}

const char* extent_unit(bool loads) {
  return loads ? " of the way" : " s";
}

RecordedRun record(const io::Scene& scene, const host::Target& target, const RunManner& manner) {
  std::optional<io::Recorder> recorder;
  if (!target.path.empty()) recorder.emplace(target, scene.name, scene.text, scene.setup.model, scene.files);
  const auto start = Clock::now();
  std::optional<study::Team> team;
  Run run(scene.setup);
  const bool recorded = recorder && run.status().ok();  // what does not settle has no first instant
  RecordedRun result;
  bool begun = false;
  try {
    if (run.status().ok()) {
      io::Observer observer;
      const Keep keep = keep_in(recorded ? &*recorder : nullptr, manner);
      if (keep) keep(observer.observe(run));
      if (recorded) recorder->flush();
      begun = recorded;
      Progress progress(scene.name, is_static(scene.setup) ? "of the load path" : "s simulated",
                        scene.setup.run.duration, manner.quiet);
      const int jobs = manner.profile ? 1 : manner.jobs.value_or(paying_jobs(scene.setup));
      if (jobs > 1) run.share(team.emplace(jobs).share());
      if (manner.profile) start_profile(run.profile());
      step_through(run, observer, keep, manner, progress);
    }
    nlohmann::ordered_json profile;
    if (manner.profile) profile = profile_summary(run.profile(), run.step());
    const double wall = seconds_since(start);
    const std::string status = status_of(run);
    result.summary = summary(scene, run, status, wall);
    if (manner.profile) result.summary["profile"] = std::move(profile);
    bool estimated = true;
    if (manner.estimate && run.over() && run.status().ok()) {
      if (recorded) recorder->flush();
      nlohmann::ordered_json& error = result.summary["error_estimate"];
      error = estimate(scene, run, team, manner);
      estimated = !error.is_null();
      if (estimated) warn_of_open_verdicts(error, result.summary["warnings"]);
    }
    if (recorded) recorder->finish(status, json_text(result.summary));
    result.recorded = recorded;
    result.exit_code = status == "diverged" ? k_failed : status == "interrupted" ? k_interrupted : k_done;
    if (status == "diverged") result.trouble = scene.name + ": " + run.status().message(scene.setup.model);
    if (!estimated) {
      result.exit_code = k_interrupted;
      result.trouble = "interrupted while the error was estimated; the run itself is complete";
    }
    if (status == "interrupted")
      result.trouble = is_static(scene.setup)
                           ? fmt::format("interrupted at load factor {:.6g}", run.state().load_factor)
                           : fmt::format("interrupted at {:.6g} s", run.state().time);
  } catch (const io::WriteError& error) {
    if (!begun) throw;
    throw with_remains(error, target.path.string(), is_static(scene.setup));
  }
  return result;
}

}  // namespace topple::app
