// What writing a file fails with.
#pragma once

#include <stdexcept>

namespace topple::host {

/// A file cannot be written (disk full, no permission). what(): one line with path and cause.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What is there is of another kind than what was to replace it.
struct Refusal : FileError {
  using FileError::FileError;
};

}  // namespace topple::host
