// How often a body falls when the floor's motion is a little weaker or stronger.
#pragma once

#include <functional>
#include <vector>

#include "solver/run/run.h"

namespace topple::study {

/// Quantile of the normal distribution for two-sided intervals of 95 %.
inline constexpr double k_95 = 1.959964;

/// A confidence interval.
struct Interval {
  double low, high;
};

/// Confidence interval of a proportion of which `hits` of `trials` >= 1 were seen, by Wilson's score:
///   (p + z^2/2n -+ z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n),  z = k_95.
/// Source: E. B. Wilson, J. Am. Stat. Assoc. 22, 1927, 209-212.
Interval wilson(int hits, int trials);

/// Amplitudes and scales times `factor`.
std::vector<Shake> shaken_by(std::vector<Shake> shakes, double factor);

/// The same scene with the amplitude or scale of every shake times `factor`.
Setup shaken_by(const Setup& setup, double factor);

/// `count` >= 2 factors in equal steps from 1 - spread to 1 + spread.
std::vector<double> even_factors(int count, double spread);

/// What became of one run.
struct Trial {
  double factor = 1;
  bool finished = false;         ///< false: the run failed, or was not begun
  std::vector<bool> overturned;  ///< per body that is furniture
  std::vector<bool> open;        ///< per one of Room::ways()
  std::vector<bool> broke;       ///< per anchor
};

/// Runs the scene with each factor on `jobs` threads. `go_on`: as of for_each_case.
std::vector<Trial> try_factors(const Setup& setup, const std::vector<double>& factors, int jobs,
                               const std::function<bool(int done)>& go_on);

}  // namespace topple::study
