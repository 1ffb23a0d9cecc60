// Which instants of a motion an animation needs.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

namespace topple::app {

/// What moves, over time: at each instant as many numbers. Four that are `rotation`: a unit quaternion (x, y,
/// z, w), of its two signs the one nearer to that before.
struct Track {
  std::size_t columns;
  bool rotation = false;
  std::vector<float> values = {};

  std::size_t size() const { return values.size() / columns; }
  const float* at(std::size_t instant) const { return values.data() + columns * instant; }
  void add(const Eigen::Vector3d& v);
  void add(const Eigen::Quaterniond& q);
};

/// Instants to keep, rising, the first and the last among them: between two of them no number is farther than
/// `tolerance` from the straight line, no rotation farther than so many radians from the even turn. The first
/// alone when all are within `tolerance` of it.
std::vector<std::size_t> kept_keys(const std::vector<float>& times, const Track& track, float tolerance);

}  // namespace topple::app
