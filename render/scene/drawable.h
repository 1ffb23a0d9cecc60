// What of a SceneFrame can be drawn. Numbers that are not finite, or so large that products of them
// leave the range of float, stop here.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "render/scene/colour_map.h"
#include "render/scene/scene_frame.h"

namespace topple::render {

/// Greatest coordinate that is drawn, m.
inline constexpr float k_greatest_coordinate = 1e5f;

inline bool drawable(float x) {
  return std::abs(x) <= k_greatest_coordinate;
}

template <std::size_t N>
bool drawable(const std::array<float, N>& v) {
  return std::all_of(v.begin(), v.end(), [](float x) { return drawable(x); });
}

inline bool has_value_range(const Legend& legend) {
  return std::isfinite(legend.minimum) && std::isfinite(legend.maximum) && legend.minimum < legend.maximum &&
         std::isfinite(legend.maximum - legend.minimum);
}

/// Where `value` lies on the legend's colour bar, 0..1.
inline float legend_position(const Legend& legend, float value) {
  const float share = colour_position(value, legend.minimum, legend.maximum);
  return legend.square_root ? std::sqrt(share) : share;
}

/// Low and high corner of the frame's bounds; the default ones where they cannot be drawn or hold
/// no volume.
inline std::pair<Eigen::Vector3f, Eigen::Vector3f> drawable_bounds(const SceneFrame& frame) {
  const SceneFrame defaults;
  bool usable = drawable(frame.bounds_min) && drawable(frame.bounds_max);
  for (std::size_t i = 0; i < 3; ++i) usable = usable && frame.bounds_min[i] < frame.bounds_max[i];
  const SceneFrame& source = usable ? frame : defaults;
  return {Eigen::Vector3f(source.bounds_min.data()), Eigen::Vector3f(source.bounds_max.data())};
}

}  // namespace topple::render
