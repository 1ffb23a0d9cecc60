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

/// The first of these, outside of strings and comments; empty when there is none:
/// - a character beyond ASCII (toml++ takes it for impossible),
/// - a table's header whose name begins with nothing that begins a name ("[="; toml++ asserts the opposite),
/// - a key of more than 500 dots (tables nest without a limit in toml++, and trees are walked recursively).
/// In a text that is broken otherwise too, what follows the first break may be read wrongly.
std::optional<TomlFault> find_toml_fault(std::string_view text);

}  // namespace topple::io
