#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/cli/study_commands.h"
#include "app/study/study_results.h"
#include "app/study/sweep.h"
#include "app/study/told_scene.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "solver/study/stability/stability.h"
#include "solver/study/stability/stability_chart.h"
#include "solver/study/stability/stability_limits.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

MakeWork work_on(const study::StabilityPlan& plan) {
  return [&plan] {
    return [&plan](int k, const std::function<bool()>& give_up) {
      return study::run_stability_case(plan, k, give_up);
    };
  };
}

/// What other ranks are told: the scene, then the horizon.
std::vector<std::string> told_plan(const study::StabilityPlan& plan) {
  std::vector<std::string> parts = told(plan.scene);
  parts.push_back(fmt::format("{}", plan.horizon));
  return parts;
}

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

ordered_json document(const study::StabilityPlan& plan, const study::StabilityMap& map,
                      const std::vector<study::StabilityLimit>& limits, const Crew& crew,
                      const StudyOptions& options, double wall_s) {
  const io::Scene& scene = plan.scene;
  ordered_json json = sweep_json(
      "stability",
      "Where time integration fails in " + scene.name + " over " + plan.x.key + " and " + plan.y.key, scene,
      crew, options,
      {{"x", plan.x.unit},
       {"y", plan.y.unit},
       {"unexplained_energy", "1, of the largest energy exchanged; above 0: it appeared"},
       {"numerical_dissipation", "1, of the largest energy exchanged; below 0: the integrator gave"},
       {"penetration", "1, greatest 1 - l/L at floors and walls"},
       {"reached_s", "s"},
       {"cpu_s", "s, of the solving thread, the scene's reading included"},
       {"wall_s", "s"}},
      {{"duration_s", scene.setup.run.duration},
       {"simulated_s", plan.horizon},
       {"reference_runs", plan.references()},
       {"reference_spread", study::k_reference_spread},
       {"balance", study::k_stable_balance},
       {"damping", study::k_stable_damping},
       {"through", study::k_through}});
  json["run"] = map.run;
  json["of"] = map.of;
  json["wall_s"] = wall_s;
  json.update(map_as_json(plan, map));
  json["limits"] = limits_as_json(limits);
  json["rows"] = rows_as_json(plan, map);
  return json;
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

}  // namespace

int stability_command(const StudyOptions& options) {
  Crew crew(options.jobs);
  defer_interrupts();
  if (!crew.leads()) {
    if (auto heard = crew.listen()) {
      const double horizon = std::stod(heard->back());
      heard->pop_back();
      study::StabilityPlan plan = study::plan_stability(scene_from(*heard), options.x, options.y);
      plan.horizon = horizon;
      crew.serve(work_on(plan), options.quick);
    }
    return k_done;
  }
  study::StabilityPlan plan =
      study::plan_stability(io::load_scene(options.scene, options.overrides), options.x, options.y);
  const std::string stem = place_for_results(options.folder, "stability");
  const auto start = Clock::now();
  plan.horizon = study::find_horizon(plan.scene.setup, interrupted);
  const std::optional<SweepEnd> end = sweep(crew,
                                            {.kind = "stability",
                                             .stem = stem,
                                             .settings = settings_of(plan),
                                             .order = case_order(plan),
                                             .told = told_plan(plan),
                                             .make = work_on(plan),
                                             .start = start},
                                            options);
  if (!end) return k_interrupted;
  const double wall_s = seconds_since(start);
  const study::StabilityMap map = gather(plan, end->rows);
  const std::vector<study::StabilityLimit> limits = stability_limits(plan);
  const ordered_json json = document(plan, map, limits, crew, options, wall_s);
  write_sweep(*end, stem, json, [&](study::ChartFormat format) {
    return stability_chart(plan, map, limits, origin_text(), format);
  });
  fmt::print("{}{}{} in {:.1f} s, {:.3g} runs/s{}\n{}.csv, .json, .svg, .png\n", counts_in_words(plan, map),
             limits_in_words(limits), end->runs_in_words(fmt::format(" of {:.3g} s", plan.horizon)), wall_s,
             (end->run - end->kept) / wall_s, end->left_in_words(options.quick, "the finest"), stem);
  return k_done;
}

}  // namespace topple::app
