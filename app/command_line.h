// The command line of topple.
#pragma once

namespace topple::app {

/// Parses and carries out one command line; the exit code. Errors are said on stderr, one line each.
int run_command_line(int argc, char** argv);

}  // namespace topple::app
