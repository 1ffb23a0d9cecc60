// How good predictions of yes or no are.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "solver/study/common/spread.h"

namespace topple::study {

/// One prediction and what was measured.
struct Forecast {
  double probability = 0;  ///< of yes
  bool measured = false;

  bool yes() const { return probability > 0.5; }
  bool right() const { return yes() == measured; }
};

struct Confusion {
  int hits = 0, false_alarms = 0, misses = 0, correct_rejections = 0;
};

/// Forecasts between two probabilities.
struct ReliabilityBin {
  double from = 0, to = 1;
  int count = 0, yes = 0;  ///< of them measured
  double mean = 0;         ///< probability; 0 of none
};
inline constexpr std::size_t k_reliability_bins = 5;

struct Scores {
  int count = 0, right = 0;
  Interval interval{};  ///< of the share right, 95 % (Wilson)
  double brier = 0;     ///< mean of (probability - measured)^2, 0 best
  Confusion confusion;
  std::array<ReliabilityBin, k_reliability_bins> reliability{};

  double share() const { return count > 0 ? static_cast<double>(right) / count : 0; }
};
/// Of at least one forecast.
Scores scored(const std::vector<Forecast>& forecasts);

/// A rule of yes above a threshold: that which is right most often of those half-way between neighbouring
/// values (and beyond them); of equals the middle one. `used`: which cases count.
double best_threshold(const std::vector<double>& values, const std::vector<bool>& measured,
                      const std::vector<bool>& used);

}  // namespace topple::study
