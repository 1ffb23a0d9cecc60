// A scene stepped to its end and recorded.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/support/interrupt.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/observer.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Threads that make steps of `setup` faster.
int paying_jobs(const Setup& setup);

struct RecordedRun {
  nlohmann::ordered_json summary;
  int exit_code;        ///< as in errors.h
  std::string trouble;  ///< why the run ended before its time, one line; empty: it did not
  bool recorded;        ///< there is a recording, closed
};

struct RunManner {
  bool quiet = false;
  bool profile = false;          ///< adds "profile" to the summary; then one thread steps
  std::optional<int> jobs = {};  ///< threads; absent: as many as pay
  bool estimate = false;  ///< runs it again at finer steps: "error_estimate" of the summary; no statics
  std::function<void(const io::Observation&)> observe = {};  ///< gets what is recorded, or would be
  std::function<bool()> interrupted = app::interrupted;      ///< asked before each step
};

/// What follows the number up to which there is something: of a static run its part of the way.
const char* extent_unit(bool loads);

/// Runs `scene`, recording to `target` (empty: not at all), until its end, a failure or an interrupt, which
/// is Ctrl+C, deferred (interrupt.h), unless the manner has another. Throws io::WriteError when the recording
/// cannot be written; it says what can still be read.
RecordedRun record(const io::Scene& scene, const host::Target& target, const RunManner& manner);

}  // namespace topple::app
