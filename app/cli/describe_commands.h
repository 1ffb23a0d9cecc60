// `topple check`, `topple info` and `topple scenes`.
#pragma once

#include <string>
#include <vector>

namespace topple::app {

int check_command(const std::vector<std::string>& scenes, const std::vector<std::string>& overrides);

struct InfoOptions {
  std::string file;     ///< scene or recording
  std::string json;     ///< file, "-" or empty
  bool verify = false;  ///< run a recording again
};
int info_command(const InfoOptions& options);
int scenes_command();

}  // namespace topple::app
