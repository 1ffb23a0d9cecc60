// Lognormal fragility by maximum likelihood.
#include "solver/study/overturn/fragility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/study/common/axis.h"

namespace topple::study {
namespace {

constexpr double k_median = 320, k_beta = 0.35;

const Lognormal k_true{k_median, k_beta, 0, 0, 0, 0};

std::vector<double> intensities() {
  std::vector<double> list;
  for (int k = 0; k < 12; ++k) list.push_back(100 * std::pow(10, k / 11.));
  return list;
}

/// As many draws at each intensity as `runs`.
std::vector<Level> drawn(int runs, int sample) {
  std::vector<Level> levels;
  int draw = 0;
  for (const double a : intensities()) {
    Level level{a, runs, 0};
    for (int k = 0; k < runs; ++k) level.hits += scattered(sample, draw++) < k_true.probability(a);
    levels.push_back(level);
  }
  return levels;
}

TEST(Fragility, shares_that_are_a_lognormal_give_it_back) {
  std::vector<Level> levels;
  for (const double a : intensities()) {
    constexpr int k_runs = 100'000'000;
    levels.push_back({a, k_runs, static_cast<int>(std::lround(k_runs * k_true.probability(a)))});
  }
  const Fragility found = fit_fragility(levels);
  ASSERT_TRUE(found.fit) << found.why_not;
  // shares are rounded to 1e-8
  EXPECT_NEAR(found.fit->median / k_median, 1, 1e-6);
  EXPECT_NEAR(found.fit->beta / k_beta, 1, 1e-6);
  EXPECT_LT(found.fit->deviance, 0.01);
  EXPECT_EQ(found.fit->freedom, 10);
}

// Means within four of their standard errors; a standard deviation from 400 samples is 3.5 % uncertain, and
// the next order in 1/runs adds a little.
TEST(Fragility, standard_errors_are_the_spread_of_fits_to_random_runs) {
  constexpr int k_samples = 400;
  double sum[2] = {}, squares[2] = {}, error[2] = {}, deviance = 0;
  for (int sample = 0; sample < k_samples; ++sample) {
    const Fragility found = fit_fragility(drawn(64, sample));
    ASSERT_TRUE(found.fit) << found.why_not;
    const double off[] = {std::log(found.fit->median / k_median), found.fit->beta - k_beta};
    const double stated[] = {found.fit->median_error / found.fit->median, found.fit->beta_error};
    for (int i = 0; i < 2; ++i) {
      sum[i] += off[i] / k_samples;
      squares[i] += off[i] * off[i] / k_samples;
      error[i] += stated[i] / k_samples;
    }
    deviance += found.fit->deviance / k_samples;
  }
  for (int i = 0; i < 2; ++i) {
    const double spread = std::sqrt(squares[i] - sum[i] * sum[i]);
    EXPECT_LT(std::abs(sum[i]), 4 * spread / std::sqrt(k_samples) + 0.003) << i;
    EXPECT_NEAR(error[i] / spread, 1, 0.15) << i;
  }
  EXPECT_GT(deviance, 5);
  EXPECT_LT(deviance, 12);  // chi-squared with ten degrees of freedom, less where shares are 0 or 1
}

// 400 samples: a share of 0.95 has a standard deviation of 0.011. Four of them, and 0.01 for what is of
// higher order in 1/runs.
TEST(Fragility, intervals_of_95_percent_hold_the_truth_so_often) {
  constexpr int k_samples = 400;
  double median = 0, beta = 0;
  for (int sample = 0; sample < k_samples; ++sample) {
    const Lognormal fit = fit_fragility(drawn(64, k_samples + sample)).fit.value();
    const Interval of_median = fit.median_interval(), of_beta = fit.beta_interval();
    median += (of_median.low < k_median && k_median < of_median.high) / double{k_samples};
    beta += (of_beta.low < k_beta && k_beta < of_beta.high) / double{k_samples};
  }
  EXPECT_NEAR(median, 0.95, 0.054);
  EXPECT_NEAR(beta, 0.95, 0.054);
}

// The same runs told over another unit of the same intensity.
TEST(Fragility, a_scaled_intensity_scales_the_median_alone) {
  std::vector<Level> levels = drawn(64, 3);
  const Lognormal fit = fit_fragility(levels).fit.value();
  for (Level& level : levels) level.intensity *= 0.05;
  const Lognormal scaled = fit_fragility(levels).fit.value();
  EXPECT_NEAR(scaled.median / (0.05 * fit.median), 1, 1e-9);
  EXPECT_NEAR(scaled.beta / fit.beta, 1, 1e-9);
}

TEST(Fragility, the_likelihood_is_greatest_at_the_fit) {
  const std::vector<Level> levels = drawn(16, 7);
  const auto log_likelihood = [&](double median, double beta) {
    double sum = 0;
    for (const auto& [a, n, k] : levels) {
      const double p = Lognormal{median, beta, 0, 0, 0, 0}.probability(a);
      if (k > 0) sum += k * std::log(p);
      if (k < n) sum += (n - k) * std::log1p(-p);
    }
    return sum;
  };
  const Lognormal fit = fit_fragility(levels).fit.value();
  const double most = log_likelihood(fit.median, fit.beta);
  for (const double step : {-1e-3, 1e-3}) {
    EXPECT_LT(log_likelihood(fit.median * (1 + step), fit.beta), most);
    EXPECT_LT(log_likelihood(fit.median, fit.beta * (1 + step)), most);
  }
}

TEST(Fragility, where_there_is_no_maximum_it_says_why) {
  const auto why = [](const std::vector<Level>& levels) {
    const Fragility found = fit_fragility(levels);
    EXPECT_FALSE(found.fit);
    return found.why_not;
  };
  EXPECT_EQ(why({}), "there is no run");
  EXPECT_EQ(why({{1, 0, 0}}), "there is no run");
  EXPECT_EQ(why({{1, 9, 0}, {2, 9, 0}}), "no run overturns");
  EXPECT_EQ(why({{1, 9, 9}, {2, 9, 9}}), "every run overturns");
  EXPECT_EQ(why({{1, 9, 0}, {2, 9, 0}, {3, 9, 9}}),
            "every run overturns from 3 on and none up to 2: the median lies between");
  // 4 of 9 are 19 to 73 % (Wilson, 95 %), 2 of 12 are 4.7 to 45 %
  for (const int hits : {2, 4, 5, 7})
    EXPECT_EQ(why({{1, 9, 0}, {2, 9, hits}, {3, 9, 9}}),
              "runs differ at 2 alone (" + std::to_string(hits) +
                  " of 9): the median lies near it, above or below");
  EXPECT_EQ(why({{1, 9, 0}, {2, 12, 2}, {3, 9, 9}}),
            "runs differ at 2 alone (2 of 12): the median lies between it and 3");
  EXPECT_EQ(why({{1, 9, 0}, {2, 9, 1}}), "runs differ at 2 alone (1 of 9): the median lies beyond it");
  EXPECT_EQ(why({{1, 9, 0}, {2, 9, 8}}), "runs differ at 2 alone (8 of 9): the median lies between 1 and it");
  EXPECT_EQ(why({{1, 9, 8}, {2, 9, 9}}), "runs differ at 1 alone (8 of 9): the median lies below it");
  EXPECT_EQ(why({{1, 0, 0}, {2, 9, 4}, {3, 0, 0}}), "there are runs at 2 alone");
  EXPECT_EQ(why({{1, 9, 8}, {2, 9, 4}, {3, 9, 1}}), "it does not become more frequent");
  EXPECT_EQ(why({{1, 9, 9}, {2, 9, 0}}), "it does not become more frequent");
  EXPECT_TRUE(fit_fragility({{1, 9, 0}, {2, 9, 4}, {3, 9, 5}, {4, 9, 9}}).fit);
}

}  // namespace
}  // namespace topple::study
