#include "solver/study/validate/scores.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace topple::study {

Scores scored(const std::vector<Forecast>& forecasts) {
  Scores out;
  for (std::size_t b = 0; b < k_reliability_bins; ++b) {
    out.reliability[b].from = static_cast<double>(b) / k_reliability_bins;
    out.reliability[b].to = static_cast<double>(b + 1) / k_reliability_bins;
  }
  for (const Forecast& one : forecasts) {
    ++out.count;
    out.right += one.right();
    const double error = one.probability - one.measured;
    out.brier += error * error;
    ++(one.measured ? (one.yes() ? out.confusion.hits : out.confusion.misses)
                    : (one.yes() ? out.confusion.false_alarms : out.confusion.correct_rejections));
    const auto bin =
        std::min(static_cast<std::size_t>(one.probability * k_reliability_bins), k_reliability_bins - 1);
    ReliabilityBin& into = out.reliability[bin];
    ++into.count;
    into.yes += one.measured;
    into.mean += one.probability;
  }
  for (ReliabilityBin& bin : out.reliability)
    if (bin.count > 0) bin.mean /= bin.count;
  out.brier /= out.count;
  out.interval = wilson(out.right, out.count);
  return out;
}

double best_threshold(const std::vector<double>& values, const std::vector<bool>& measured,
                      const std::vector<bool>& used) {
  std::vector<std::pair<double, bool>> cases;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (used[i]) cases.emplace_back(values[i], measured[i]);
  if (cases.empty()) return 0;
  std::ranges::sort(cases);
  int right = 0;  // of "always yes"
  for (const auto& [value, yes] : cases) right += yes;
  int most = right;
  std::vector<double> best{cases.front().first / 2};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    right += cases[i].second ? -1 : 1;
    const bool last = i + 1 == cases.size();
    if (!last && cases[i + 1].first == cases[i].first) continue;
    const double at = last ? 2 * cases[i].first : (cases[i].first + cases[i + 1].first) / 2;
    if (right > most) most = right, best.clear();
    if (right == most) best.push_back(at);
  }
  return best[(best.size() - 1) / 2];
}

}  // namespace topple::study
