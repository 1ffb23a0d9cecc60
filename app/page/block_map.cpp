#include "app/page/block_map.h"

#include <algorithm>
#include <cmath>

namespace topple::app {
namespace {

constexpr double k_longest = 10;  // s

/// Value `k` of `count` from ends[0] to ends[1].
double on_axis(const double (&ends)[2], int k, int count) {
  return ends[0] * std::pow(ends[1] / ends[0], static_cast<double>(k) / (count - 1));
}

}  // namespace

BlockMap::BlockMap(const Setup& setup) : setup_(setup) {
  const std::vector<Shake>& shakes = setup.parameters.shakes;
  if (shakes.size() != 1 || shakes.front().kind != Shake::Kind::sine) {
    obstacle_ = "the floor moves in another way than one sine";
    return;
  }
  if (setup.model.furniture_total() == 0) {
    obstacle_ = "there is no furniture";
    return;
  }
  planar::Obstacle obstacle = planar::Obstacle::none;
  block_ = planar::planar_case(setup.model, setup.parameters, setup.starts, 0, &obstacle);
  if (!block_) obstacle_ = setup.model.bodies.front().name + ": " + traits(obstacle).phrase;
}

void BlockMap::add_point() {
  const int point = static_cast<int>(points_.size());
  std::vector<Shake> shakes = setup_.parameters.shakes;
  shakes[0].frequency = on_axis(k_frequency, point % k_columns, k_columns);
  shakes[0].amplitude = on_axis(k_amplitude, point / k_columns, k_rows) * k_gal;
  planar::PlanarRun run(*block_, shakes, std::min(setup_.run.duration, k_longest));
  while (!run.over()) run.advance();
  points_.push_back(run.beyond_since() ? Verdict::overturns
                    : run.lifted()     ? Verdict::rocks
                                       : Verdict::stands);
}

}  // namespace topple::app
