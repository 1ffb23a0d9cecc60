// The manual page and shell completion, from the table of commands that --help is made from.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace topple::app {

/// `frame` (roff) with the commands and options of `app` in place of @COMMANDS@ and the version for
/// @VERSION@.
std::string manual_page(const CLI::App& app, std::string frame);

/// A script for bash-completion: commands, options, the words that an option takes, built-in scenes, files.
std::string bash_completion(const CLI::App& app);

}  // namespace topple::app
