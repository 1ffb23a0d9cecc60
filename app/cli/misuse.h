// What is wrong with a call that cannot be understood, in words that help.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace topple::app {

/// Throws BadInput when the first word of a call is not one of the commands of `table`.
void refuse_unknown_command(const CLI::App& table, int argc, char** argv);

/// Of a call that `table` has parsed up to `error`: an option that it does not know, with the nearest one
/// that it does, or else the error.
std::string misuse(const CLI::App& table, const CLI::ParseError& error);

}  // namespace topple::app
