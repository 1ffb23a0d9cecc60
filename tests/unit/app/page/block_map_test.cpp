// The map under the sliders of a live page, against West's formula and in both languages.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/page/block_map.h"
#include "app/page/page_words.h"
#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

/// Two blocks that are far from each other and do not slide.
io::Scene two_blocks(const std::string& shakes) {
  return io::parse_scene(
      "topple = 1\nfloor = {}\ncontact = { friction = 1 }\n" + shakes +
          "\n[run]\nduration = 3\nwant = [\"motion\"]\n"
          "[[block]]\nname = \"stout\"\nsize = [0.5, 0.5, 1]\nmass = 60\n"
          "[[block]]\nname = \"slender\"\nsize = [0.3, 0.5, 1.5]\nmass = 60\nat = [0, 9]\n",
      "two.toml");
}

const std::string k_sine = "shake = [{ type = \"sine\", frequency = 1, amplitude = 3 }]";

TEST(BlockMap, a_piece_lifts_where_the_floor_exceeds_gravity_times_its_slenderness) {
  const io::Scene scene = two_blocks(k_sine);
  const double gravity = -scene.setup.parameters.gravity.z() / k_gal;
  for (const auto& [body, slenderness] : {std::pair(0, 0.5 / 1.), std::pair(1, 0.3 / 1.5)}) {
    BlockMap map(scene.setup, body);
    ASSERT_FALSE(map.obstacle()) << map.obstacle()->english;
    while (!map.complete()) map.add_point();
    for (int row = 0; row < BlockMap::k_rows; ++row) {
      const double gal = 50 * std::pow(20., row / 17.);
      if (const double over = gal / (gravity * slenderness); over > 1 && over < 1.05)
        continue;  // it turns by less than the angle from which uplift counts
      for (int column = 0; column < BlockMap::k_columns; ++column)
        EXPECT_EQ(map.points()[row * BlockMap::k_columns + column] == BlockMap::Verdict::stands,
                  gal < gravity * slenderness)
            << "piece " << body << ", " << gal << " gal, column " << column;
    }
  }
}

TEST(BlockMap, a_shake_that_is_off_does_not_stand_in_its_way) {
  const BlockMap map(
      two_blocks(
          "shake = [{ type = \"sine\", frequency = 3, amplitude = 3, direction = [0, 1, 0], on = false },"
          " { type = \"sine\", frequency = 2, amplitude = 1 }]")
          .setup,
      0);
  ASSERT_FALSE(map.obstacle());
  EXPECT_EQ(map.shake().frequency, 2);
}

TEST(BlockMap, walls_neighbours_and_anchors_are_left_out) {
  const io::Scene held = io::load_scene("anchored");
  ASSERT_FALSE(held.setup.model.anchors.empty());
  for (int body = 0; body < held.setup.model.furniture_total(); ++body) {
    BlockMap map(held.setup, body);
    ASSERT_FALSE(map.obstacle()) << map.obstacle()->english;
    while (!map.complete()) map.add_point();
    EXPECT_EQ(map.points().front(), BlockMap::Verdict::stands);
    EXPECT_EQ(map.points()[BlockMap::k_columns * (BlockMap::k_rows - 1)], BlockMap::Verdict::overturns);
  }
}

TEST(BlockMap, says_why_there_is_none) {
  const auto obstacle = [](const io::Scene& scene, int body) {
    return std::string(BlockMap(scene.setup, body).obstacle().value_or(Phrase{}).english);
  };
  EXPECT_EQ(obstacle(two_blocks(k_sine), 2), "there is no furniture");
  const std::string no_sine = "the floor moves in another way than one sine";
  EXPECT_EQ(obstacle(two_blocks(""), 0), no_sine);
  EXPECT_EQ(obstacle(io::load_scene("near-fault"), 0), no_sine);
  EXPECT_EQ(obstacle(two_blocks("shake = [{ type = \"sine\", frequency = 1, amplitude = 3, "
                                "building = { storey = 3, of = 8, period = 0.8, damping = 0.03 } }]"),
                     0),
            "the floor is one of a building, which does not follow the sine");
  EXPECT_EQ(
      obstacle(
          two_blocks("shake = [{ type = \"sine\", frequency = 1, amplitude = 3, direction = [0, 0, 1] }]"),
          0),
      "the floor moves up and down only");
  EXPECT_EQ(
      obstacle(
          two_blocks("shake = [{ type = \"sine\", frequency = 1, amplitude = 3, direction = [1, 1, 0] }]"),
          1),
      "it is not symmetric about the plane of its motion");
}

TEST(BlockMap, every_reason_is_said_in_both_languages) {
  for (int k = static_cast<int>(planar::Obstacle::floor); k <= static_cast<int>(planar::Obstacle::jump);
       ++k) {
    const auto kind = static_cast<planar::Obstacle>(k);
    const auto* const found =
        std::ranges::find(page_words::k_obstacles, kind, &page_words::JapaneseObstacle::kind);
    ASSERT_NE(found, std::end(page_words::k_obstacles)) << traits(kind).word;
    EXPECT_FALSE(found->japanese.empty()) << traits(kind).word;
  }
}

}  // namespace
}  // namespace topple::app
