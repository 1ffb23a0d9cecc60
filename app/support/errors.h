// How a command ends. It returns an exit code: done, the run failed, interrupted; bad usage and bad input
// leave as BadInput (exit 2).
#pragma once

#include <stdexcept>

namespace topple::app {

inline constexpr int k_done = 0;
inline constexpr int k_failed = 1;
inline constexpr int k_bad_input = 2;
inline constexpr int k_interrupted = 130;

/// Bad usage or bad input found by the program itself. what() is one line.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace topple::app
