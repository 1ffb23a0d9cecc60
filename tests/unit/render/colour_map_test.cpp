#include "render/scene/colour_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace topple::render {
namespace {

double luminance(const std::array<std::uint8_t, 3>& c) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(c[0] / 255.0) + 0.7152 * linear(c[1] / 255.0) + 0.0722 * linear(c[2] / 255.0);
}

/// CIE lightness, 0..100.
double lightness(const std::array<std::uint8_t, 3>& c) {
  return 116 * std::cbrt(luminance(c)) - 16;
}

TEST(ColourMap, ends_are_the_published_ones) {
  EXPECT_EQ(colour_table(ColourMap::viridis).front(), (std::array<std::uint8_t, 3>{0x44, 0x01, 0x54}));
  EXPECT_EQ(colour_table(ColourMap::viridis).back(), (std::array<std::uint8_t, 3>{0xfd, 0xe7, 0x25}));
  EXPECT_EQ(colour_table(ColourMap::cividis).front(), (std::array<std::uint8_t, 3>{0x00, 0x22, 0x4e}));
  EXPECT_EQ(colour_table(ColourMap::cividis).back(), (std::array<std::uint8_t, 3>{0xfe, 0xe8, 0x38}));
}

TEST(ColourMap, sequential_maps_grow_lighter_everywhere) {
  for (const ColourMap map :
       {ColourMap::viridis, ColourMap::cividis, ColourMap::viridis_on_dark, ColourMap::cividis_on_dark}) {
    const ColourTable& table = colour_table(map);
    for (std::size_t i = 4; i < table.size(); ++i) {
      EXPECT_GT(luminance(table[i]), luminance(table[i - 4]))
          << "map " << static_cast<int>(map) << " entry " << i;
    }
  }
}

// 3:1 is what WCAG 2.1 asks of graphics; the scene is darkest where the window's dark sheet is.
TEST(ColourMap, maps_on_a_dark_ground_stand_out_from_it_everywhere) {
  const double ground = luminance({24, 28, 33});
  for (const ColourMap map : {ColourMap::viridis_on_dark, ColourMap::cividis_on_dark})
    for (const auto& colour : colour_table(map))
      EXPECT_GT((luminance(colour) + 0.05) / (ground + 0.05), 3) << static_cast<int>(map);
}

TEST(ColourMap, diverging_map_mirrors_its_lightness_about_a_grey_middle) {
  const ColourTable& table = colour_table(ColourMap::diverging);
  for (std::size_t i = 0; i < table.size() / 2; ++i) {
    // The blue end leaves the gamut by a little, which costs up to two units of lightness.
    EXPECT_NEAR(lightness(table[i]), lightness(table[table.size() - 1 - i]), 2.0) << "entry " << i;
  }
  const auto& middle = table[table.size() / 2];
  EXPECT_LE(std::abs(middle[0] - middle[2]), 6);
  EXPECT_GT(table.back()[0], table.back()[2] + 60);
  EXPECT_GT(table.front()[2], table.front()[0] + 60);
}

TEST(ColourMap, values_outside_the_range_take_the_nearest_end) {
  EXPECT_EQ(colour_position(-5, 0, 10), 0);
  EXPECT_EQ(colour_position(15, 0, 10), 1);
  EXPECT_FLOAT_EQ(colour_position(2.5f, 0, 10), 0.25f);
  EXPECT_EQ(colour_position(1, 3, 3), 0);
}

}  // namespace
}  // namespace topple::render
