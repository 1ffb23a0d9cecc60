// Progress of long work on stderr.
#pragma once

#include <string>

#include "app/support/clock.h"

namespace topple::app {

/// A bar with rate and remaining time on a terminal; plain lines every few seconds in a log; nothing when
/// quiet.
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
  const bool quiet_, terminal_;
  const Clock::time_point start_;
  Clock::time_point last_;
  bool drawn_ = false;
};

}  // namespace topple::app
