#include "app/gltf/key_frames.h"

#include <algorithm>
#include <cmath>

namespace topple::app {
namespace {

constexpr std::size_t k_farthest = 100;  // instants from key to key: bounds the search

Eigen::Quaternionf turn(const float* q) {
  return Eigen::Quaternionf(q[3], q[0], q[1], q[2]);
}

/// Whether instant `k` lies where interpolation from `from` to `to` puts it, u of the way.
bool fits(const Track& track, std::size_t from, std::size_t to, std::size_t k, float u, float tolerance) {
  const float *a = track.at(from), *b = track.at(to), *x = track.at(k);
  if (track.rotation) return turn(a).slerp(u, turn(b)).angularDistance(turn(x)) <= tolerance;
  for (std::size_t i = 0; i < track.columns; ++i)
    if (!(std::abs((1 - u) * a[i] + u * b[i] - x[i]) <= tolerance)) return false;
  return true;
}

}  // namespace

void Track::add(const Eigen::Vector3d& v) {
  for (const double x : v) values.push_back(static_cast<float>(x));
}

void Track::add(const Eigen::Quaterniond& q) {
  Eigen::Vector4f coefficients = q.normalized().coeffs().cast<float>();
  if (!values.empty() && coefficients.dot(Eigen::Map<const Eigen::Vector4f>(&*(values.end() - 4))) < 0)
    coefficients = -coefficients;
  values.insert(values.end(), coefficients.begin(), coefficients.end());
}

std::vector<std::size_t> kept_keys(const std::vector<float>& times, const Track& track, float tolerance) {
  const std::size_t count = track.size();
  std::vector<std::size_t> kept = {0};
  bool still = true;
  for (std::size_t k = 1; k < count && still; ++k) still = fits(track, 0, 0, k, 0, tolerance);
  if (still) return kept;
  for (std::size_t to = 2; to < count; ++to) {
    const std::size_t from = kept.back();
    bool all = to - from <= k_farthest;
    for (std::size_t k = from + 1; k < to && all; ++k)
      all = fits(track, from, to, k, (times[k] - times[from]) / (times[to] - times[from]), tolerance);
    if (!all) kept.push_back(to - 1);
  }
  kept.push_back(count - 1);
  return kept;
}

}  // namespace topple::app
