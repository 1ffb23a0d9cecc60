// The comparison with shake-table tests as rows, JSON and file of what was fitted.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/io/common/errors.h"
#include "solver/study/validate/granite_study.h"

namespace topple::study {

using nlohmann::ordered_json;

namespace {

double rounded(double value) {
  return std::round(value * 1e6) / 1e6;
}

ordered_json as_json(const Interval& interval) {
  return {rounded(interval.low), rounded(interval.high)};
}

/// The numbers of a distribution with their keys in files.
struct Number {
  const char* key;
  double& (*of)(RockDistribution&);
  double least, most;
};
constexpr Number k_numbers[] = {
    {"left_m", [](RockDistribution& d) -> double& { return d.median.left; }, 1e-3, 1},
    {"right_m", [](RockDistribution& d) -> double& { return d.median.right; }, 1e-3, 1},
    {"restitution", [](RockDistribution& d) -> double& { return d.median.restitution; }, 0, 1},
    {"inertia", [](RockDistribution& d) -> double& { return d.median.inertia; }, 1, 10},
    {"edge_scatter", [](RockDistribution& d) -> double& { return d.edge_scatter; }, 1e-6, 2},
    {"restitution_scatter", [](RockDistribution& d) -> double& { return d.restitution_scatter; }, 1e-6, 2}};

ordered_json scores_json(const Scores& scores) {
  if (scores.count == 0) return {{"tests", 0}};
  return {{"tests", scores.count},
          {"right", rounded(scores.share())},
          {"interval", as_json(scores.interval)},
          {"brier", rounded(scores.brier)}};
}

ordered_json curve_json(const Fragility& curve) {
  if (!curve.fit) return {{"median_m_s", nullptr}, {"why_not", curve.why_not}};
  return {{"median_m_s", rounded(curve.fit->median)}, {"beta", rounded(curve.fit->beta)}};
}

ordered_json reliability_json(const Scores& scores) {
  ordered_json bins = ordered_json::array();
  for (const ReliabilityBin& bin : scores.reliability)
    if (bin.count > 0) {
      const Interval share = wilson(bin.yes, bin.count);
      bins.push_back({{"from", bin.from},
                      {"to", bin.to},
                      {"tests", bin.count},
                      {"fell", bin.yes},
                      {"mean_probability", rounded(bin.mean)},
                      {"interval", as_json(share)}});
    }
  return bins;
}

ordered_json missed_json(const std::vector<GraniteTest>& tests, const RockResults& rock) {
  ordered_json missed = ordered_json::array();
  for (std::size_t i = 0; i < tests.size(); ++i)
    if (!rock.forecasts[i].right())
      missed.push_back({{"test", tests[i].number},
                        {"fell", rock.forecasts[i].measured},
                        {"probability", rounded(rock.forecasts[i].probability)},
                        {"pgv_m_s", tests[i].peak_velocity},
                        {"open", !rock.sure[i]}});
  return missed;
}

ordered_json halves_json(const RockResults& rock) {
  ordered_json halves = ordered_json::array();
  for (const HalfScores& half : rock.halves)
    halves.push_back({{"tests", half.scores.count},
                      {"right", rounded(half.scores.share())},
                      {"brier", rounded(half.scores.brier)},
                      {"never", rounded(half.never.share())},
                      {"pgv", rounded(half.threshold.share())},
                      {"housner", rounded(half.plain.share())},
                      {"only_model_right", half.only_model},
                      {"only_housner_right", half.only_plain}});
  return halves;
}

ordered_json rock_json(const std::vector<GraniteTest>& tests, std::size_t k, const RockFindings& found,
                       const GraniteResults& results) {
  const RockResults& rock = results.rocks[k];
  const Confusion& c = rock.scores.confusion;
  ordered_json fitted;
  for (const Number& number : k_numbers) {
    RockDistribution of = found.fitted;
    fitted[number.key] = rounded(number.of(of));
  }
  return {{"name", rocks()[k].name},
          {"right", rounded(rock.scores.share())},
          {"interval", as_json(rock.scores.interval)},
          {"brier", rounded(rock.scores.brier)},
          {"baselines",
           {{"never", rounded(rock.never.scores.share())},
            {"pgv", rounded(rock.threshold.scores.share())},
            {"housner", rounded(rock.plain.scores.share())}}},
          {"baselines_brier",
           {{"never", rounded(rock.never.scores.brier)},
            {"pgv", rounded(rock.threshold.scores.brier)},
            {"housner", rounded(rock.plain.scores.brier)}}},
          {"median_rock",
           {{"planar", scores_json(rock.median.scores)},
            {"rigid", scores_json(rock.rigid.scores)},
            {"alike", rounded(rock.agreement)}}},
          {"halves", halves_json(rock)},
          {"in_sample", scores_json(rock.in_sample)},
          {"confusion",
           {{"falls_fell", c.hits},
            {"falls_stood", c.false_alarms},
            {"stands_fell", c.misses},
            {"stands_stood", c.correct_rejections}}},
          {"sure", scores_json(rock.of_sure)},
          {"open", scores_json(rock.of_open)},
          {"expected_missed", rounded(rock.expected_missed)},
          {"missed", missed_json(tests, rock)},
          {"reliability", reliability_json(rock.scores)},
          {"fragility", {{"measured", curve_json(rock.measured)}, {"computed", curve_json(rock.computed)}}},
          {"fitted", fitted}};
}

template <class Key>
double number_of(const ordered_json& json, Key key, double least, double most) {
  const double value = json.at(key).template get<double>();
  if (!(value >= least && value <= most))
    throw io::InputError(fmt::format("{}: {:g} is outside {:g}..{:g}", key, value, least, most));
  return value;
}

RockFindings rock_from(const ordered_json& json) {
  RockFindings found;
  for (const Number& number : k_numbers)
    number.of(found.fitted) = number_of(json, number.key, number.least, number.most);
  const ordered_json& members = json.at("members");
  if (members.size() != std::size_t{k_members})
    throw io::InputError(fmt::format("members: there are {}, not {}", members.size(), k_members));
  for (const ordered_json& member : members)
    found.members.push_back({number_of(member, 0, 1e-3, 1), number_of(member, 1, 1e-3, 1),
                             number_of(member, 2, 0, 1), number_of(member, 3, 1, 10)});
  const ordered_json& baselines = json.at("baselines");
  found.threshold = number_of(baselines, "pgv_m_s", 0, 100);
  found.plain.left = number_of(baselines, "housner_left_m", 1e-3, 1);
  found.plain.right = number_of(baselines, "housner_right_m", 1e-3, 1);
  return found;
}

}  // namespace

ordered_json granite_rows(const std::vector<GraniteTest>& tests, const GraniteResults& results) {
  ordered_json rows = ordered_json::array();
  for (std::size_t k = 0; k < k_rocks; ++k)
    for (std::size_t i = 0; i < tests.size(); ++i) {
      const RockResults& rock = results.rocks[k];
      rows.push_back({{"rock", rocks()[k].name},
                      {"test", tests[i].number},
                      {"pgv_m_s", tests[i].peak_velocity},
                      {"fell", int{rock.forecasts[i].measured}},
                      {"probability", rounded(rock.forecasts[i].probability)},
                      {"open", int{!rock.sure[i]}},
                      {"right", int{rock.forecasts[i].right()}},
                      {"pgv_falls", int{rock.threshold.falls[i]}},
                      {"housner_falls", int{rock.plain.falls[i]}},
                      {"median_falls", int{rock.median.falls[i]}},
                      {"rigid_falls", int{rock.rigid.falls[i]}}});
    }
  return rows;
}

ordered_json granite_json(const std::vector<GraniteTest>& tests, const GraniteFit& fit,
                          const GraniteResults& results) {
  ordered_json out{{"tests", tests.size()},
                   {"fitted_here", results.fitted_here},
                   {"fitted_on", fit.tests},
                   {"both_missed", results.both_missed},
                   {"rocks", ordered_json::array()}};
  for (std::size_t k = 0; k < k_rocks; ++k)
    out["rocks"].push_back(rock_json(tests, k, fit.rocks[k], results));
  return out;
}

ordered_json fit_as_json(const GraniteFit& fit) {
  ordered_json out{
      {"kind", "granite"},
      {"rule", fmt::format("medians and scatters in proportion to the likelihood of the outcomes, {} % "
                           "of tests ending anyhow; runs of {} rocks that fill the range evenly",
                           100 * k_unknown, k_design)},
      {"tests", fit.tests},
      {"rocks", ordered_json::array()}};
  for (std::size_t k = 0; k < k_rocks; ++k) {
    const RockFindings& found = fit.rocks[k];
    ordered_json rock{{"name", rocks()[k].name}};
    for (const Number& number : k_numbers) {
      RockDistribution middle = found.fitted, low = found.low, high = found.high;
      rock[number.key] = rounded(number.of(middle));
      rock[std::string(number.key) + "_95"] = as_json({number.of(low), number.of(high)});
    }
    for (const Rock& member : found.members)
      rock["members"].push_back({rounded(member.left), rounded(member.right), rounded(member.restitution),
                                 rounded(member.inertia)});
    rock["baselines"] = {{"pgv_m_s", rounded(found.threshold)},
                         {"housner_left_m", rounded(found.plain.left)},
                         {"housner_right_m", rounded(found.plain.right)}};
    out["rocks"].push_back(std::move(rock));
  }
  return out;
}

GraniteFit fit_from_json(const std::string& text, const std::string& name) {
  try {
    const ordered_json json = ordered_json::parse(text);
    if (json.at("kind") != "granite") throw io::InputError("kind: is not granite");
    GraniteFit fit;
    fit.tests = json.at("tests").get<int>();
    const ordered_json& list = json.at("rocks");
    for (std::size_t k = 0; k < k_rocks; ++k) {
      if (list.at(k).at("name") != rocks()[k].name)
        throw io::InputError(fmt::format("rocks: the name of number {} is not {}", k + 1, rocks()[k].name));
      fit.rocks[k] = rock_from(list.at(k));
    }
    return fit;
  } catch (const ordered_json::exception& error) {
    throw io::InputError(fmt::format("{}: is no file of a fit: {}", name, error.what()));
  } catch (const io::InputError& error) {
    throw io::InputError(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace topple::study
