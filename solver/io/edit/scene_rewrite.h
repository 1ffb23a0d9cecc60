// Changes of a scene's text that leave the rest of it, its comments included, as it was written.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace topple::io {

/// A key whose value becomes another one.
struct KeyChange {
  std::vector<std::string> path;     ///< {"shake", "2", "amplitude"}: entries of arrays by number from 1
  std::optional<std::string> value;  ///< TOML; absent: the key is taken out
};

/// The text with all changes made. Absent keys and tables are added, and an entry of an array right after the
/// last one. Text whose form does not let a change stand in its place is written anew, without comments.
/// Throws InputError for text that is no TOML, std::logic_error for a change that has no place in it.
std::string rewrite_toml(const std::string& text, const std::vector<KeyChange>& changes);

}  // namespace topple::io
