// Ctrl+C.
#pragma once

namespace topple::app {

/// From now on SIGINT and SIGTERM only set a flag, the first time; a second one ends the program at once. A
/// write past a size limit fails instead of killing the program.
void catch_interrupts();

/// Whether SIGINT or SIGTERM has come.
bool interrupted();

}  // namespace topple::app
