#include "app/furnish/snap.h"

#include <gtest/gtest.h>

#include <cmath>

namespace topple::app {
namespace {

const WallLine k_back{{-2, 0}, {1, 0}}, k_side{{0, 2}, {0, -1}};

Footprint footprint(double x, double y, double yaw = 0) {
  return {{{x, y}, yaw}, {0.2, 0.45}};
}

TEST(Snap, far_from_all_a_piece_stands_on_the_grid) {
  const Spot spot = snapped(footprint(0.1234, -0.5678), {}, {}, true);
  EXPECT_NEAR(spot.at.x(), 0.12, 1e-12);
  EXPECT_NEAR(spot.at.y(), -0.57, 1e-12);
  EXPECT_EQ(spot.yaw, 0);
}

TEST(Snap, near_a_wall_it_turns_its_back_to_it_a_centimetre_off) {
  const std::vector<WallLine> walls{k_back, k_side};
  Spot spot = snapped(footprint(-1.72, -0.3, 1.2), {}, walls, true);
  EXPECT_NEAR(spot.yaw, 0, 1e-12);
  EXPECT_NEAR(spot.at.x() - 0.2 + 2, k_gap_at_wall, 1e-12);
  EXPECT_NEAR(spot.at.y(), -0.3, 1e-12);
  spot = snapped(footprint(0.4, 1.7), {}, walls, true);
  EXPECT_NEAR(spot.yaw, -k_pi / 2, 1e-12);
  EXPECT_NEAR(2 - spot.at.y() - 0.2, k_gap_at_wall, 1e-12);
}

TEST(Snap, turned_by_hand_it_keeps_its_turn_and_stands_off_by_its_side) {
  const std::vector<WallLine> walls{k_back};
  const Spot spot = snapped(footprint(-1.5, 0.104, k_pi / 2), {}, walls, false);
  EXPECT_NEAR(spot.yaw, k_pi / 2, 1e-12);
  EXPECT_NEAR(spot.at.x() - 0.45 + 2, k_gap_at_wall, 1e-12);
}

TEST(Snap, a_back_at_a_wall_is_told_from_a_side_and_from_far) {
  const std::vector<WallLine> walls{k_back, k_side};
  EXPECT_TRUE(backs_wall(footprint(-1.79, 0), walls));
  EXPECT_FALSE(backs_wall(footprint(-1.54, 0, k_pi / 2), walls));
  EXPECT_FALSE(backs_wall(footprint(-1.5, 0), walls));
  EXPECT_TRUE(backs_wall(footprint(0, 1.79, -k_pi / 2), walls));
}

TEST(Snap, behind_a_wall_it_comes_back_into_the_room) {
  const std::vector<WallLine> walls{k_back};
  EXPECT_NEAR(snapped(footprint(-5, 0), {}, walls, false).at.x(), -2 + 0.2 + k_gap_at_wall, 1e-12);
  EXPECT_NEAR(snapped(footprint(-2, 0.3), {}, walls, true).at.x(), -2 + 0.2 + k_gap_at_wall, 1e-12);
}

TEST(Snap, turned_beside_a_wall_it_stands_off_its_corner) {
  const WallLine wall{{0, 0}, {1, 0}};
  const Footprint turned{{{0.2, 1}, k_pi / 4}, {0.2, 0.45}};
  const Vec2 at = off_walls(turned, std::span(&wall, 1));
  EXPECT_NEAR(at.x(), (0.2 + 0.45) / std::sqrt(2) + k_gap_at_wall, 1e-12);
  EXPECT_EQ(at.y(), 1);
  const Footprint clear{{{2, 1}, k_pi / 4}, {0.2, 0.45}};
  EXPECT_EQ(off_walls(clear, std::span(&wall, 1)), clear.spot.at);
}

TEST(Snap, in_a_corner_it_stands_off_both_walls) {
  const std::vector<WallLine> walls{k_back, k_side};
  const Spot spot = snapped(footprint(-1.75, 1.5), {}, walls, true);
  EXPECT_NEAR(spot.at.x() - 0.2 + 2, k_gap_at_wall, 1e-12);
  EXPECT_NEAR(2 - spot.at.y() - 0.45, k_gap_at_wall, 1e-12);
}

TEST(Snap, beside_another_piece_it_stands_sixty_millimetres_off_with_backs_in_line) {
  const std::vector<Footprint> others{{{{0, 0}, 0}, {0.3, 0.5}}};
  const Spot spot = snapped(footprint(-0.06, 1.0), others, {}, true);
  EXPECT_NEAR(spot.at.y() - 0.45 - 0.5, k_gap_at_piece, 1e-12);
  EXPECT_NEAR(spot.at.x() - 0.2, -0.3, 1e-12);
}

TEST(Snap, never_moves_a_piece_further_than_its_reach) {
  const std::vector<Footprint> others{{{{0, 0}, 0}, {0.3, 0.5}}, {{{1.1, 0.4}, k_pi / 2}, {0.3, 0.5}}};
  const std::vector<WallLine> walls{k_back, k_side};
  for (double x = -1.5; x < 2; x += 0.0371)
    for (double y = -2; y < 1.5; y += 0.0413)
      for (const double yaw : {0., 0.3, k_pi / 2}) {
        const Spot spot = snapped(footprint(x, y, yaw), others, walls, true);
        ASSERT_TRUE(spot.at.allFinite());
        ASSERT_LE((spot.at - Vec2(x, y)).cwiseAbs().maxCoeff(), std::sqrt(2) * k_snap_reach + k_grid)
            << x << ' ' << y;
      }
}

}  // namespace
}  // namespace topple::app
