// Which sines overturn a body as a planar block: the map under the sliders of a live page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/planar/planar_run.h"
#include "solver/run/run.h"

namespace topple::app {

/// Frequency by amplitude, both on logarithmic axes, computed point by point. The setup must outlive it.
class BlockMap {
 public:
  static constexpr int k_columns = 24, k_rows = 18;
  static constexpr double k_frequency[2] = {0.2, 5};    ///< Hz, of the first and the last column
  static constexpr double k_amplitude[2] = {50, 1000};  ///< gal, of the first and the last row
  enum class Verdict { stands = 0, rocks = 1, overturns = 2 };

  /// Of the first piece of furniture under the first shake, for `setup`'s duration, 10 s at most.
  explicit BlockMap(const Setup& setup);
  /// Why there is no map; empty: there is one.
  const std::string& obstacle() const { return obstacle_; }
  bool complete() const { return points_.size() == k_columns * k_rows; }
  /// The next point. Must not be called when complete or where there is none.
  void add_point();
  /// Row by row from the lowest amplitude.
  const std::vector<Verdict>& points() const { return points_; }

 private:
  const Setup& setup_;
  std::string obstacle_;
  std::optional<planar::PlanarCase> block_;
  std::vector<Verdict> points_;
};

}  // namespace topple::app
