#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/cli/study_commands.h"
#include "app/study/present_studies.h"
#include "app/study/study_results.h"
#include "app/study/told_scene.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "solver/study/common/map_panel.h"
#include "solver/study/overturn/overturn_chart.h"
#include "solver/study/overturn/overturn_map.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

study::OverturnPlan plan_of(const StudyOptions& options, io::Scene scene) {
  return study::plan_overturn(std::move(scene), options.x, options.y, options.ensemble, options.spread);
}

ordered_json document(const study::OverturnPlan& plan, const study::OverturnMap& map, const Crew& crew,
                      const StudyOptions& options, double wall_s) {
  double cpu = 0;
  for (const study::OverturnPoint& point : map.points) cpu += point.cpu;
  ordered_json json = sweep_json(
      "overturn", "What overturns in " + plan.scene.name + " over " + plan.x.key + " and " + plan.y.key,
      plan.scene, crew, options,
      {{"x", plan.x.unit},
       {"y", plan.y.unit},
       {"probability", "1, of runs in which a body overturns; low, high: 95 % by Wilson's score"},
       {"overturn_time_s", "s, median of the first overturning; early, late: quantiles 0.1 and 0.9"},
       {"cpu_s", "s, of the solving thread, the scene's reading included"},
       {"wall_s", "s"}},
      {{"ensemble", plan.ensemble},
       {"spread", plan.spread},
       {"perturbation", plan.ensemble > 1 ? ordered_json("amplitude of every shake times a factor within "
                                                         "1 -+ spread, even, from point and member")
                                          : ordered_json(nullptr)},
       {"duration_s", plan.scene.setup.run.duration},
       {"set", plan.set}});
  json["run"] = map.run;
  json["of"] = map.of;
  json["wall_s"] = wall_s;
  json["cpu_s"] = cpu;
  json.update(map_as_json(plan, map));
  json["rows"] = rows_as_json(plan, map);
  return json;
}

/// A letter a point, the greatest y on top; of ensembles tenths of the runs in which a body overturns.
std::string picture(const study::OverturnPlan& plan, const study::OverturnMap& map) {
  constexpr int k_widest = 80;
  constexpr const char* k_letters = " !X/o.";  // by verdict
  if (plan.x.count() > k_widest) return "";
  std::string text;
  for (int j = plan.y.count(); j-- > 0;) {
    text += fmt::format("{:>12.5g} ", plan.y.values[static_cast<std::size_t>(j)]);
    for (int i = 0; i < plan.x.count(); ++i) {
      const study::OverturnPoint& point = map.points[static_cast<std::size_t>(j * plan.x.count() + i)];
      const std::optional<double> share = point.probability();
      text += plan.ensemble > 1 && share
                  ? (*share == 1 ? 'X' : static_cast<char>('0' + static_cast<int>(*share * 10)))
                  : k_letters[static_cast<int>(point.verdict)];
    }
    text += '\n';
  }
  text += fmt::format("{:>12} {:.5g} .. {:.5g} {}, {}\n", plan.y.unit, plan.x.values.front(),
                      plan.x.values.back(), plan.x.unit, plan.x.key);
  return text + (plan.ensemble > 1
                     ? "0-9: tenths of the runs in which a body overturns, X: all, !: all failed\n"
                     : ". stands, o rocks, / some overturn, X all overturn, ! failed\n");
}

std::string fit_in_words(const study::OverturnPlan& plan, const study::OverturnMap& map) {
  if (plan.ensemble == 1 || map.fragility.empty()) return "";
  const study::Axis& along = map.fragility_along_y ? plan.y : plan.x;
  const study::Axis& other = map.fragility_along_y ? plan.x : plan.y;
  const study::Fragility& at = map.fragility[static_cast<std::size_t>(map.own_column)];
  const std::string where = "fragility at " + other.key + " = " +
                            study::valued(other, other.values[static_cast<std::size_t>(map.own_column)]) +
                            ":";
  if (!at.fit) return where + " none, " + at.why_not + "\n";
  const auto told = [](const study::Lognormal& fit, const std::string& what, const std::string& unit) {
    const study::Interval median = fit.median_interval(), beta = fit.beta_interval();
    return fmt::format("  {} median {:.4g}{} (95 %: {:.4g} to {:.4g}), beta {:.3g} ({:.2g} to {:.2g})\n",
                       what, fit.median, unit.empty() ? "" : " " + unit, median.low, median.high, fit.beta,
                       beta.low, beta.high);
  };
  std::string text = where + "\n" + told(*at.fit, along.key + ":", along.unit);
  const std::vector<study::FloorPeak> peaks = floor_peaks(plan, map, map.own_column);
  if (peaks.empty()) return text;
  for (const study::GroundMeasure& measure : study::k_ground_measures)
    if (const study::Fragility over =
            study::fit_fragility(levels_over(measure, levels(plan, map, map.own_column), peaks));
        over.fit)
      text += told(*over.fit, std::string(measure.title) + ":", measure.unit);
  return text;
}

}  // namespace

int overturn_command(const StudyOptions& options) {
  Crew crew(options.jobs);
  defer_interrupts();
  if (!crew.leads()) {
    if (const auto heard = crew.listen()) {
      const study::OverturnPlan plan = plan_of(options, scene_from(*heard));
      crew.serve(work_on(plan), options.quick);
    }
    return k_done;
  }
  const study::OverturnPlan plan = plan_of(options, io::load_scene(options.scene, options.overrides));
  const std::string stem = place_for_results(options.folder, "overturn");
  const auto start = Clock::now();
  const std::optional<SweepEnd> end = sweep(crew,
                                            {.kind = "overturn",
                                             .stem = stem,
                                             .settings = settings_of(plan),
                                             .order = case_order(plan),
                                             .told = told(plan.scene),
                                             .make = work_on(plan)},
                                            options);
  if (!end) return k_interrupted;
  const double wall_s = seconds_since(start);
  const study::OverturnMap map = gather(plan, end->rows);
  const ordered_json json = document(plan, map, crew, options, wall_s);
  write_sweep(*end, stem, json,
              [&](study::ChartFormat format) { return overturn_chart(plan, map, origin_text(), format); });
  fmt::print("{}{}{} in {:.1f} s, {:.3g} runs/s, {:.3g} ms CPU time a run{}\n{}.csv, .json, .svg, .png\n",
             picture(plan, map), fit_in_words(plan, map), end->runs_in_words(), wall_s,
             (end->run - end->kept) / wall_s, 1e3 * json["cpu_s"].get<double>() / std::max(1, end->run),
             end->left_in_words(options.quick, "the finest"), stem);
  return k_done;
}

}  // namespace topple::app
