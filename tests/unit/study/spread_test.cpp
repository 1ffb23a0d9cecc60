#include "solver/study/common/spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "solver/io/scene/scene.h"

namespace topple::study {
namespace {

// The bounds are where the proportion seen lies z standard deviations off: (p - b)^2 = z^2 b (1 - b)/n.
TEST(Wilson, bounds_are_those_of_the_score_test) {
  for (const int n : {1, 5, 21, 100})
    for (int k = 0; k <= n; ++k) {
      const double p = static_cast<double>(k) / n;
      const auto [low, high] = wilson(k, n);
      EXPECT_LE(low, p);
      EXPECT_GE(high, p);
      for (const double b : {low, high})
        EXPECT_NEAR((p - b) * (p - b), 1.959964 * 1.959964 * b * (1 - b) / n, 1e-12) << k << " of " << n;
    }
}

TEST(Wilson, has_the_printed_values) {
  EXPECT_EQ(wilson(0, 10).low, 0);
  EXPECT_NEAR(wilson(0, 10).high, 0.2775, 5e-5);  // Brown, Cai, DasGupta 2001: z^2/(n + z^2)
  EXPECT_NEAR(wilson(10, 10).high, 1, 1e-15);
}

TEST(Spread, factors_are_even_and_hold_the_ends_and_the_middle) {
  const std::vector<double> factors = even_factors(21, 0.05);
  ASSERT_EQ(factors.size(), 21u);
  EXPECT_DOUBLE_EQ(factors.front(), 0.95);
  EXPECT_DOUBLE_EQ(factors[10], 1);
  EXPECT_DOUBLE_EQ(factors.back(), 1.05);
  EXPECT_NEAR(factors[1] - factors[0], 0.005, 1e-15);
}

// The scene's pulse is the least that overturns a rigid block, by Housner's theory.
TEST(Spread, a_block_falls_above_the_least_pulse_and_not_below) {
  const io::Scene scene = io::load_scene("verify/rocking-half-sine-4-above");
  const std::vector<double> factors{0.9, 0.95, 1.05, 1.1};
  for (const int jobs : {1, 2}) {
    const std::vector<Trial> trials = try_factors(scene.setup, factors, jobs, [](int) { return true; });
    ASSERT_EQ(trials.size(), factors.size());
    for (std::size_t k = 0; k < trials.size(); ++k) {
      EXPECT_EQ(trials[k].factor, factors[k]);
      EXPECT_TRUE(trials[k].finished);
      EXPECT_EQ(trials[k].overturned, std::vector<bool>{factors[k] > 1}) << factors[k];
    }
  }
}

TEST(Spread, what_was_not_begun_is_not_finished) {
  const io::Scene scene = io::load_scene("verify/rocking-half-sine-4-above");
  const std::vector<Trial> trials = try_factors(scene.setup, {1, 1, 1}, 1, [](int) { return false; });
  EXPECT_TRUE(trials[0].finished);
  EXPECT_FALSE(trials[1].finished);
  EXPECT_FALSE(trials[2].finished);
}

// A strap takes what it took at the scene's own shake when its strength is between: it breaks in the
// stronger.
TEST(Spread, fixings_that_break_are_told) {
  const std::string strap =
      "topple = 1\nfloor = {}\nrun = { duration = 2, want = [\"motion\"] }\n"
      "shake = [{ type = \"sine\", frequency = 1, amplitude = 4 }]\n"
      "wall = [{ name = \"wall\", at = [0, 0], normal = [1, 0, 0] }]\n"
      "furniture = [{ kind = \"bookshelf\", name = \"shelf\", against = \"wall\" }]\n"
      "fixing = [{ kind = \"strap\", body = \"shelf\", to = \"wall\", strength = ";
  const auto broke = [&](const std::string& strength) {
    const io::Scene scene = io::parse_scene(strap + strength + " }]", "s.toml");
    std::vector<bool> out;
    for (const Trial& trial : try_factors(scene.setup, {0.8, 1.25}, 1, [](int) { return true; }))
      out.push_back(std::ranges::find(trial.broke, true) != trial.broke.end());
    return out;
  };
  const io::Scene holding = io::parse_scene(strap + "1e6 }]", "s.toml");
  topple::Run run(holding.setup);
  while (run.status().ok() && !run.over()) run.advance();
  double most = 0;
  for (const AnchorOutcome& anchor : run.outcome().anchors()) most = std::max(most, anchor.peak_force);
  ASSERT_GT(most, 10);
  EXPECT_EQ(broke(std::to_string(most)), (std::vector<bool>{false, true}));
  EXPECT_EQ(broke("1e6"), (std::vector<bool>{false, false}));
}

TEST(Spread, records_are_scaled_as_well) {
  const io::Scene scene = io::load_scene("near-fault");
  EXPECT_DOUBLE_EQ(shaken_by(scene.setup, 1.05).parameters.shakes[0].scale,
                   1.05 * scene.setup.parameters.shakes[0].scale);
}

}  // namespace
}  // namespace topple::study
