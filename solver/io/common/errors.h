// What reading and writing fail with.
#pragma once

#include <stdexcept>

#include "solver/io/host/errors.h"

namespace topple::io {

/// Bad input. what() is one line, ready to print: "scene.toml:14:9: contact.friction: 2.4 is outside 0..1.5".
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file cannot be written: one line with path and cause.
using WriteError = host::FileError;

}  // namespace topple::io
