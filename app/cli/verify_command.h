// `topple verify`: computed values against theory.
#pragma once

#include <string>
#include <vector>

namespace topple::app {

struct VerifyOptions {
  std::vector<std::string> scenes;  ///< paths or names; empty: all verification scenes
  std::string filter;               ///< empty: every row
  std::string json;                 ///< file, "-" or empty
  bool quiet = false;
};
int verify_command(const VerifyOptions& options);

}  // namespace topple::app
