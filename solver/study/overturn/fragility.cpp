#include "solver/study/overturn/fragility.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "solver/math/types.h"
#include "solver/study/common/spread.h"

namespace topple::study {
namespace {

double normal(double z) {
  return std::erfc(-z / std::numbers::sqrt2) / 2;
}

double density(double z) {
  return std::exp(-z * z / 2) / std::sqrt(2 * k_pi);
}

/// n ln(n/expected); nothing of nothing.
double share(double n, double expected) {
  return n > 0 ? n * std::log(n / expected) : 0;
}

using Pair = Eigen::Vector2d;

/// Of the line z = c[0] + c[1] ln a.
double deviance(const std::vector<Level>& levels, const Pair& c) {
  double sum = 0;
  for (const auto& [a, n, k] : levels) {
    const double z = c[0] + c[1] * std::log(a);
    sum += 2 * (share(k, n * normal(z)) + share(n - k, n * normal(-z)));
  }
  return sum;
}

struct Information {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Pair score = Pair::Zero();
};

Information information(const std::vector<Level>& levels, const Pair& c) {
  Information out;
  for (const auto& [a, n, k] : levels) {
    const Pair row(1, std::log(a));
    const double z = c.dot(row), p = normal(z), q = normal(-z), d = density(z);
    if (!(p * q > 0)) continue;
    out.matrix += n * d * d / (p * q) * row * row.transpose();
    out.score += d * (k - n * p) / (p * q) * row;
  }
  return out;
}

std::string why_none(const std::vector<Level>& levels, const std::string& verb) {
  constexpr double k_far = std::numeric_limits<double>::infinity();
  double least_hit = k_far, most_hit = 0, least_miss = k_far, most_miss = 0;
  for (const auto& [a, n, k] : levels) {
    if (k > 0) least_hit = std::min(least_hit, a), most_hit = std::max(most_hit, a);
    if (k < n) least_miss = std::min(least_miss, a), most_miss = std::max(most_miss, a);
  }
  if (levels.empty()) return "there is no run";
  if (most_hit == 0) return "no run " + verb;
  if (most_miss == 0) return "every run " + verb;
  if (most_miss < least_hit)
    return fmt::format("every run {} from {:.4g} on and none up to {:.4g}: the median lies between", verb,
                       least_hit, most_miss);
  if (levels.size() == 1) return fmt::format("there are runs at {:.4g} alone", least_hit);
  if (most_miss == least_hit) {
    const Level& level = *std::ranges::find(levels, least_hit, &Level::intensity);
    const Interval share = wilson(level.hits, level.runs);
    double before = 0, after = k_far;
    for (const Level& other : levels) {
      if (other.runs == 0) continue;
      if (other.intensity < least_hit) before = std::max(before, other.intensity);
      if (other.intensity > least_hit) after = std::min(after, other.intensity);
    }
    return fmt::format(
        "runs differ at {:.4g} alone ({} of {}): the median lies {}", least_hit, level.hits, level.runs,
        share.low <= 0.5 && 0.5 <= share.high ? "near it, above or below"
        : share.high < 0.5 ? (after < k_far ? fmt::format("between it and {:.4g}", after) : "beyond it")
                           : (before > 0 ? fmt::format("between {:.4g} and it", before) : "below it"));
  }
  if (most_hit <= least_miss) return "it does not become more frequent";
  return "";
}

}  // namespace

double Lognormal::probability(double intensity) const {
  return normal(std::log(intensity / median) / beta);
}

double Lognormal::scatter() const {
  if (freedom <= 0) return 1;
  // quantile 0.999 of chi^2 (E. B. Wilson and M. M. Hilferty, 1931)
  const double part = 2. / (9 * freedom);
  const double most_by_chance = freedom * std::pow(1 - part + 3.0902 * std::sqrt(part), 3);
  return deviance > most_by_chance ? std::sqrt(deviance / freedom) : 1;
}

Interval Lognormal::median_interval() const {
  const double factor = std::exp(k_95 * median_error / median);
  return {median / factor, median * factor};
}

Interval Lognormal::beta_interval() const {
  const double factor = std::exp(k_95 * beta_error / beta);
  return {beta / factor, beta * factor};
}

Fragility fit_fragility(const std::vector<Level>& all, const std::string& verb) {
  constexpr int k_most_steps = 100;
  std::vector<Level> levels;
  std::ranges::copy_if(all, std::back_inserter(levels), [](const Level& level) { return level.runs > 0; });
  if (std::string why = why_none(levels, verb); !why.empty()) return {std::nullopt, std::move(why)};
  double runs = 0, mean = 0;
  for (const Level& level : levels) {
    runs += level.runs;
    mean += level.runs * std::log(level.intensity);
  }
  mean /= runs;
  // about its mean ln a the line's two numbers are almost independent
  for (Level& level : levels) level.intensity /= std::exp(mean);
  Pair c(0, 1);
  double now = deviance(levels, c);
  for (int step = 0; step < k_most_steps; ++step) {
    const Information at = information(levels, c);
    Pair way = at.matrix.ldlt().solve(at.score);
    if (!way.allFinite()) break;
    double next = deviance(levels, c + way);
    for (int k = 0; !(next <= now) && k < 60; ++k) next = deviance(levels, c + (way /= 2));
    c += way;
    now = next;
    if (way.norm() < 1e-11 * c.norm()) break;
  }
  if (!(c[1] > 0)) return {std::nullopt, "it does not become more frequent"};
  const Information at = information(levels, c);
  if (!c.allFinite() || !std::isfinite(now) || at.score.norm() > 1e-6 * runs)
    return {std::nullopt, "the likelihood has no maximum that could be found"};
  // ln median = mean - c0/c1, beta = 1/c1
  const Eigen::Matrix2d covariance = at.matrix.inverse();
  const Pair of_median(-1 / c[1], c[0] / (c[1] * c[1])), of_beta(0, -1 / (c[1] * c[1]));
  Lognormal fit{};
  fit.median = std::exp(mean - c[0] / c[1]);
  fit.beta = 1 / c[1];
  fit.median_error = fit.median * std::sqrt(of_median.dot(covariance * of_median));
  fit.beta_error = std::sqrt(of_beta.dot(covariance * of_beta));
  fit.deviance = now;
  fit.freedom = static_cast<int>(levels.size()) - 2;
  return {fit, ""};
}

}  // namespace topple::study
