// Ctrl+C in Python while the solver is at work.
#pragma once

#include <chrono>

namespace topple::python {

/// Asks Python, at most every 50 ms of wall time, whether a signal handler has raised, as Ctrl+C does. Called
/// without the GIL, which it takes for that. It answers for the main thread alone, where Python's handlers
/// run.
class Signals {
 public:
  /// True from then on; Python's error is set.
  bool raised();
  /// Throws py::error_already_set where one has. With the GIL.
  void rethrow() const;

 private:
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
  bool raised_ = false;
};

}  // namespace topple::python
