// Files that scenes name.
#pragma once

#include <optional>
#include <string>

#include "solver/io/scene.h"

namespace topple::io {

/// The whole file as bytes. Throws InputError for what is missing, a folder or no regular file, cannot be
/// read, or has more than `most_bytes`.
std::string read_whole_file(const std::string& path, std::size_t most_bytes);

/// Nothing when there is no such built-in record.
std::optional<std::string> builtin_record(const std::string& name);

/// Files beside `origin`, else built-in records.
ReadSceneFile files_beside(const std::string& origin);

/// Built-in records, else files in the working folder.
ReadSceneFile builtin_files();

}  // namespace topple::io
