// A scene stepped to its end and recorded.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "solver/io/host/staged_file.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

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
};

/// What follows the number up to which there is something: of a static run its part of the way.
const char* extent_unit(bool loads);

/// Runs `scene`, recording to `target` (empty: not at all), until its end, a failure or Ctrl+C, which is
/// deferred (interrupt.h). Throws io::WriteError when the recording cannot be written; it says what can still
/// be read.
RecordedRun record(const io::Scene& scene, const host::Target& target, const RunManner& manner);

}  // namespace topple::app
