// Ctrl+C.
#pragma once

namespace topple::app {

/// From now on SIGINT and SIGTERM end the program with exit code 130, and a write past a size limit fails
/// instead of killing it.
void catch_interrupts();

/// From now on they only set a flag, the first time: there are files to close. A second one ends the program
/// at once.
void defer_interrupts();

/// Whether one has come since.
bool interrupted();

}  // namespace topple::app
