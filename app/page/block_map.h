// Which sines overturn a body as a planar block: the map under the sliders of a live page.
#pragma once

#include <optional>
#include <vector>

#include "app/support/language.h"
#include "solver/planar/planar_run.h"
#include "solver/run/run.h"

namespace topple::app {

/// Frequency by amplitude, both on logarithmic axes, computed point by point.
class BlockMap {
 public:
  static constexpr int k_columns = 24, k_rows = 18;
  static constexpr double k_frequency[2] = {0.2, 5};    ///< Hz, of the first and the last column
  static constexpr double k_amplitude[2] = {50, 1000};  ///< gal, of the first and the last row
  enum class Verdict { stands = 0, rocks = 1, overturns = 2 };

  /// Of one piece of furniture as a rigid block that begins at rest on the floor, without walls, other bodies
  /// and anchors, under the only shake that is on; for `setup`'s duration, 10 s at most.
  BlockMap(const Setup& setup, int body);
  int body() const { return body_; }
  /// Why there is no map; none: there is one.
  const std::optional<Phrase>& obstacle() const { return obstacle_; }
  /// Must not be called where there is no map.
  const Shake& shake() const { return shake_; }
  bool complete() const { return points_.size() == k_columns * k_rows; }
  /// The next point. Must not be called when complete or where there is no map.
  void add_point();
  /// Row by row from the lowest amplitude.
  const std::vector<Verdict>& points() const { return points_; }

 private:
  std::optional<Phrase> find_obstacle(const Setup& setup);

  int body_;
  double duration_;  ///< s
  Shake shake_;
  std::optional<planar::PlanarCase> block_;
  std::optional<Phrase> obstacle_;
  std::vector<Verdict> points_;
};

}  // namespace topple::app
