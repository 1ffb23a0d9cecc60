// Progress of long work on stderr, or reported to the process that started this one.
#pragma once

#include <optional>
#include <string>

#include "app/support/clock.h"

namespace topple::app {

/// How far some work is.
struct ProgressReport {
  std::string what, unit;      ///< of the work; of what is counted
  double done = 0, total = 1;  ///< units
  double rate = 0, left = 0;   ///< units per s; s
};
/// "40 of 300 pictures, 23/s, 11 s left".
std::string in_words(const ProgressReport& report);
/// {"what":"drawing","unit":"pictures","done":40,"total":300,"rate":23,"left_s":11.3} and the end of the
/// line.
std::string json_line(const ProgressReport& report);
/// Nothing when `line` is no such line.
std::optional<ProgressReport> progress_in(const std::string& line);

/// Variable of the environment that names the descriptor of a pipe: a process that has it writes a line of
/// JSON there for each report, and none to stderr. Lines that the pipe has no room for are left out.
inline constexpr const char* k_progress_variable = "TOPPLE_PROGRESS_FD";

/// A bar with rate and remaining time on a terminal; plain lines every few seconds in a log; lines of JSON
/// for a process that asked for them; nothing when quiet.
class Progress {
 public:
  /// `unit` names what is counted ("s simulated", "pictures"); `total` > 0.
  Progress(std::string what, std::string unit, double total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Draws when enough wall time has passed since the last drawing.
  void update(double done);

 private:
  const std::string what_, unit_;
  const double total_;
  const int pipe_;  ///< -1: nobody asked
  const bool quiet_, terminal_;
  const Clock::time_point start_;
  Clock::time_point last_;
  bool drawn_ = false;
};

}  // namespace topple::app
