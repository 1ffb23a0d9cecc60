#include "app/page/block_map.h"

#include <algorithm>
#include <cmath>

#include "app/page/page_words.h"

namespace topple::app {
namespace {

constexpr double k_longest = 10;  // s
constexpr double k_level = 1e-9;  // horizontal part of a unit vector that counts as none

/// Value `k` of `count` from ends[0] to ends[1].
double on_axis(const double (&ends)[2], int k, int count) {
  return ends[0] * std::pow(ends[1] / ends[0], static_cast<double>(k) / (count - 1));
}

}  // namespace

BlockMap::BlockMap(const Setup& setup, int body)
    : body_(body), duration_(std::min(setup.run.duration, k_longest)), obstacle_(find_obstacle(setup)) {}

std::optional<Phrase> BlockMap::find_obstacle(const Setup& setup) {
  if (body_ < 0 || body_ >= setup.model.furniture_total()) return page_words::k_map_no_piece;
  Parameters parameters = setup.parameters;
  std::erase_if(parameters.shakes, [](const Shake& shake) { return !shake.on; });
  if (parameters.shakes.size() != 1 || parameters.shakes[0].kind != Shake::Kind::sine)
    return page_words::k_map_no_sine;
  shake_ = parameters.shakes[0];
  // of its floor's motion only the amplitude can be changed
  if (shake_.building) return page_words::k_map_building;
  const Vec3 along(shake_.direction.x(), shake_.direction.y(), 0);
  if (along.norm() < k_level) return page_words::k_map_vertical;
  parameters.anchors.assign(setup.model.anchors.size(), false);
  planar::Obstacle obstacle = planar::Obstacle::none;
  block_ = planar::planar_case_along(setup.model, parameters, along.normalized(), body_, &obstacle);
  if (block_) return std::nullopt;
  return Phrase{traits(obstacle).phrase, row_of(page_words::k_obstacles, obstacle).japanese};
}

void BlockMap::add_point() {
  const int point = static_cast<int>(points_.size());
  Shake shake = shake_;
  shake.frequency = on_axis(k_frequency, point % k_columns, k_columns);
  shake.amplitude = on_axis(k_amplitude, point / k_columns, k_rows) * k_gal;
  planar::PlanarRun run(*block_, {shake}, duration_);
  while (!run.over()) run.advance();
  points_.push_back(run.beyond_since() ? Verdict::overturns
                    : run.lifted()     ? Verdict::rocks
                                       : Verdict::stands);
}

}  // namespace topple::app
