// Points of the overturning map as rows and arrays of JSON.
#include <nlohmann/json.hpp>

#include "solver/study/common/rows.h"
#include "solver/study/overturn/overturn_map.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;

constexpr double k_early = 0.1, k_late = 0.9;  // quantiles of times that are told

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + "_" + unit;
}

/// value(point) by rows of y and columns of x.
template <typename Value>
ordered_json array_over(const OverturnPlan& plan, const OverturnMap& map, Value value) {
  ordered_json rows = ordered_json::array();
  for (int j = 0; j < plan.y.count(); ++j) {
    ordered_json row = ordered_json::array();
    for (int i = 0; i < plan.x.count(); ++i)
      row.push_back(value(map.points[static_cast<std::size_t>(j * plan.x.count() + i)]));
    rows.push_back(std::move(row));
  }
  return rows;
}

ordered_json fit_as_json(const Fragility& at) {
  if (!at.fit) return {{"why_not", at.why_not}};
  const Interval median = at.fit->median_interval(), beta = at.fit->beta_interval();
  return {{"median", at.fit->median},     {"median_standard_error", at.fit->median_error},
          {"median_low", median.low},     {"median_high", median.high},
          {"beta", at.fit->beta},         {"beta_standard_error", at.fit->beta_error},
          {"beta_low", beta.low},         {"beta_high", beta.high},
          {"deviance", at.fit->deviance}, {"degrees_of_freedom", at.fit->freedom}};
}

ordered_json fragility_as_json(const OverturnPlan& plan, const OverturnMap& map) {
  if (map.fragility.empty()) return nullptr;
  const Axis& along = map.fragility_along_y ? plan.y : plan.x;
  const Axis& other = map.fragility_along_y ? plan.x : plan.y;
  ordered_json fits = ordered_json::array();
  for (int k = 0; k < other.count(); ++k) {
    const Fragility& at = map.fragility[static_cast<std::size_t>(k)];
    ordered_json entry{{"at", other.values[static_cast<std::size_t>(k)]}};
    entry.update(fit_as_json(at));
    if (const std::vector<FloorPeak> peaks = floor_peaks(plan, map, k); !peaks.empty())
      for (const GroundMeasure& measure : k_ground_measures)
        entry[measure.name] = fit_as_json(fit_fragility(levels_over(measure, levels(plan, map, k), peaks)));
    fits.push_back(std::move(entry));
  }
  return {
      {"intensity", along.key},
      {"unit", along.unit},
      {"at", other.key},
      {"at_unit", other.unit},
      {"curve", "P = Phi(ln(intensity/median)/beta), by maximum likelihood; of any body; low, high: 95 %"},
      {"pga", "the same over the peak horizontal acceleration of the floor, gal"},
      {"pgv", "over its peak horizontal velocity, cm/s"},
      {"nearest_to_scene", map.own_column},
      {"fits", fits}};
}

}  // namespace

ordered_json rows_as_json(const OverturnPlan& plan, const OverturnMap& map) {
  ordered_json rows = ordered_json::array();
  for (int p = 0; p < plan.points(); ++p) {
    const OverturnPoint& point = map.points[static_cast<std::size_t>(p)];
    const auto interval = point.interval();
    ordered_json row{
        {with_unit(plan.x.key, plan.x.unit), plan.x.values[static_cast<std::size_t>(p % plan.x.count())]},
        {with_unit(plan.y.key, plan.y.unit), plan.y.values[static_cast<std::size_t>(p / plan.x.count())]},
        {"verdict", name(point.verdict)},
        {"status", point.status},
        {"runs", point.runs},
        {"failed", point.failed},
        {"overturned", point.overturned},
        {"probability", or_null(point.probability())},
        {"probability_low", interval ? ordered_json(interval->low) : ordered_json(nullptr)},
        {"probability_high", interval ? ordered_json(interval->high) : ordered_json(nullptr)},
        {"overturn_time_s", or_null(point.time(0.5))},
        {"overturn_time_early_s", or_null(point.time(k_early))},
        {"overturn_time_late_s", or_null(point.time(k_late))}};
    for (std::size_t b = 0; b < map.bodies.size(); ++b) row["overturned_" + map.bodies[b]] = point.fell[b];
    for (std::size_t way = 0; way < map.ways.size(); ++way) {
      const std::string key = "open_" + map.ways[way];
      const bool any = point.runs > 0;
      const Interval bounds = any ? wilson(point.open[way], point.runs) : Interval{};
      row[key] = point.open[way];
      row[key + "_low"] = any ? ordered_json(bounds.low) : ordered_json(nullptr);
      row[key + "_high"] = any ? ordered_json(bounds.high) : ordered_json(nullptr);
    }
    row["cpu_s"] = point.cpu;
    rows.push_back(std::move(row));
  }
  return rows;
}

ordered_json map_as_json(const OverturnPlan& plan, const OverturnMap& map) {
  const auto over = [&](auto value) { return array_over(plan, map, value); };
  ordered_json bodies = ordered_json::array();
  for (std::size_t b = 0; b < map.bodies.size(); ++b)
    bodies.push_back(
        {{"name", map.bodies[b]}, {"overturned", over([b](const OverturnPoint& p) { return p.fell[b]; })}});
  ordered_json ways = ordered_json::array();
  for (std::size_t p = 0; p < map.ways.size(); ++p)
    ways.push_back(
        {{"place", map.ways[p]}, {"open", over([p](const OverturnPoint& of) { return of.open[p]; })}});
  ordered_json curves = ordered_json::array();
  for (const Criterion& c : map.criteria.list)
    curves.push_back({{"name", c.name}, {"label", c.label}, {"about", c.about}, {"x", c.x}, {"y", c.y}});
  return {
      {"x", as_json(plan.x)},
      {"y", as_json(plan.y)},
      {"arrays", "rows by y, columns by x"},
      {"verdict", over([](const OverturnPoint& p) { return name(p.verdict); })},
      {"runs", over([](const OverturnPoint& p) { return p.runs; })},
      {"failed", over([](const OverturnPoint& p) { return p.failed; })},
      {"overturned", over([](const OverturnPoint& p) { return p.overturned; })},
      {"probability", over([](const OverturnPoint& p) { return or_null(p.probability()); })},
      {"probability_low", over([](const OverturnPoint& p) {
         return p.interval() ? ordered_json(p.interval()->low) : ordered_json(nullptr);
       })},
      {"probability_high", over([](const OverturnPoint& p) {
         return p.interval() ? ordered_json(p.interval()->high) : ordered_json(nullptr);
       })},
      {"overturn_time_s", over([](const OverturnPoint& p) { return or_null(p.time(0.5)); })},
      {"bodies", bodies},
      {"ways", ways},
      {"criteria", {{"bodies", map.criteria.bodies}, {"why_not", map.criteria.why_not}, {"curves", curves}}},
      {"fragility", fragility_as_json(plan, map)}};
}

}  // namespace topple::study
