#include "solver/study/validate/granite_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "solver/study/common/axis.h"
#include "solver/study/common/low_discrepancy.h"
#include "solver/study/validate/block_run.h"
#include "solver/study/validate/scores.h"

namespace topple::study {
namespace {

constexpr double k_least_edge = 0.012, k_most_edge = 0.06;  // m, range of the design
constexpr double k_least_restitution = 0.6;
constexpr double k_most_inertia = 2.5;
// Of the lattice of medians; of edges and inertia in their logarithms.
constexpr double k_step_edge = 0.15, k_step_restitution = 0.05, k_step_inertia = 0.229;
constexpr std::array<double, 2> k_edge_scatters{0.15, 0.25};
constexpr std::array<double, 2> k_restitution_scatters{0.06, 0.12};
constexpr double k_fewest = 10;                 // rocks, in effect, that a share is of
constexpr double k_unlikely = 12;               // ln of a likelihood over the greatest, that counts as none
constexpr double k_far = 4;                     // standard deviations, beyond which a rock has no weight
constexpr std::uint64_t k_stream = 0x6772616e;  // of the design

double between(double low, double high, double part) {
  return low + (high - low) * part;
}

/// Parts 0..1 of the ranges.
Rock rock_at(double left, double right, double restitution, double inertia) {
  const double low = std::log(k_least_edge), high = std::log(k_most_edge);
  return {std::exp(between(low, high, left)), std::exp(between(low, high, right)),
          between(k_least_restitution, 1, restitution), std::pow(k_most_inertia, inertia)};
}

/// Quantile of a normal distribution that is cut at both ends.
double cut_quantile(double u, double middle, double deviation, double low, double high) {
  const double from = normal_probability((low - middle) / deviation),
               to = normal_probability((high - middle) / deviation);
  const double part = std::clamp(between(from, to, u), 1e-12, 1 - 1e-12);
  return std::clamp(middle + deviation * normal_quantile(part), low, high);
}

/// Where a rock lies among others.
std::array<double, 4> place_of(const Rock& rock) {
  return {std::log(rock.left), std::log(rock.right), rock.restitution, std::log(rock.inertia)};
}

/// About this place.
double weight_of(const std::array<double, 4>& rock, const std::array<double, 4>& median,
                 const RockDistribution& of) {
  const std::array<double, 4> deviation{of.edge_scatter, of.edge_scatter, of.restitution_scatter,
                                        k_inertia_scatter};
  double square = 0;
  for (std::size_t d = 0; d < deviation.size(); ++d) {
    const double away = (rock[d] - median[d]) / deviation[d];
    square += away * away;
  }
  return square > k_far * k_far ? 0 : std::exp(-square / 2);
}

std::vector<RockDistribution> lattice() {
  std::vector<RockDistribution> all;
  const auto steps = [](double from, double to, double step, const auto& take) {
    for (int n = 0; from + n * step < to + 1e-9; ++n) take(from + n * step);
  };
  const double low = std::log(k_least_edge), high = std::log(k_most_edge);
  for (const double edges : k_edge_scatters)
    for (const double landing : k_restitution_scatters)
      steps(low, high, k_step_edge, [&](double left) {
        steps(low, high, k_step_edge, [&](double right) {
          steps(k_least_restitution, 1, k_step_restitution, [&](double restitution) {
            steps(0, std::log(k_most_inertia), k_step_inertia, [&](double inertia) {
              all.push_back(
                  {{std::exp(left), std::exp(right), restitution, std::exp(inertia)}, edges, landing});
            });
          });
        });
      });
  return all;
}

/// Rock `k` of a distribution, of points that fill it evenly.
Rock drawn_from(const RockDistribution& from, int k) {
  const auto at = [k](int dimension) {
    return shifted_sobol(k_stream + 1, static_cast<std::uint32_t>(k), dimension);
  };
  const auto of_logarithm = [](double u, double median, double scatter, double low, double high) {
    return std::exp(cut_quantile(u, std::log(median), scatter, std::log(low), std::log(high)));
  };
  const auto edge = [&](double u, double median) {
    return of_logarithm(u, median, from.edge_scatter, k_least_edge, k_most_edge);
  };
  return {edge(at(0), from.median.left), edge(at(1), from.median.right),
          cut_quantile(at(2), from.median.restitution, from.restitution_scatter, k_least_restitution, 1),
          of_logarithm(at(3), from.median.inertia, k_inertia_scatter, 1, k_most_inertia)};
}

Interval middle_of(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double part) {
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {at(0.025), at(0.975)};
}

/// Calls f with every number of a distribution.
template <class Distribution, class F>
void each_number(Distribution& low, Distribution& high, F f) {
  f(low.median.left, high.median.left, [](const RockDistribution& d) { return d.median.left; });
  f(low.median.right, high.median.right, [](const RockDistribution& d) { return d.median.right; });
  f(low.median.restitution, high.median.restitution,
    [](const RockDistribution& d) { return d.median.restitution; });
  f(low.median.inertia, high.median.inertia, [](const RockDistribution& d) { return d.median.inertia; });
  f(low.edge_scatter, high.edge_scatter, [](const RockDistribution& d) { return d.edge_scatter; });
  f(low.restitution_scatter, high.restitution_scatter,
    [](const RockDistribution& d) { return d.restitution_scatter; });
}

/// Bootstrap: B. Efron, Annals of Statistics 7, 1979, 1-26.
void draw_anew(const RockFit& fit, const std::vector<bool>& fell, RockFindings& found) {
  std::vector<RockDistribution> fits;
  for (std::uint64_t n = 0; n < k_draws; ++n) {
    std::vector<double> weight(fell.size());
    for (std::uint64_t i = 0; i < fell.size(); ++i)
      ++weight[static_cast<std::size_t>(scattered(n, i) * static_cast<double>(fell.size()))];
    fits.push_back(fit.mean(fit.belief(fell, weight)));
  }
  each_number(found.low, found.high, [&](double& low, double& high, const auto& of) {
    std::vector<double> values;
    for (const RockDistribution& one : fits) values.push_back(of(one));
    const Interval interval = middle_of(std::move(values));
    low = interval.low, high = interval.high;
  });
}

}  // namespace

std::vector<bool> falls(const RockTraits& traits, const Rock& rock, const std::vector<GraniteTest>& tests,
                        double factor, const std::function<bool()>& give_up) {
  planar::Block block;
  block.inertia = traits.inertia_over_mass * rock.inertia;
  block.left = rock.left, block.right = rock.right, block.height = traits.height;
  block.static_friction = block.kinetic_friction = k_rough;
  block.restitution = rock.restitution;
  std::vector<BlockRun> runs;
  for (const GraniteTest& test : tests) runs.push_back({block, test.motion, factor, k_after_record});
  return overturns(runs, give_up);
}

Rock designed(int k) {
  const auto at = [k](int dimension) {
    return shifted_sobol(k_stream, static_cast<std::uint32_t>(k), dimension);
  };
  return rock_at(at(0), at(1), at(2), at(3));
}

Rock plain(int k) {
  constexpr double k_last = k_plain_edges - 1;
  return rock_at(k % k_plain_edges / k_last, k / k_plain_edges / k_last, 1, 0);
}

RockFit::RockFit(const RunTable& runs) : tests_(runs.front().size()) {
  std::vector<std::array<double, 4>> places;
  for (int k = 0; k < static_cast<int>(runs.size()); ++k) places.push_back(place_of(designed(k)));
  std::vector<double> sum(tests_);
  for (const RockDistribution& one : lattice()) {
    double total = 0, squares = 0;
    const std::array<double, 4> median = place_of(one.median);
    std::ranges::fill(sum, 0.);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double weight = weight_of(places[k], median, one);
      if (weight == 0) continue;
      total += weight, squares += weight * weight;
      for (std::size_t i = 0; i < tests_; ++i) sum[i] += runs[k][i] == '1' ? weight : 0;
    }
    if (!(total * total >= k_fewest * squares)) continue;
    candidate_.push_back(one);
    for (const double hits : sum) {
      const double q = between(k_unknown, 1 - k_unknown, hits / total);
      share_.push_back(hits / total);
      log_yes_.push_back(std::log(q));
      log_no_.push_back(std::log(1 - q));
    }
  }
}

std::vector<double> RockFit::belief(const std::vector<bool>& fell, const std::vector<double>& weight) const {
  std::vector<double> belief(candidates());
  for (std::size_t c = 0; c < candidates(); ++c)
    for (std::size_t i = 0; i < tests_; ++i)
      if (weight[i] > 0) belief[c] += weight[i] * (fell[i] ? log_yes_ : log_no_)[c * tests_ + i];
  const double most = *std::ranges::max_element(belief);
  double sum = 0;
  for (double& one : belief) sum += one = one > most - k_unlikely ? std::exp(one - most) : 0;
  for (double& one : belief) one /= sum;
  return belief;
}

double RockFit::probability(const std::vector<double>& belief, std::size_t test) const {
  double sum = 0;
  for (std::size_t c = 0; c < candidates(); ++c) sum += belief[c] * share_[c * tests_ + test];
  return sum;
}

RockDistribution RockFit::mean(const std::vector<double>& belief) const {
  const auto over = [&](const auto& of) {
    double sum = 0;
    for (std::size_t c = 0; c < candidates(); ++c)
      if (belief[c] > 0) sum += belief[c] * of(candidate_[c]);
    return sum;
  };
  using D = RockDistribution;
  return {{std::exp(over([](const D& d) { return std::log(d.median.left); })),
           std::exp(over([](const D& d) { return std::log(d.median.right); })),
           over([](const D& d) { return d.median.restitution; }),
           std::exp(over([](const D& d) { return std::log(d.median.inertia); }))},
          std::exp(over([](const D& d) { return std::log(d.edge_scatter); })),
          std::exp(over([](const D& d) { return std::log(d.restitution_scatter); }))};
}

std::vector<Rock> RockFit::drawn(const std::vector<double>& belief) const {
  std::vector<double> up_to(belief.size());
  std::partial_sum(belief.begin(), belief.end(), up_to.begin());
  std::vector<Rock> members;
  for (int k = 0; k < k_members; ++k) {
    const double u = shifted_sobol(k_stream + 1, static_cast<std::uint32_t>(k), 4) * up_to.back();
    const auto at = std::ranges::upper_bound(up_to, u);
    const auto c = std::min(static_cast<std::size_t>(at - up_to.begin()), candidates() - 1);
    members.push_back(drawn_from(candidate_[c], k));
  }
  return members;
}

int best_plain(const RunTable& runs, const std::vector<bool>& fell, const std::vector<bool>& used) {
  int best = 0, most = -1;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    int right = 0;
    for (std::size_t i = 0; i < fell.size(); ++i) right += used[i] && (runs[k][i] == '1') == fell[i];
    if (right > most) most = right, best = static_cast<int>(k);
  }
  return best;
}

Predictions predicted(const RockFit& fit, const RunTable& plain_runs, const std::vector<double>& velocity,
                      const std::vector<bool>& fell, const std::vector<bool>& used) {
  const std::vector<double> belief = fit.belief(fell, std::vector<double>(used.begin(), used.end()));
  const std::string& by_plain = plain_runs[static_cast<std::size_t>(best_plain(plain_runs, fell, used))];
  const double threshold = best_threshold(velocity, fell, used);
  Predictions out;
  for (std::size_t i = 0; i < used.size(); ++i) {
    out.probability.push_back(fit.probability(belief, i));
    out.by_threshold.push_back(velocity[i] > threshold);
    out.by_plain.push_back(by_plain[i] == '1');
  }
  return out;
}

std::vector<std::vector<bool>> halves_of(std::size_t tests) {
  std::vector<std::vector<bool>> out;
  const auto add = [&](std::vector<bool> used) {
    out.push_back(used);
    used.flip();
    out.push_back(std::move(used));
  };
  std::vector<bool> used(tests);
  for (std::size_t i = 0; i < tests; i += 2) used[i] = true;
  add(used);
  std::vector<std::size_t> order(tests);
  for (std::uint64_t n = 0; n < k_random_halves; ++n) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [n](std::size_t i) { return scattered(k_half_seed + n, i); });
    for (std::size_t k = 0; k < tests; ++k) used[order[k]] = k < tests / 2;
    add(used);
  }
  return out;
}

RockFindings fit_rock(const std::vector<GraniteTest>& tests, std::size_t rock, const RunTable& designed_runs,
                      const RunTable& plain_runs) {
  std::vector<bool> fell;
  std::vector<double> velocity;
  for (const GraniteTest& test : tests)
    fell.push_back(test.fell[rock]), velocity.push_back(test.peak_velocity);
  const std::size_t count = tests.size();
  const RockFit fit(designed_runs);
  RockFindings found;
  Predictions& crossed = found.crossed;
  crossed = {std::vector<double>(count), std::vector<bool>(count), std::vector<bool>(count)};
  for (std::size_t fold = 0; fold < k_folds; ++fold) {
    std::vector<bool> used(count, true);
    for (std::size_t i = fold; i < count; i += k_folds) used[i] = false;
    const Predictions by_others = predicted(fit, plain_runs, velocity, fell, used);
    for (std::size_t i = fold; i < count; i += k_folds) {
      crossed.probability[i] = by_others.probability[i];
      crossed.by_threshold[i] = by_others.by_threshold[i];
      crossed.by_plain[i] = by_others.by_plain[i];
    }
  }
  for (std::vector<bool>& used : halves_of(count)) {
    Predictions by_others = predicted(fit, plain_runs, velocity, fell, used);
    found.halves.push_back({std::move(used), std::move(by_others)});
  }
  const std::vector<bool> all(count, true);
  const std::vector<double> belief = fit.belief(fell, std::vector<double>(count, 1));
  found.fitted = fit.mean(belief);
  found.members = fit.drawn(belief);
  for (std::size_t i = 0; i < count; ++i) found.in_sample.push_back(fit.probability(belief, i));
  found.threshold = best_threshold(velocity, fell, all);
  found.plain = plain(best_plain(plain_runs, fell, all));
  draw_anew(fit, fell, found);
  return found;
}

}  // namespace topple::study
