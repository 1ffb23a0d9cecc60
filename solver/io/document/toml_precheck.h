// What TOML forbids and toml++ does not refuse by itself: it is found before the text is parsed.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace topple::io {

/// A place that no TOML text may have.
struct TomlFault {
  std::size_t offset = 0;  ///< bytes before it
  int line = 1;            ///< from 1
  int column = 1;          ///< from 1, in characters
  std::string message;
};

/// The first of these, outside of strings and comments but for one; empty when there is none:
/// - a character beyond ASCII (toml++ takes it for impossible), in a string of several lines one that is the
///   first behind a line that ends with a backslash (the same),
/// - a quote, bracket or "=" within a number or a word (toml++ reads on as far as a blank),
/// - a table's header whose name begins with nothing that begins a name ("[="; toml++ asserts the opposite),
/// - a key of more than 500 dots (tables nest without a limit in toml++, and trees are walked recursively).
/// In a text that is broken otherwise too, what follows the first break may be read wrongly.
std::optional<TomlFault> find_toml_fault(std::string_view text);

}  // namespace topple::io
