// The command line of topple.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace topple::app {

/// Parses and carries out one command line; the exit code. Errors are said on stderr, one line each.
int run_command_line(int argc, char** argv);

/// Lets `read` see the table of commands and options that calls are parsed by and --help is made from.
void read_commands(const std::function<void(const CLI::App&)>& read);

}  // namespace topple::app
