// A grid of settings on two cases: free rocking, and a floor that shakes.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "bench/engines/block.h"

namespace topple::bench {

inline constexpr double k_window = 3.4;                    ///< s, of free rocking
inline constexpr double k_fall = 45 * k_degree;            ///< rad
inline constexpr double k_fall_window = 6;                 ///< s, in which the block has to pass k_fall
inline constexpr double k_amplitudes[] = {690, 695, 700};  ///< gal; the last is the case that is timed

struct Instant {
  double time, tilt;  ///< s, rad
};

/// What theory says (verification/housner.h).
struct Reference {
  std::vector<Instant> path;              ///< of free rocking
  std::vector<double> impacts;            ///< s, of free rocking
  double falls[std::size(k_amplitudes)];  ///< s, when k_fall is passed
};

Reference reference();

/// What one setting did. Nothing where the engine gave up or the block did not fall.
struct FreeRocking {
  std::optional<double> cpu;    ///< s per simulated second of k_window, of the steps alone
  std::optional<double> error;  ///< rad, of the tilt: root mean square over k_window
  std::optional<double> first_impact, third_impact;  ///< s, off theory
};
struct Falling {
  std::optional<double> cpu;  ///< s per simulated second up to the fall of theory, of the steps alone
  std::optional<double> falls[std::size(k_amplitudes)];  ///< s
  std::optional<double> error;  ///< s, the greatest of the times of falling; nothing when one is missing
};

FreeRocking free_rocking(const Setting& setting, const Reference& theory);
Falling falling(const Setting& setting, const Reference& theory);

struct Trial {
  int engine, setting;  ///< indices
  FreeRocking rocking;
  Falling falling;
};

/// Trials of one engine than which none of its own is both cheaper and nearer to theory, cheapest first.
/// `part`: of a trial, with cpu and error.
template <typename Part>
std::vector<const Trial*> front(const std::vector<Trial>& trials, int engine, Part Trial::*part) {
  std::vector<const Trial*> order, best;
  for (const Trial& trial : trials)
    if (trial.engine == engine && (trial.*part).cpu && (trial.*part).error) order.push_back(&trial);
  std::sort(order.begin(), order.end(),
            [&](const Trial* a, const Trial* b) { return *(a->*part).cpu < *(b->*part).cpu; });
  for (const Trial* trial : order)
    if (best.empty() || *(trial->*part).error < *(best.back()->*part).error) best.push_back(trial);
  return best;
}

}  // namespace topple::bench
