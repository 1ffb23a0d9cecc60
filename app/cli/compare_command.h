// `topple compare`: two runs side by side.
#pragma once

#include <string>

namespace topple::app {

struct CompareOptions {
  std::string a, b;  ///< scenes or recordings
  std::string json;  ///< file, "-" or empty
  std::string mp4;   ///< ghost video; empty: none
  bool quiet = false;
};
int compare_command(const CompareOptions& options);

}  // namespace topple::app
