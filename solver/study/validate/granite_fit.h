// What is fitted to shake-table tests of a rock, and by which rule.
//
// A rock is a planar block without slip, its height that of its mesh. Unknown are the distances of its two
// edges, the factor on the rate that Housner's impact leaves, and a factor on the inertia of its mesh: what
// rolls on a round underside falls as slowly as with so much more. It is put back by hand between tests, so
// they scatter: the logarithms of both distances with one standard deviation, the factor on the rate with
// another, the logarithm of that on the inertia with k_inertia_scatter, cut where the design ends. The
// probability p of falling in a test is the share among rocks so scattered, and the likelihood of a
// distribution
//   ln L = sum over tests of ln(fell ? q : 1 - q),  q = e + (1 - 2 e) p,  e = k_unknown.
// What is fitted is the distribution over a lattice of medians and scatters that is proportional to L; a test
// is predicted by the mean of p over it. Shares are weighted means over the runs of one design of rocks that
// fills the range evenly and depends on no outcome: leaving tests out, or drawing them anew, needs no runs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "solver/study/validate/granite_data.h"

namespace topple::study {

/// What a rock stands on and how it lands.
struct Rock {
  double left = 0, right = 0;  ///< m, edges towards -x and +x
  double restitution = 1;      ///< factor on Housner's rate
  double inertia = 1;          ///< factor on that about the centre of gravity
};

/// Rocks that scatter about a median.
struct RockDistribution {
  Rock median;
  double edge_scatter = 0;         ///< standard deviation of the logarithms of the edges
  double restitution_scatter = 0;  ///< standard deviation
};
inline constexpr double k_inertia_scatter = 0.25;  ///< standard deviation of its logarithm

/// s, that a run goes on behind the record.
inline constexpr double k_after_record = 1;

/// In which of the tests the rock falls, all accelerations times `factor`; empty: give_up() came true.
std::vector<bool> falls(const RockTraits& traits, const Rock& rock, const std::vector<GraniteTest>& tests,
                        double factor, const std::function<bool()>& give_up);

/// The rocks whose runs a fit is made of; of equal weight.
inline constexpr int k_design = 1024;
Rock designed(int k);

/// Rocks by which tests are predicted.
inline constexpr int k_members = 256;

/// Edges of the plain block of the baseline, which lands by Housner: a lattice.
inline constexpr int k_plain_edges = 12;
inline constexpr int k_plain = k_plain_edges * k_plain_edges;
Rock plain(int k);

/// A share of tests that end as nothing in the model says.
inline constexpr double k_unknown = 0.02;

/// Runs of one rock: [k][test], '1' where it fell.
using RunTable = std::vector<std::string>;

class RockFit {
 public:
  /// Of the runs of all designed rocks. Candidates that too few of them lie near are left out.
  explicit RockFit(const RunTable& runs);

  std::size_t candidates() const { return candidate_.size(); }
  const RockDistribution& candidate(std::size_t c) const { return candidate_[c]; }
  /// Of each candidate, together 1. `fell`, `weight`: per test; one of weight 0 is not looked at.
  std::vector<double> belief(const std::vector<bool>& fell, const std::vector<double>& weight) const;
  /// That the rock falls in a test.
  double probability(const std::vector<double>& belief, std::size_t test) const;
  /// Means over the candidates, of edges and scatters of their logarithms.
  RockDistribution mean(const std::vector<double>& belief) const;
  /// Rocks of the whole distribution, from points that fill it evenly.
  std::vector<Rock> drawn(const std::vector<double>& belief) const;

 private:
  std::size_t tests_;
  std::vector<RockDistribution> candidate_;
  std::vector<double> share_, log_yes_, log_no_;  ///< [candidate][test]
};

/// The plain block that is right most often in the used tests; of equals the first of its lattice.
int best_plain(const RunTable& runs, const std::vector<bool>& fell, const std::vector<bool>& used);

/// What is said of tests by others.
struct Predictions {
  std::vector<double> probability;
  std::vector<bool> by_threshold, by_plain;  ///< of the baselines
};
/// Of each test, in the order of the fit: by the used ones. Outcomes of the others are not looked at.
Predictions predicted(const RockFit& fit, const RunTable& plain_runs, const std::vector<double>& velocity,
                      const std::vector<bool>& fell, const std::vector<bool>& used);

/// Folds of the cross-validation: test i of the list is in fold i % k_folds.
inline constexpr std::size_t k_folds = 10;

/// The tests cut in two, one half predicted by the other, as `used` says.
struct Half {
  std::vector<bool> used;
  Predictions predictions;
};
/// Every other test of the list by the rest, then k_random_halves times that half of the tests with the lower
/// scattered(k_half_seed + n, index); each also the other way round.
inline constexpr std::uint64_t k_random_halves = 5, k_half_seed = 2021;
std::vector<std::vector<bool>> halves_of(std::size_t tests);

/// What is found in tests about one rock.
struct RockFindings {
  RockDistribution fitted;     ///< mean
  std::vector<Rock> members;   ///< k_members rocks of what is fitted, of equal weight
  RockDistribution low, high;  ///< each number for itself, 95 % by drawing tests anew k_draws times
  double threshold = 0;        ///< m/s, of the baseline
  Rock plain;                  ///< of the baseline
  // Not in a file:
  Predictions crossed;            ///< of each test, by what was fitted on the other folds
  std::vector<double> in_sample;  ///< of each test, by what was fitted on all
  std::vector<Half> halves;
};
inline constexpr std::uint64_t k_draws = 200;
RockFindings fit_rock(const std::vector<GraniteTest>& tests, std::size_t rock, const RunTable& designed_runs,
                      const RunTable& plain_runs);

}  // namespace topple::study
