// A scene stepped to its end and recorded.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "solver/io/scene.h"

namespace topple::app {

struct RecordedRun {
  nlohmann::ordered_json summary;
  int exit_code;  ///< as in commands.h
};

/// Runs `scene`, recording to `path` (empty: not at all), until its end, a failure or Ctrl+C. What went wrong
/// with the run is said on stderr. Throws BadInput when `path` cannot be written to, io::WriteError when
/// writing fails later.
RecordedRun record(const io::Scene& scene, const std::string& path, bool quiet);

}  // namespace topple::app
