// Files that the program writes besides recordings.
#pragma once

#include <string>

namespace topple::app {

/// Throws BadInput, with `what` named, unless files can be created in `folder`.
void require_writable_folder(const std::string& folder, const std::string& what);

/// Writes a file so that it appears whole or not at all. Throws std::runtime_error with path and cause.
void write_whole_file(const std::string& path, const std::string& content);

}  // namespace topple::app
