// Points of the stability map as rows and arrays of JSON.
#include <nlohmann/json.hpp>

#include "solver/study/stability/stability.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;
using Cell = StabilityMap::Cell;

std::string with_unit(const Axis& axis) {
  return axis.unit.empty() ? axis.key : axis.key + "_" + axis.unit;
}

/// value(run), or null where there is none.
template <typename Value>
ordered_json of_run(const Cell& cell, Value value) {
  return cell.run ? ordered_json(value(*cell.run)) : ordered_json(nullptr);
}

/// value(cell) by rows of y and columns of x.
template <typename Value>
ordered_json array_over(const StabilityPlan& plan, const std::vector<Cell>& cells, Value value) {
  ordered_json rows = ordered_json::array();
  for (int j = 0; j < plan.y.count(); ++j) {
    ordered_json row = ordered_json::array();
    for (int i = 0; i < plan.x.count(); ++i)
      row.push_back(value(cells[static_cast<std::size_t>(j * plan.x.count() + i)]));
    rows.push_back(std::move(row));
  }
  return rows;
}

ordered_json counts(const StabilityMap& map, std::size_t method) {
  ordered_json out = ordered_json::object();
  for (int fate = k_fates; fate-- > 0;)
    if (const int n = map.count(method, static_cast<Fate>(fate))) out[name(static_cast<Fate>(fate))] = n;
  return out;
}

ordered_json verdict(const StabilityMap& map, const std::vector<bool>& fell) {
  ordered_json out = ordered_json::array();
  for (std::size_t b = 0; b < fell.size(); ++b)
    if (fell[b]) out.push_back(map.bodies[b]);
  return out;
}

}  // namespace

ordered_json rows_as_json(const StabilityPlan& plan, const StabilityMap& map) {
  ordered_json rows = ordered_json::array();
  for (std::size_t m = 0; m < plan.methods.size(); ++m)
    for (int p = 0; p < plan.points(); ++p) {
      const Cell& cell = map.cells[m][static_cast<std::size_t>(p)];
      const Agreement& reference = map.references[static_cast<std::size_t>(plan.group(p))];
      ordered_json row{
          {"method", plan.methods[m].name},
          {with_unit(plan.x), plan.x.values[static_cast<std::size_t>(p % plan.x.count())]},
          {with_unit(plan.y), plan.y.values[static_cast<std::size_t>(p / plan.x.count())]},
          {"fate", name(cell.fate)},
          {"status", cell.run ? cell.run->message : "not run"},
          {"reached_s", of_run(cell, [](const StabilityRun& run) { return run.time; })},
          {"unexplained_energy", of_run(cell, [](const StabilityRun& run) { return run.unexplained; })},
          {"numerical_dissipation", of_run(cell, [](const StabilityRun& run) { return run.numerical; })},
          {"penetration", of_run(cell, [](const StabilityRun& run) { return run.penetration; })},
          {"reference_penetration", reference.penetration},
          {"reference", reference.decided ? "decided" : reference.why_not}};
      for (std::size_t b = 0; b < map.bodies.size(); ++b) {
        row["overturned_" + map.bodies[b]] = cell.run && b < cell.run->fell.size()
                                                 ? ordered_json(static_cast<int>(cell.run->fell[b]))
                                                 : ordered_json(nullptr);
        row["reference_" + map.bodies[b]] =
            reference.decided ? ordered_json(static_cast<int>(reference.fell[b])) : ordered_json(nullptr);
      }
      row["steps"] = of_run(cell, [](const StabilityRun& run) { return run.steps; });
      row["rejected_steps"] = of_run(cell, [](const StabilityRun& run) { return run.rejected; });
      row["cpu_s"] = of_run(cell, [](const StabilityRun& run) { return run.cpu; });
      rows.push_back(std::move(row));
    }
  return rows;
}

ordered_json map_as_json(const StabilityPlan& plan, const StabilityMap& map) {
  ordered_json references = ordered_json::array(), methods = ordered_json::array();
  for (const Agreement& reference : map.references)
    references.push_back({{"decided", reference.decided},
                          {"why_not", reference.why_not},
                          {"overturned", verdict(map, reference.fell)},
                          {"penetration", reference.penetration}});
  for (std::size_t m = 0; m < plan.methods.size(); ++m)
    methods.push_back(
        {{"name", plan.methods[m].name},
         {"label", plan.methods[m].label},
         {"counts", counts(map, m)},
         {"fate", array_over(plan, map.cells[m], [](const Cell& cell) { return name(cell.fate); })},
         {"unexplained_energy", array_over(plan, map.cells[m], [](const Cell& cell) {
            return of_run(cell, [](const StabilityRun& run) { return run.unexplained; });
          })}});
  ordered_json groups = ordered_json::array();
  for (int p = 0; p < plan.points(); ++p) groups.push_back(plan.group(p));
  return {{"x", as_json(plan.x)},        {"y", as_json(plan.y)},
          {"bodies", map.bodies},        {"arrays", "rows by y, columns by x"},
          {"methods", methods},          {"references", references},
          {"reference_of_point", groups}};
}

}  // namespace topple::study
