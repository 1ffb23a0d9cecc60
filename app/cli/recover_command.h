// `topple recover`: what is left of a damaged recording.
#pragma once

#include <string>

namespace topple::app {

struct RecoverOptions {
  std::string recording;
  std::string output;  ///< empty: NAME.recovered.h5 beside it
};
int recover_command(const RecoverOptions& options);

}  // namespace topple::app
