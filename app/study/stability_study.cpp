#include <fmt/format.h>

#include "app/study/study.h"
#include "app/support/interrupt.h"
#include "solver/study/stability/stability.h"
#include "solver/study/stability/stability_chart.h"
#include "solver/study/stability/stability_limits.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

ordered_json limits_as_json(const std::vector<study::StabilityLimit>& limits) {
  ordered_json list = ordered_json::array();
  for (const study::StabilityLimit& limit : limits)
    list.push_back({{"name", limit.name},
                    {"formula", limit.formula},
                    {"about", limit.about},
                    {"methods", limit.methods},
                    {"at_scene", limit.at_scene ? ordered_json(*limit.at_scene) : ordered_json(nullptr)},
                    {"unit", limit.unit},
                    {"x", limit.x},
                    {"y", limit.y}});
  return list;
}

std::string counts_in_words(const study::StabilityPlan& plan, const study::StabilityMap& map) {
  std::string text;
  for (std::size_t m = 0; m < plan.methods.size(); ++m) {
    text += fmt::format("{:<20}", plan.methods[m].name);
    for (int fate = study::k_fates; fate-- > 0;)
      if (const int n = map.count(m, static_cast<study::Fate>(fate)))
        text += fmt::format(" {} {},", n, name(static_cast<study::Fate>(fate)));
    text.back() = '\n';
  }
  return text;
}

std::string limits_in_words(const std::vector<study::StabilityLimit>& limits) {
  std::string text;
  for (const study::StabilityLimit& limit : limits)
    if (limit.at_scene)
      text += fmt::format("{:<20} {} = {:.3g} {}\n", limit.name, limit.formula, *limit.at_scene, limit.unit);
  return text;
}

Findings stability_findings(const study::StabilityPlan& plan, const study::StabilityMap& map) {
  const std::vector<study::StabilityLimit> limits = stability_limits(plan);
  ordered_json entries{{"run", map.run}, {"of", map.of}};
  entries.update(map_as_json(plan, map));
  entries["limits"] = limits_as_json(limits);
  entries["rows"] = rows_as_json(plan, map);
  return {
      .title =
          "Where time integration fails in " + plan.scene.name + " over " + plan.x.key + " and " + plan.y.key,
      .units = {{"x", plan.x.unit},
                {"y", plan.y.unit},
                {"unexplained_energy", "1, of the largest energy exchanged; above 0: it appeared"},
                {"numerical_dissipation", "1, of the largest energy exchanged; below 0: the integrator gave"},
                {"penetration", "1, greatest 1 - l/L at floors and walls"},
                {"reached_s", "s"},
                {"cpu_s", "s, of the solving thread, the scene's reading included"}},
      .settings = {{"duration_s", plan.scene.setup.run.duration},
                   {"simulated_s", plan.horizon},
                   {"reference_runs", plan.references()},
                   {"reference_spread", study::k_reference_spread},
                   {"balance", study::k_stable_balance},
                   {"damping", study::k_stable_damping},
                   {"through", study::k_through}},
      .entries = entries,
      .chart = [&plan, &map, limits](
                   const std::string& origin,
                   study::ChartFormat format) { return stability_chart(plan, map, limits, origin, format); },
      .text = counts_in_words(plan, map) + limits_in_words(limits),
      .each = fmt::format(" of {:.3g} s", plan.horizon)};
}

}  // namespace

const Study k_stability_study = {
    .name = "stability",
    .about = "where each time integration fails over two keys, such as step and alpha",
    .x = "the step",
    .y = "contact.alpha",
    .sweep = [](io::Scene scene, const StudyOptions& options) {
      const auto plan = std::make_shared<study::StabilityPlan>(
          study::plan_stability(std::move(scene), options.x, options.y));
      Sweep sweep = sweep_of(plan, work_on(*plan), stability_findings);
      sweep.prepare = [plan] {
        plan->horizon = study::find_horizon(plan->scene.setup, interrupted);
        return fmt::format("{}", plan->horizon);
      };
      sweep.receive = [plan](const std::string& horizon) { plan->horizon = std::stod(horizon); };
      return sweep;
    }};

}  // namespace topple::app
