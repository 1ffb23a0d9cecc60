// `topple modes`: natural frequencies and shapes.
#pragma once

#include <string>
#include <vector>

namespace topple::app {

struct ModesOptions {
  std::string scene;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  int count = 10;                      ///< of each body, rigid ones among them
  std::string json;                    ///< file, "-" or empty
  bool force = false;                  ///< in place of files of any kind
};
int modes_command(const ModesOptions& options);

}  // namespace topple::app
