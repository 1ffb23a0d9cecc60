// Fits give back what synthetic outcomes were made with, and look at nothing that was left out.
#include "solver/study/validate/granite_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/math/types.h"
#include "solver/study/common/axis.h"
#include "solver/study/common/parallel.h"
#include "solver/study/validate/granite_rigid.h"
#include "solver/study/validate/granite_study.h"

namespace topple::study {
namespace {

constexpr std::size_t k_rock = 0;
constexpr std::size_t k_tests = 90;

/// Bursts of 2 s of one frequency each, 0.7 to 4 Hz, as strong as fells some rocks.
std::vector<GraniteTest> bursts() {
  std::vector<GraniteTest> tests;
  for (std::size_t n = 0; n < k_tests; ++n) {
    const double frequency = 0.7 * std::pow(4 / 0.7, scattered(n, 0)),
                 amplitude = (0.3 + 1.7 * frequency * scattered(n, 1)) * (scattered(n, 2) < 0.5 ? -1 : 1);
    AccelerogramComponent x;
    x.interval = 0.01;
    for (int i = 0; i <= 200; ++i)
      x.samples.push_back(amplitude * std::sin(2 * k_pi * frequency * i * x.interval) *
                          std::sin(k_pi * i / 200.));
    GraniteTest test;
    test.number = static_cast<int>(n);
    test.peak_velocity = std::abs(amplitude) / (2 * k_pi * frequency);
    test.motion = make_accelerogram({x});
    tests.push_back(std::move(test));
  }
  return tests;
}

std::vector<bool> falls_in(const Rock& rock, const std::vector<GraniteTest>& tests) {
  return falls(rocks()[k_rock], rock, tests, 1, [] { return false; });
}

struct Runs {
  std::vector<GraniteTest> tests = bursts();
  RunTable designed_runs = RunTable(k_design, std::string(k_tests, '0')),
           plain_runs = RunTable(k_plain, std::string(k_tests, '0'));

  Runs() {
    for_each_case(
        k_design + k_plain, 2,
        [&](int k, int) {
          std::string& row = k < k_design ? designed_runs[static_cast<std::size_t>(k)]
                                          : plain_runs[static_cast<std::size_t>(k - k_design)];
          const std::vector<bool> fell = falls_in(k < k_design ? designed(k) : plain(k - k_design), tests);
          for (std::size_t i = 0; i < k_tests; ++i)
            if (fell[i]) row[i] = '1';
        },
        [](int) { return true; });
  }
};
const Runs& runs() {
  static const Runs all;
  return all;
}

/// Outcomes of rocks that scatter about a median.
std::vector<GraniteTest> with_outcomes(const Rock& median, double edge_scatter) {
  std::vector<GraniteTest> tests = runs().tests;
  for (std::size_t i = 0; i < k_tests; ++i) {
    const auto normal = [&](std::uint64_t what) {  // Box and Muller
      return std::sqrt(-2 * std::log(1 - scattered(i, 10 + what))) *
             std::cos(2 * k_pi * scattered(i, 20 + what));
    };
    Rock rock = median;
    rock.left *= std::exp(edge_scatter * normal(0));
    rock.right *= std::exp(edge_scatter * normal(1));
    tests[i].fell[k_rock] = falls_in(rock, {tests[i]}).front();
  }
  return tests;
}

// 90 outcomes, half of them falls, tell an edge to about 15 %; three times that is the tolerance. A block
// with its edges exchanged, or a factor of 1 in place of 0.8, lies outside.
TEST(GraniteFit, known_edges_and_a_known_factor_come_back) {
  const Rock truth{0.020, 0.040, 0.8, 1.6};
  const std::vector<GraniteTest> tests = with_outcomes(truth, 0.15);
  const RockFindings found = fit_rock(tests, k_rock, runs().designed_runs, runs().plain_runs);
  EXPECT_NEAR(std::log(found.fitted.median.left / truth.left), 0, 0.4);
  EXPECT_NEAR(std::log(found.fitted.median.right / truth.right), 0, 0.4);
  EXPECT_NEAR(found.fitted.median.restitution, truth.restitution, 0.12);
  EXPECT_LE(found.low.median.inertia, truth.inertia);
  EXPECT_GE(found.high.median.inertia, truth.inertia);
  EXPECT_LE(found.low.median.left, truth.left);
  EXPECT_GE(found.high.median.left, truth.left);
  EXPECT_LE(found.low.median.right, truth.right);
  EXPECT_GE(found.high.median.right, truth.right);
  int right = 0;
  for (std::size_t i = 0; i < k_tests; ++i)
    right += (found.crossed.probability[i] > 0.5) == tests[i].fell[k_rock];
  EXPECT_GT(right, 0.75 * k_tests);  // what scatters cannot be known; half of them fall
  ASSERT_EQ(found.members.size(), std::size_t{k_members});
}

// Of the outcomes of a fold nothing enters what predicts that fold, to the bit; they do enter the others.
TEST(GraniteFit, a_held_back_outcome_changes_no_prediction_of_its_fold) {
  std::vector<GraniteTest> tests = with_outcomes({0.025, 0.03, 0.9, 1.6}, 0.15);
  const RockFindings before = fit_rock(tests, k_rock, runs().designed_runs, runs().plain_runs);
  constexpr std::size_t k_fold = 3;
  for (std::size_t i = k_fold; i < k_tests; i += k_folds) tests[i].fell[k_rock] = !tests[i].fell[k_rock];
  const RockFindings after = fit_rock(tests, k_rock, runs().designed_runs, runs().plain_runs);
  int changed = 0;
  for (std::size_t i = 0; i < k_tests; ++i) {
    if (i % k_folds == k_fold) {
      EXPECT_EQ(before.crossed.probability[i], after.crossed.probability[i]) << i;
      EXPECT_EQ(before.crossed.by_threshold[i], after.crossed.by_threshold[i]) << i;
      EXPECT_EQ(before.crossed.by_plain[i], after.crossed.by_plain[i]) << i;
    } else {
      changed += before.crossed.probability[i] != after.crossed.probability[i];
    }
  }
  EXPECT_GT(changed, 0);
}

// Of what is held back as a half nothing is looked at, whichever rock had it fall: neither edges, factors and
// inertia nor the baselines.
TEST(GraniteFit, a_half_that_is_held_back_changes_nothing_that_is_said_of_it) {
  std::vector<GraniteTest> tests = with_outcomes({0.025, 0.03, 0.9, 1.6}, 0.15);
  const std::vector<Half> before = fit_rock(tests, k_rock, runs().designed_runs, runs().plain_runs).halves;
  ASSERT_EQ(before.size(), 2 + 2 * k_random_halves);
  constexpr std::size_t k_half = 5;
  for (std::size_t i = 0; i < k_tests; ++i)
    if (!before[k_half].used[i]) tests[i].fell[k_rock] = !tests[i].fell[k_rock];
  const std::vector<Half> after = fit_rock(tests, k_rock, runs().designed_runs, runs().plain_runs).halves;
  EXPECT_EQ(before[k_half].used, after[k_half].used);
  EXPECT_EQ(before[k_half].predictions.probability, after[k_half].predictions.probability);
  EXPECT_EQ(before[k_half].predictions.by_threshold, after[k_half].predictions.by_threshold);
  EXPECT_EQ(before[k_half].predictions.by_plain, after[k_half].predictions.by_plain);
  EXPECT_NE(before[k_half - 1].predictions.probability, after[k_half - 1].predictions.probability);
}

// Each cut has as many tests on either side, to one, and comes both ways; random ones differ.
TEST(GraniteFit, halves_are_halves) {
  const std::vector<std::vector<bool>> halves = halves_of(11);
  for (std::size_t k = 0; k < halves.size(); k += 2) {
    EXPECT_NEAR(static_cast<double>(std::ranges::count(halves[k], true)), 5.5, 0.5);
    for (std::size_t i = 0; i < 11; ++i) EXPECT_NE(halves[k][i], halves[k + 1][i]);
  }
  for (std::size_t k = 2; k < halves.size(); k += 2) EXPECT_NE(halves[k], halves[k - 2]);
}

TEST(GraniteFit, a_weight_of_none_is_as_a_test_that_is_not_there) {
  const std::vector<GraniteTest> tests = with_outcomes({0.025, 0.03, 0.9, 1.6}, 0.15);
  const RockFit fit(runs().designed_runs);
  std::vector<bool> fell;
  for (const GraniteTest& test : tests) fell.push_back(test.fell[k_rock]);
  std::vector<double> weight(k_tests, 1);
  weight[5] = 0;
  const std::vector<double> one = fit.belief(fell, weight);
  fell[5] = !fell[5];
  EXPECT_EQ(one, fit.belief(fell, weight));
  weight[5] = 1;
  EXPECT_NE(one, fit.belief(fell, weight));
}

// The same bytes go in and out, so that other tests are predicted by what was fitted.
TEST(GraniteFit, comes_back_from_its_file) {
  GraniteFit fit;
  fit.tests = 90;
  const std::vector<GraniteTest> tests = with_outcomes({0.025, 0.03, 0.9, 1.6}, 0.15);
  fit.rocks.fill(fit_rock(tests, k_rock, runs().designed_runs, runs().plain_runs));
  const std::string text = fit_as_json(fit).dump();
  const GraniteFit read = fit_from_json(text, "fit.json");
  for (std::size_t k = 0; k < k_rocks; ++k) {
    EXPECT_NEAR(read.rocks[k].fitted.median.left, fit.rocks[k].fitted.median.left, 1e-6);
    EXPECT_NEAR(read.rocks[k].threshold, fit.rocks[k].threshold, 1e-6);
    EXPECT_NEAR(read.rocks[k].members[7].right, fit.rocks[k].members[7].right, 1e-6);
  }
}

/// A push of half a sine over `duration`, s, then nothing until 4 s.
GraniteTest push(double peak, double duration) {
  AccelerogramComponent x;
  x.interval = 0.01;
  for (int i = 0; i <= 400; ++i)
    x.samples.push_back(i * x.interval < duration ? peak * std::sin(k_pi * i * x.interval / duration) : 0);
  GraniteTest test;
  test.motion = make_accelerogram({x});
  return test;
}

// A slow push that overturns a block of theory: both models say so, and a weaker one leaves both standing.
TEST(GraniteFit, the_rigid_model_falls_where_the_planar_block_does) {
  const Rock rock{0.03, 0.03, 1, 1};
  for (const double share : {0.9, 1.6}) {
    const GraniteTest test = push(share * 9.80665 * 0.03 / 0.294, 1);
    EXPECT_EQ(falls_in(rock, {test}).front(), share > 1) << share;
    EXPECT_EQ(rigid_falls(rocks()[k_rock], rock, test, [] { return false; }), share > 1) << share;
  }
}

// Free rocking reaches each landing with the rate that the one before left: of two in a row, one on either
// edge, Housner's rates (angular momentum about the new edge) times the square of the factor. Contacts that
// give way are worth 0.5 and 1 %; the factors 28 and 64 %.
TEST(GraniteFit, landings_of_the_rigid_model_leave_the_factor_on_housners_rate) {
  const RockTraits& traits = rocks()[k_rock];
  for (const double factor : {0.85, 0.6}) {
    const Rock rock{0.03, 0.025, factor, 1.3};
    RigidRock rigid(traits, rock, push(1.55 * 9.80665 * rock.left / traits.height, 0.45));
    std::vector<double> rates;
    double tilt_before = 0, square_before = 0;
    while (!rigid.over()) {
      const double tilt = rigid.tilt(), square = rigid.rate() * rigid.rate();
      rigid.advance();
      // its square goes on in proportion to the small tilt that is left when the last step before it ends
      if (tilt * rigid.tilt() < 0 && square > 0.05 * 0.05)
        rates.push_back(std::sqrt(square - (square - square_before) / (tilt - tilt_before) * tilt));
      tilt_before = tilt;
      square_before = square;
    }
    ASSERT_GE(rates.size(), 3u);
    const double about_middle = traits.inertia_over_mass * rock.inertia + traits.height * traits.height,
                 kept = about_middle - rock.left * rock.right;
    const double wanted = kept / (about_middle + rock.left * rock.left) * kept /
                          (about_middle + rock.right * rock.right) * factor * factor;
    EXPECT_NEAR(rates[2] / rates[0], wanted, 0.015 * wanted) << factor;
  }
}

}  // namespace
}  // namespace topple::study
