#include "app/chart/lane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace topple::app {
namespace {

/// Greatest distance up or down of a point from the line through `kept`; x of both rises.
double greatest_gap(const std::vector<ImVec2>& points, const std::vector<ImVec2>& kept) {
  double greatest = 0;
  std::size_t k = 0;
  for (const ImVec2& p : points) {
    while (k + 2 < kept.size() && kept[k + 1].x < p.x) ++k;
    const ImVec2 &a = kept[k], &b = kept[k + 1];
    const double on_line = a.y + double(b.y - a.y) * (p.x - a.x) / (b.x - a.x);
    greatest = std::max(greatest, std::abs(on_line - p.y));
  }
  return greatest;
}

TEST(Lane, straight_line_needs_its_ends) {
  std::vector<ImVec2> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(float(i), 3 + 0.25f * float(i));
  const std::vector<ImVec2> kept = without_straight_points(points, 0.2f);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[1].x, 499);
}

TEST(Lane, wave_needs_fewer_points_and_passes_the_others_within_the_tolerance) {
  std::vector<ImVec2> points;
  for (int i = 0; i < 740; ++i) points.emplace_back(float(i), 30 * std::sin(0.1f * float(i)));
  const std::vector<ImVec2> kept = without_straight_points(points, 0.2f);
  EXPECT_LT(kept.size(), points.size() / 2);
  EXPECT_LE(greatest_gap(points, kept), 0.2 + 1e-4);  // rounding of floats
}

TEST(Lane, noise_passes_within_the_tolerance) {
  std::mt19937 rng(1);
  for (const float tolerance : {0.1f, 1.f, 5.f}) {
    std::vector<ImVec2> points{{0, 0}};
    for (int i = 0; i < 1000; ++i)
      points.emplace_back(points.back().x + 0.1f + float(rng() % 3), float(rng() % 10));
    const std::vector<ImVec2> kept = without_straight_points(points, tolerance);
    EXPECT_LE(greatest_gap(points, kept), tolerance + 1e-3);
    EXPECT_EQ(kept.back().x, points.back().x);
  }
}

TEST(Lane, strokes_straight_up_and_single_points_are_kept) {
  const std::vector<ImVec2> stroke{{0, 0}, {1, 0}, {1, 9}, {1, 4}, {2, 4}};
  EXPECT_EQ(without_straight_points(stroke, 0.2f).size(), stroke.size());
  EXPECT_TRUE(without_straight_points({}, 0.2f).empty());
  EXPECT_EQ(without_straight_points(std::vector<ImVec2>{{1, 1}}, 0.2f).size(), 1u);
}

}  // namespace
}  // namespace topple::app
