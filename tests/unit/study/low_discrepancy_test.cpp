// Points of ensembles: even in every dimension and in pairs, the same everywhere.
#include "solver/study/common/low_discrepancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace topple::study {
namespace {

TEST(LowDiscrepancy, the_first_points_are_those_of_sobol) {
  const double first[] = {0, 0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125};
  const double second[] = {0, 0.5, 0.25, 0.75, 0.375, 0.875, 0.125, 0.625};
  // the sequence in the order of the index, not in that of Gray's code
  for (const int i : {0, 1}) {
    EXPECT_EQ(sobol(static_cast<std::uint32_t>(i), 0), first[i]);
    EXPECT_EQ(sobol(static_cast<std::uint32_t>(i), 1), second[i]);
  }
  for (const auto& [dimension, expected] : {std::pair(0, first), std::pair(1, second)}) {
    std::vector<double> found, wanted(expected, expected + 8);
    for (std::uint32_t i = 0; i < 8; ++i) found.push_back(sobol(i, dimension));
    std::ranges::sort(found);
    std::ranges::sort(wanted);
    EXPECT_EQ(found, wanted);
  }
}

TEST(LowDiscrepancy, each_of_equal_intervals_holds_one_point_in_every_dimension_and_stream) {
  for (int dimension = 0; dimension < k_most_dimensions; ++dimension)
    for (const std::uint64_t stream : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{123456789}})
      for (const int n : {8, 1024}) {
        std::vector<int> count(static_cast<std::size_t>(n));
        for (int i = 0; i < n; ++i) {
          const double u = shifted_sobol(stream, static_cast<std::uint32_t>(i), dimension);
          ASSERT_TRUE(u > 0 && u < 1);
          ++count[static_cast<std::size_t>(u * n)];
        }
        EXPECT_EQ(std::ranges::count(count, 1), n) << dimension << ' ' << stream;
      }
}

/// Star discrepancy in two dimensions on a grid of corners: a lower bound of it within 1/32.
double discrepancy(const std::vector<std::pair<double, double>>& points) {
  constexpr int k_corners = 64;
  double worst = 0;
  for (int a = 1; a <= k_corners; ++a)
    for (int b = 1; b <= k_corners; ++b) {
      const double x = a / double(k_corners), y = b / double(k_corners);
      const auto inside =
          std::ranges::count_if(points, [&](const auto& p) { return p.first < x && p.second < y; });
      worst =
          std::max(worst, std::abs(static_cast<double>(inside) / static_cast<double>(points.size()) - x * y));
    }
  return worst;
}

// Of 512 random points the expected discrepancy is about 0.04; of the sequence O(log^2 n/n).
TEST(LowDiscrepancy, pairs_of_dimensions_are_far_more_even_than_random_points) {
  constexpr int k_points = 512;
  std::mt19937 rng(3);
  std::vector<std::pair<double, double>> random;
  for (int i = 0; i < k_points; ++i) {
    const double x = static_cast<double>(rng()) / 0x1p32;
    random.emplace_back(x, static_cast<double>(rng()) / 0x1p32);
  }
  const double of_random = discrepancy(random);
  for (int a = 0; a < k_most_dimensions; ++a)
    for (int b = 0; b < a; ++b) {
      std::vector<std::pair<double, double>> points;
      for (std::uint32_t i = 0; i < k_points; ++i)
        points.emplace_back(shifted_sobol(5, i, a), shifted_sobol(5, i, b));
      EXPECT_LT(discrepancy(points), 0.6 * of_random) << a << ' ' << b;
    }
}

TEST(LowDiscrepancy, streams_are_independent) {
  double sum = 0;
  for (std::uint64_t stream = 0; stream < 4096; ++stream)
    sum += (shifted_sobol(stream, 0, 0) - 0.5) * (shifted_sobol(stream + 1, 0, 0) - 0.5);
  EXPECT_LT(std::abs(sum / 4096), 4. / 12 / std::sqrt(4096.));  // four standard deviations
}

// erfc of the library is right to 1e-15; an error of z by 1e-15 z is one of Phi by z^2 1e-15.
TEST(LowDiscrepancy, the_quantile_of_the_normal_distribution_inverts_it) {
  for (int e = 1; e <= 300; ++e) {
    const double u = std::pow(10., -e), z = normal_quantile(u);
    EXPECT_NEAR(normal_probability(z) / u, 1, 4e-15 * (1 + z * z)) << u;
  }
  for (int i = 1; i < 1000; ++i) {
    const double u = i / 1000.;
    EXPECT_NEAR(normal_probability(normal_quantile(u)), u, 2e-15);
    EXPECT_NEAR(normal_quantile(u), -normal_quantile(1 - u), 1e-13);
  }
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
}

}  // namespace
}  // namespace topple::study
