// Where the references of the rocking scenes are from.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "verification/housner.h"

namespace topple::test {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

const Block k_uniform{0.19, 0.895, 4. / 3};
const Block k_corners{0.2, 1, 2};

// Least amplitude over g tan a that overturns the block at rest.
double least(const Block& block, const Pulse& pulse) {
  constexpr double k_coarse = 5e-3, h = 5e-5, k_duration = 6;
  const auto overturns = [&](double amplitude) {
    return rock(
               block, {0, 0}, [&](double t) { return amplitude * pulse(t); }, k_duration, 20 * h)
        .overturned;
  };
  double high = 1;
  while (!overturns(high)) high += k_coarse;
  double low = high - k_coarse;
  const auto finely = [&](double amplitude) {
    return rock(
               block, {0, 0}, [&](double t) { return amplitude * pulse(t); }, k_duration, h)
        .overturned;
  };
  while (high - low > 1e-7) (finely((low + high) / 2) ? high : low) = (low + high) / 2;
  return high;
}

Pulse half_sine(double w) {
  return [w](double t) { return w * t < std::numbers::pi ? std::sin(w * t) : 0; };
}

Pulse one_sine(double w) {
  return [w](double t) { return w * t < 2 * std::numbers::pi ? std::sin(w * t) : 0; };
}

TEST(RockingBlock, free_rocking_of_the_uniform_block_is_the_reference_of_the_scenes) {
  const Rocking free = rock(
      k_uniform, {k_uniform.critical / 2, 0}, [](double) { return 0.; }, 3.2, 1e-4);
  const double impacts[] = {0.46508904, 1.26166455, 1.96212906, 2.58772990, 3.15221699};
  const double peaks[] = {5.99270706, 4.95920425, 4.16583240, 3.53228486, 3.01441960};
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(free.impacts.at(k), impacts[k], 2e-8) << k;
    EXPECT_NEAR(free.peaks.at(k) / k_degree, peaks[k], 2e-7) << k;
  }
}

TEST(RockingBlock, least_pulses_are_the_references_of_the_scenes) {
  for (const auto& [wp, corners_half, corners_one, uniform_half, uniform_one] :
       {std::array{2., 1.801223949, 1.217703476, 1.801270447, 1.220640488},
        std::array{4., 2.795034411, 1.698219757, 2.795538254, 1.737093353},
        std::array{6., 3.796725428, 3.829277267, 3.797761078, 4.198619003}}) {
    SCOPED_TRACE(wp);
    EXPECT_NEAR(least(k_corners, half_sine(wp * k_corners.p)), corners_half, 1e-5);
    EXPECT_NEAR(least(k_corners, one_sine(wp * k_corners.p)), corners_one, 1e-5);
    EXPECT_NEAR(least(k_uniform, half_sine(wp * k_uniform.p)), uniform_half, 1e-5);
    EXPECT_NEAR(least(k_uniform, one_sine(wp * k_uniform.p)), uniform_one, 1e-5);
  }
}

}  // namespace
}  // namespace topple::test
