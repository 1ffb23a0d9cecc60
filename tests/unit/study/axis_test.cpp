// Axes of sweeps and the order of their points.
#include "solver/study/common/axis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace topple::study {
namespace {

const io::Scene& paper_a() {
  static const io::Scene scene = io::load_scene("paper-a");
  return scene;
}

TEST(Axis, values_are_in_the_unit_of_the_key_whatever_unit_they_are_given_in) {
  const Axis axis = parse_axis("shake.table.amplitude=0.1 g..2.94199 m/s^2:3", paper_a());
  EXPECT_EQ(axis.unit, "gal");
  EXPECT_EQ(axis.table, "shake");
  EXPECT_EQ(axis.name, "amplitude");
  EXPECT_EQ(axis.entry, 0);
  EXPECT_EQ(axis.values, (std::vector<double>{98.0665, 196.133, 294.199}));
  EXPECT_NEAR(axis.own.value(), 190, 1e-12);
  EXPECT_EQ(axis.change(1), "shake.table.amplitude=196.133 gal");
  EXPECT_NEAR(axis.in_si(2), 2.94199, 1e-15);
}

TEST(Axis, spacing_is_logarithmic_from_a_ratio_of_five_on_unless_it_is_named) {
  const auto is_log = [](const std::string& text) { return parse_axis(text, paper_a()).logarithmic; };
  EXPECT_TRUE(is_log("shake.1.frequency=0.2 Hz..5 Hz:3"));
  EXPECT_TRUE(is_log("shake.1.frequency=1..5:3"));
  EXPECT_FALSE(is_log("shake.1.frequency=1..4.9:3"));
  EXPECT_FALSE(is_log("contact.friction=0..1:3"));
  EXPECT_FALSE(is_log("shake.1.frequency=0.2..5:3lin"));
  EXPECT_TRUE(is_log("shake.1.frequency=1..2:3 log"));
  EXPECT_EQ(parse_axis("shake.1.frequency=0.25..4:3", paper_a()).values, (std::vector<double>{0.25, 1, 4}));
}

TEST(Axis, a_change_gives_the_scene_its_value) {
  const Axis axis = parse_axis("shake.1.frequency=0.2..5:7", paper_a());
  for (int i = 0; i < axis.count(); ++i)
    EXPECT_EQ(io::load_scene("paper-a", {axis.change(i)}).setup.parameters.shakes[0].frequency,
              axis.in_si(i));
}

TEST(Axis, cells_meet_between_the_values) {
  const std::vector<double> edges = parse_axis("shake.1.frequency=1..16:3", paper_a()).edges();
  const double expected[] = {0.5, 2, 8, 32};
  ASSERT_EQ(edges.size(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(edges[k], expected[k]);
}

TEST(Axis, what_cannot_be_swept_is_refused_in_one_line) {
  const auto refused = [](const std::string& text, const std::string& part) {
    try {
      parse_axis(text, paper_a());
      ADD_FAILURE() << text;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  };
  refused("", "expected KEY=FROM..TO:N");
  refused("contact.friction=0.1:3", "expected KEY=FROM..TO:N");
  refused("contact.friction=0.1..0.9", "expected KEY=FROM..TO:N");
  refused("contact.friction=0.1..0.9:1", "\"1\" is not a whole number in 2..200");
  refused("contact.friction=0.1..0.9:3x", "\"3x\" is not");
  refused("contact.friction=0.1..2:3", "contact.friction: 2 is outside 0..1.5");
  refused("contact.friction=0.9..0.1:3", "FROM must be less than TO");
  refused("contact.friction=0..1:3log", "a logarithmic axis begins above 0");
  refused("contact.friction=0.1..0.1000001:3", "too near each other");
  refused("shake.1.amplitude=1 kg..2 kg:3", "\"1 kg\" ");
  refused("shake.2.amplitude=1..2:3", "shake.2: no such entry; known: ");
  try {
    axis_of("--y", "shake.2.amplitude=1..2:3", paper_a());
    ADD_FAILURE();
  } catch (const io::InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("--y shake.2: no such entry; known: "), 0u) << error.what();
  }
  refused("cabinet.free.model=1..2:3", "cabinet.free.model: is no key that takes one number");
  refused("run.gravity=1..2:3", "is no key that takes one number");
  refused("nothing.here=1..2:3", "is no key that takes one number");
}

TEST(CoarseToFine, every_point_comes_once_and_each_stride_before_the_next) {
  for (const auto& [nx, ny] : {std::pair{24, 24}, {2, 2}, {2, 17}, {9, 5}}) {
    const std::vector<int> order = coarse_to_fine(nx, ny);
    std::vector<int> sorted = order, all(static_cast<std::size_t>(nx * ny));
    std::iota(all.begin(), all.end(), 0);
    std::ranges::sort(sorted);
    EXPECT_EQ(sorted, all);
  }
  // 24 = 8 + 8 + 8: 0, 8, 16 and 23 of both axes, then the multiples of 4, of 2
  const std::vector<int> order = coarse_to_fine(24, 24);
  const auto within = [&](int count, int stride) {
    return std::all_of(order.begin(), order.begin() + count, [&](int p) {
      const int i = p % 24, j = p / 24;
      return (i % stride == 0 || i == 23) && (j % stride == 0 || j == 23);
    });
  };
  EXPECT_TRUE(within(4 * 4, 8));
  EXPECT_TRUE(within(7 * 7, 4));
  EXPECT_TRUE(within(13 * 13, 2));
  EXPECT_FALSE(within(13 * 13 + 1, 2));
}

TEST(Scattered, is_even_and_has_no_pattern_over_neighbours) {
  double sum = 0, squares = 0, neighbours = 0;
  constexpr int k_side = 200;
  for (int a = 0; a < k_side; ++a)
    for (int b = 0; b < k_side; ++b) {
      const double u = scattered(a, b) - 0.5;
      EXPECT_LT(std::abs(u), 0.5);
      sum += u;
      squares += u * u;
      neighbours += u * (scattered(a, b + 1) - 0.5);
    }
  // four standard deviations of the mean of k_side^2 draws
  const double n = k_side * k_side;
  EXPECT_LT(std::abs(sum / n), 4 * std::sqrt(1 / 12. / n));
  EXPECT_LT(std::abs(squares / n - 1 / 12.), 4 * std::sqrt(1 / 180. / n));
  EXPECT_LT(std::abs(neighbours / n), 4 / 12. / std::sqrt(n));
}

}  // namespace
}  // namespace topple::study
