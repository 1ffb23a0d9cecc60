// What the program says besides its results.
#pragma once

#include <string>

namespace topple::app {

/// One line on stderr after the program's name. Control characters, which names of files may hold, are
/// written out, so that it stays one line.
void log_message(const std::string& message);

}  // namespace topple::app
