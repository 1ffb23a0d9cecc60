#include "solver/study/validate/granite_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/io/common/errors.h"
#include "solver/study/validate/granite_rigid.h"

namespace topple::study {

using nlohmann::ordered_json;

namespace {

constexpr int k_factors = 9;
constexpr double k_change = 0.05;  // of the input
constexpr int k_fit_of_rock = k_design + k_plain;
constexpr int k_plain_run = k_factors;  // behind the median rock under all factors on the input
constexpr int k_first_member = k_plain_run + 1;

/// A rock in tests; empty: gave up.
std::string row_of(const std::vector<bool>& falls) {
  if (falls.empty()) return "";
  std::string fell;
  for (const bool one : falls) fell += one ? '1' : '0';
  return ordered_json{{"fell", fell}}.dump();
}

std::string fell_in(const std::string& row) {
  return ordered_json::parse(row).at("fell").get<std::string>();
}

/// Behind them the rigid ones, test by test.
int first_rigid(bool fitted_here) {
  return k_first_member + (fitted_here ? 0 : k_members);
}

int runs_of_rock(std::size_t tests, bool fitted_here) {
  return first_rigid(fitted_here) + static_cast<int>(tests);
}

Verdicts verdicts_of(std::vector<bool> falls, const std::vector<GraniteTest>& tests, std::size_t rock) {
  std::vector<Forecast> forecasts;
  for (std::size_t i = 0; i < tests.size(); ++i)
    forecasts.push_back({falls[i] ? 1. : 0., tests[i].fell[rock]});
  return {std::move(falls), scored(forecasts)};
}

std::vector<bool> as_bools(const std::string& fell) {
  std::vector<bool> out;
  for (const char c : fell) out.push_back(c == '1');
  return out;
}

/// A test counts `k_parts` times, so that probabilities are counts.
Fragility curve_of(const std::vector<GraniteTest>& tests, const std::vector<double>& probability) {
  constexpr int k_parts = 100;
  std::vector<Level> levels;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (!(tests[i].peak_velocity > 0)) continue;
    levels.push_back(
        {tests[i].peak_velocity, k_parts, static_cast<int>(std::lround(k_parts * probability[i]))});
  }
  return fit_fragility(levels, "falls");
}

Scores scored_if(const std::vector<Forecast>& forecasts, const std::vector<bool>& wanted, bool which) {
  std::vector<Forecast> some;
  for (std::size_t i = 0; i < forecasts.size(); ++i)
    if (wanted[i] == which) some.push_back(forecasts[i]);
  return some.empty() ? Scores{} : scored(some);
}

struct RockRuns {
  std::vector<double> share;  ///< of members that fell, per test; empty where they were not run
  std::vector<bool> sure, median, plain, rigid;
};

RockRuns runs_of(const std::vector<GraniteTest>& tests, std::size_t rock, bool fitted_here,
                 const std::vector<std::string>& rows) {
  const std::size_t begin = rock * static_cast<std::size_t>(runs_of_rock(tests.size(), fitted_here));
  const auto row = [&](int k) { return as_bools(fell_in(rows[begin + static_cast<std::size_t>(k)])); };
  RockRuns out;
  out.sure.assign(tests.size(), true);
  out.median = row(k_factors / 2), out.plain = row(k_plain_run);
  for (int k = 0; k < k_factors; ++k) {
    const std::vector<bool> fell = row(k);
    for (std::size_t i = 0; i < tests.size(); ++i) out.sure[i] = out.sure[i] && fell[i] == out.median[i];
  }
  if (!fitted_here) out.share.resize(tests.size());
  for (int k = k_first_member; k < first_rigid(fitted_here); ++k) {
    const std::vector<bool> fell = row(k);
    for (std::size_t i = 0; i < tests.size(); ++i) out.share[i] += fell[i] / double{k_members};
  }
  for (int i = 0; i < static_cast<int>(tests.size()); ++i)
    out.rigid.push_back(row(first_rigid(fitted_here) + i).front());
  return out;
}

std::vector<bool> above(const std::vector<GraniteTest>& tests, double threshold) {
  std::vector<bool> out;
  for (const GraniteTest& test : tests) out.push_back(test.peak_velocity > threshold);
  return out;
}

std::vector<Forecast> forecasts_of(const std::vector<double>& probability,
                                   const std::vector<GraniteTest>& tests, std::size_t rock) {
  std::vector<Forecast> out;
  for (std::size_t i = 0; i < tests.size(); ++i) out.push_back({probability[i], tests[i].fell[rock]});
  return out;
}

HalfScores scores_of(const Half& half, const std::vector<GraniteTest>& tests, std::size_t rock) {
  HalfScores out;
  const Predictions& by_others = half.predictions;
  const auto scored_others = [&](const std::vector<double>& probability) {
    return scored_if(forecasts_of(probability, tests, rock), half.used, false);
  };
  const auto as_numbers = [](const std::vector<bool>& falls) {
    return std::vector<double>(falls.begin(), falls.end());
  };
  out.scores = scored_others(by_others.probability);
  out.plain = scored_others(as_numbers(by_others.by_plain));
  out.threshold = scored_others(as_numbers(by_others.by_threshold));
  out.never = scored_others(std::vector<double>(tests.size(), 0));
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const bool fell = tests[i].fell[rock], model = (by_others.probability[i] > 0.5) == fell,
               block = by_others.by_plain[i] == fell;
    out.only_model += !half.used[i] && model && !block;
    out.only_plain += !half.used[i] && block && !model;
  }
  return out;
}

RockResults results_of(const std::vector<GraniteTest>& tests, std::size_t rock, const RockFindings& found,
                       bool fitted_here, const std::vector<std::string>& rows) {
  const RockRuns runs = runs_of(tests, rock, fitted_here, rows);
  RockResults out;
  const std::vector<double>& computed = fitted_here ? found.crossed.probability : runs.share;
  out.forecasts = forecasts_of(computed, tests, rock);
  std::vector<double> measured;
  for (const Forecast& one : out.forecasts) {
    out.expected_missed += std::min(one.probability, 1 - one.probability);
    measured.push_back(one.measured);
  }
  out.scores = scored(out.forecasts);
  out.in_sample = fitted_here ? scored(forecasts_of(found.in_sample, tests, rock)) : out.scores;
  out.sure = runs.sure;
  out.of_sure = scored_if(out.forecasts, out.sure, true);
  out.of_open = scored_if(out.forecasts, out.sure, false);
  out.never = verdicts_of(std::vector<bool>(tests.size(), false), tests, rock);
  out.threshold =
      verdicts_of(fitted_here ? found.crossed.by_threshold : above(tests, found.threshold), tests, rock);
  out.plain = verdicts_of(fitted_here ? found.crossed.by_plain : runs.plain, tests, rock);
  out.median = verdicts_of(runs.median, tests, rock);
  out.rigid = verdicts_of(runs.rigid, tests, rock);
  for (std::size_t i = 0; i < tests.size(); ++i)
    out.agreement += (runs.rigid[i] == runs.median[i]) / static_cast<double>(tests.size());
  for (const Half& half : found.halves) out.halves.push_back(scores_of(half, tests, rock));
  out.measured = curve_of(tests, measured), out.computed = curve_of(tests, computed);
  return out;
}

}  // namespace

void expect_enough(const std::vector<GraniteTest>& tests) {
  if (tests.size() < k_fewest_tests)
    throw io::InputError(
        fmt::format("validate granite: {} tests are too few to fit, {} at least; --fit FILE takes "
                    "what was fitted elsewhere",
                    tests.size(), k_fewest_tests));
}

int fit_cases() {
  return static_cast<int>(k_rocks) * k_fit_of_rock;
}

std::string run_fit_case(const std::vector<GraniteTest>& tests, int k, const std::function<bool()>& give_up) {
  const RockTraits& traits = rocks()[static_cast<std::size_t>(k / k_fit_of_rock)];
  const int of = k % k_fit_of_rock;
  const Rock rock = of < k_design ? designed(of) : plain(of - k_design);
  return row_of(falls(traits, rock, tests, 1, give_up));
}

GraniteFit fit_granite(const std::vector<GraniteTest>& tests, const std::vector<std::string>& rows) {
  GraniteFit fit;
  fit.tests = static_cast<int>(tests.size());
  for (std::size_t rock = 0; rock < k_rocks; ++rock) {
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(rock) * k_fit_of_rock;
    RunTable runs;
    std::transform(first, first + k_fit_of_rock, std::back_inserter(runs), fell_in);
    const auto middle = runs.begin() + k_design;
    fit.rocks[rock] = fit_rock(tests, rock, RunTable(runs.begin(), middle), RunTable(middle, runs.end()));
  }
  return fit;
}

int prediction_cases(const std::vector<GraniteTest>& tests, bool fitted_here) {
  return static_cast<int>(k_rocks) * runs_of_rock(tests.size(), fitted_here);
}

std::string run_prediction_case(const std::vector<GraniteTest>& tests, const GraniteFit& fit,
                                bool fitted_here, int k, const std::function<bool()>& give_up) {
  const int in_rock = runs_of_rock(tests.size(), fitted_here), of = k % in_rock;
  const auto index = static_cast<std::size_t>(k / in_rock);
  const RockTraits& traits = rocks()[index];
  const RockFindings& found = fit.rocks[index];
  const Rock& median = found.fitted.median;
  const auto all = [&](const Rock& rock, double factor) {
    return row_of(falls(traits, rock, tests, factor, give_up));
  };
  if (of < k_plain_run) return all(median, even_factors(k_factors, k_change)[static_cast<std::size_t>(of)]);
  if (of == k_plain_run) return all(found.plain, 1);
  if (of < first_rigid(fitted_here))
    return all(found.members[static_cast<std::size_t>(of - k_first_member)], 1);
  const auto test = static_cast<std::size_t>(of - first_rigid(fitted_here));
  const bool fell = rigid_falls(traits, median, tests[test], give_up);
  return row_of(give_up() ? std::vector<bool>{} : std::vector<bool>{fell});
}

GraniteResults gather_granite(const std::vector<GraniteTest>& tests, const GraniteFit& fit, bool fitted_here,
                              const std::vector<std::string>& rows) {
  GraniteResults out;
  out.fitted_here = fitted_here;
  for (std::size_t rock = 0; rock < k_rocks; ++rock)
    out.rocks[rock] = results_of(tests, rock, fit.rocks[rock], fitted_here, rows);
  for (std::size_t i = 0; i < tests.size(); ++i)
    out.both_missed +=
        std::ranges::none_of(out.rocks, [&](const RockResults& r) { return r.forecasts[i].right(); });
  return out;
}

std::string fingerprint(const std::vector<GraniteTest>& tests) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto add = [&](double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
  };
  for (const GraniteTest& test : tests) {
    add(test.number), add(test.peak_velocity);
    for (const bool fell : test.fell) add(fell);
    for (const AccelerogramComponent& one : test.motion->components) {
      add(one.interval);
      for (const double sample : one.samples) add(sample);
    }
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace topple::study
