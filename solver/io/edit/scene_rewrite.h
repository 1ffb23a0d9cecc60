// Changes of a scene's text that leave the rest of it, its comments included, as it was written.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace topple::io {

/// A key or an entry of an array whose value becomes another one.
struct KeyChange {
  /// {"shake", "2", "amplitude"}, or {"shake", "2"} for all of it: entries of arrays by number from 1
  std::vector<std::string> path;
  std::optional<std::string> value;  ///< TOML; absent: it is taken out, with its array where it is the last
};

/// The text with all changes made, one after the other. Absent keys and tables are added, and an entry of an
/// array right after the last one. Text whose form does not let a change stand in its place is written anew,
/// without comments. Throws InputError for text that is no TOML, std::logic_error for a change that has no
/// place in it.
std::string rewrite_toml(const std::string& text, const std::vector<KeyChange>& changes);

}  // namespace topple::io
