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
          {"corner_Hz", criteria.corner}};
}

}  // namespace

ordered_json rows_as_json(const FragilityPlan& plan, const FragilityResults& results) {
  ordered_json rows = ordered_json::array();
  const std::string level_name =
      plan.levels.unit.empty() ? plan.levels.key : plan.levels.key + "_" + plan.levels.unit;
  for (std::size_t b = 0; b < results.bodies.size(); ++b)
    for (std::size_t s = 0; s < k_states; ++s) {
      const FragilityCurve& curve = results.curves[b][s];
      for (const Level& level : curve.levels) {
        ordered_json row{{"body", results.bodies[b]}, {"state", damage_states()[s].word}};
        row[level_name] = level.intensity;
        const bool any = level.runs > 0;
        const Interval bounds = any ? wilson(level.hits, level.runs) : Interval{};
        const auto or_none = [&](double value) { return any ? ordered_json(value) : ordered_json(nullptr); };
        row.update({{"runs", level.runs},
                    {"hits", level.hits},
                    {"probability", or_none(any ? static_cast<double>(level.hits) / level.runs : 0)},
                    {"low", or_none(bounds.low)},
                    {"high", or_none(bounds.high)},
                    {"fit", curve.fit.fit ? ordered_json(curve.probability(plan, level.intensity))
                                          : ordered_json(nullptr)}});
        rows.push_back(std::move(row));
      }
    }
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
  return {
      {"measure", {{"name", plan.levels.key}, {"title", plan.measure->title}, {"unit", plan.levels.unit}}},
      {"levels", plan.levels.values},
      {"motion_frequency_Hz", results.frequency},
      {"bodies", bodies}};
}

}  // namespace topple::study
