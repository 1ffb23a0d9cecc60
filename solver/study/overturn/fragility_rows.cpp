// Fragility as rows and curves of JSON.
#include <nlohmann/json.hpp>

#include "solver/study/common/rows.h"
#include "solver/study/overturn/fragility_study.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;

ordered_json as_json(const Interval& interval) {
  return {interval.low, interval.high};
}
ordered_json as_json(const std::optional<Interval>& interval) {
  return interval ? as_json(*interval) : ordered_json(nullptr);
}

ordered_json curve_json(const FragilityCurve& curve) {
  if (!curve.fit.fit) return {{"median", nullptr}, {"why_not", curve.fit.why_not}};
  const Lognormal& fit = *curve.fit.fit;
  return {{"median", curve.median},
          {"median_95", as_json(curve.median_of_runs)},
          {"median_95_of_records", as_json(curve.median_of_records)},
          {"beta", fit.beta},
          {"beta_95", as_json(curve.beta_of_runs)},
          {"beta_95_of_records", as_json(curve.beta_of_records)},
          {"scatter", curve.scatter},
          {"deviance", fit.deviance},
          {"freedom", fit.freedom}};
}

ordered_json criteria_json(const BodyCriteria& criteria) {
  if (!criteria.why_not.empty()) return {{"why_not", criteria.why_not}};
  return {{"west", criteria.west},
          {"ishiyama", criteria.ishiyama},
          {"evaluation", criteria.evaluation},
          {"corner_Hz", criteria.corner},
          {"share_across_edge", criteria.share}};
}

}  // namespace

ordered_json rows_as_json(const FragilityPlan& plan, const FragilityResults& results) {
  ordered_json rows = ordered_json::array();
  const std::string level_name =
      plan.levels.unit.empty() ? plan.levels.key : plan.levels.key + "_" + plan.levels.unit;
  const auto add = [&](const std::string& of, const char* state, const FragilityCurve& curve, bool reverse) {
    for (const Level& level : curve.levels) {
      ordered_json row{{"body", of}, {"state", state}};
      row[level_name] = level.intensity;
      const bool any = level.runs > 0;
      const int hits = reverse ? level.runs - level.hits : level.hits;
      const Interval bounds = any ? wilson(hits, level.runs) : Interval{};
      const auto or_none = [](bool there, double value) {
        return there ? ordered_json(value) : ordered_json(nullptr);
      };
      const double fit = curve.fit.fit ? curve.probability(plan, level.intensity) : 0;
      row.update({{"runs", level.runs},
                  {"hits", hits},
                  {"probability", or_none(any, any ? static_cast<double>(hits) / level.runs : 0)},
                  {"low", or_none(any, bounds.low)},
                  {"high", or_none(any, bounds.high)},
                  {"fit", or_none(curve.fit.fit.has_value(), reverse ? 1 - fit : fit)}});
      rows.push_back(std::move(row));
    }
  };
  for (std::size_t b = 0; b < results.bodies.size(); ++b)
    for (std::size_t s = 0; s < k_states; ++s)
      add(results.bodies[b], damage_states()[s].word, results.curves[b][s], false);
  for (std::size_t p = 0; p < results.closed.size(); ++p)
    add(plan.scene.setup.room.places[p].name, "way-open", results.closed[p], true);
  return rows;
}

ordered_json curves_as_json(const FragilityPlan& plan, const FragilityResults& results) {
  ordered_json bodies = ordered_json::array();
  for (std::size_t b = 0; b < results.bodies.size(); ++b) {
    ordered_json body{{"name", results.bodies[b]}};
    for (std::size_t s = 0; s < k_states; ++s)
      body[damage_states()[s].word] = curve_json(results.curves[b][s]);
    if (b < results.criteria.size()) body["criteria"] = criteria_json(results.criteria[b]);
    bodies.push_back(std::move(body));
  }
  ordered_json ways = ordered_json::array();
  for (std::size_t p = 0; p < results.closed.size(); ++p)
    ways.push_back(
        {{"place", plan.scene.setup.room.places[p].name}, {"closed", curve_json(results.closed[p])}});
  return {
      {"measure", {{"name", plan.levels.key}, {"title", plan.measure->title}, {"unit", plan.levels.unit}}},
      {"levels", plan.levels.values},
      {"motion_frequency_Hz", results.frequency},
      {"bodies", bodies},
      {"ways", ways}};
}

}  // namespace topple::study
