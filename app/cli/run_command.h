// `topple run`: a scene to its end.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace topple::app {

struct RunOptions {
  std::string scene;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string recording;               ///< empty: none
  std::string json;                    ///< file, "-" or empty
  bool quiet = false;
  bool profile = false;     ///< tells where the time of steps went
  std::optional<int> jobs;  ///< threads; absent: as many as pay
  bool estimate = false;    ///< runs it again at finer steps for the error
};
int run_command(const RunOptions& options);

}  // namespace topple::app
