#include "app/gltf/key_frames.h"

#include <gtest/gtest.h>

#include <cmath>

namespace topple::app {
namespace {

constexpr float k_tolerance = 1e-3f;

std::vector<float> even_times(std::size_t count) {
  std::vector<float> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = 0.01f * static_cast<float>(i);
  return times;
}

/// The greatest distance of an instant from what lies between its keys.
float worst(const std::vector<float>& times, const Track& track, const std::vector<std::size_t>& keys) {
  float most = 0;
  for (std::size_t k = 0; k + 1 < keys.size(); ++k)
    for (std::size_t i = keys[k]; i <= keys[k + 1]; ++i) {
      const float *a = track.at(keys[k]), *b = track.at(keys[k + 1]), *x = track.at(i);
      const float u = (times[i] - times[keys[k]]) / (times[keys[k + 1]] - times[keys[k]]);
      if (track.rotation) {
        const Eigen::Quaternionf from(a), to(b);
        most = std::max(most, from.slerp(u, to).angularDistance(Eigen::Quaternionf(x)));
      } else {
        for (std::size_t c = 0; c < track.columns; ++c)
          most = std::max(most, std::abs((1 - u) * a[c] + u * b[c] - x[c]));
      }
    }
  return most;
}

TEST(KeyFrames, what_stands_still_has_one_key) {
  Track track{3};
  for (int i = 0; i < 500; ++i) track.add(Eigen::Vector3d(1, 2, 3 + 1e-4 * (i % 2)));
  EXPECT_EQ(kept_keys(even_times(500), track, k_tolerance), (std::vector<std::size_t>{0}));
}

TEST(KeyFrames, a_straight_way_with_a_corner_has_three) {
  Track track{3};
  for (int i = 0; i <= 80; ++i) track.add(Eigen::Vector3d(std::abs(i - 30), 0, i));
  EXPECT_EQ(kept_keys(even_times(81), track, k_tolerance), (std::vector<std::size_t>{0, 30, 80}));
}

TEST(KeyFrames, an_even_turn_has_two_and_quaternions_keep_their_sign) {
  Track track{4, true};
  for (int i = 0; i <= 90; ++i) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(0.02 * i, Eigen::Vector3d(1, 2, 2) / 3));
    track.add(i % 2 ? q : Eigen::Quaterniond(-q.coeffs()));
  }
  EXPECT_EQ(kept_keys(even_times(91), track, k_tolerance), (std::vector<std::size_t>{0, 90}));
  for (std::size_t i = 1; i < track.size(); ++i)
    EXPECT_GT(Eigen::Quaternionf(track.at(i)).dot(Eigen::Quaternionf(track.at(i - 1))), 0) << i;
}

TEST(KeyFrames, between_keys_nothing_is_farther_off_than_the_tolerance) {
  Track places{3}, turns{4, true};
  for (int i = 0; i < 700; ++i) {
    const double t = 0.003 * i;
    places.add(Eigen::Vector3d(std::sin(3 * t), std::exp(-t) * std::cos(9 * t), std::abs(std::sin(2 * t))));
    turns.add(Eigen::Quaterniond(Eigen::AngleAxisd(std::sin(5 * t), Eigen::Vector3d(t, 1, -t).normalized())));
  }
  for (const Track& track : {places, turns}) {
    const std::vector<float> times = even_times(700);
    const std::vector<std::size_t> keys = kept_keys(times, track, k_tolerance);
    EXPECT_EQ(keys.front(), 0u);
    EXPECT_EQ(keys.back(), 699u);
    EXPECT_LT(keys.size(), 350u);
    EXPECT_LE(worst(times, track, keys), k_tolerance + 1e-6f);  // single precision
  }
}

}  // namespace
}  // namespace topple::app
