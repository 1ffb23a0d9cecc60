#include <fmt/format.h>

#include <algorithm>

#include "app/study/coarser_models.h"
#include "app/study/present_studies.h"
#include "app/study/study.h"
#include "solver/study/common/map_panel.h"
#include "solver/study/overturn/overturn_chart.h"
#include "solver/study/overturn/overturn_map.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

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
  const auto line_of = [](const study::Lognormal& fit, const std::string& what, const std::string& unit) {
    const study::Interval median = fit.median_interval(), beta = fit.beta_interval();
    const double scatter = fit.scatter();
    return fmt::format(
        "  {} median {:.4g}{} (95 %: {:.4g} to {:.4g}), beta {:.3g} ({:.2g} to {:.2g}){}\n", what, fit.median,
        unit.empty() ? "" : " " + unit, median.low, median.high, fit.beta, beta.low, beta.high,
        scatter > 1
            ? fmt::format("; shares scatter {:.2g} times as far as by chance, and so do these", scatter)
            : "");
  };
  std::string text = where + "\n" + line_of(*at.fit, along.key + ":", along.unit);
  const std::vector<study::FloorPeak> peaks = floor_peaks(plan, map, map.own_column);
  if (peaks.empty()) return text;
  for (const study::GroundMeasure& measure : study::k_ground_measures)
    if (const study::Fragility over =
            study::fit_fragility(levels_over(measure, levels(plan, map, map.own_column), peaks));
        over.fit)
      text += line_of(*over.fit, std::string(measure.title) + ":", measure.unit);
  return text;
}

std::string models_in_words(const study::OverturnPlan& plan, const study::OverturnMap& map) {
  if (map.planar == map.run) return fmt::format("{} runs as planar blocks\n", map.run);
  const std::string why = study::why_not_planar(plan);
  return coarser_in_words(plan.scene, plan.set) +
         fmt::format("{} of {} runs as planar blocks{}\n", map.planar, map.run,
                     why.empty() ? study::k_climbed : "; the scene itself is none: " + why);
}

Findings overturn_findings(const study::OverturnPlan& plan, const study::OverturnMap& map) {
  double cpu = 0;
  for (const study::OverturnPoint& point : map.points) cpu += point.cpu;
  ordered_json entries{{"run", map.run}, {"of", map.of}, {"planar", map.planar}, {"cpu_s", cpu}};
  entries.update(map_as_json(plan, map));
  entries["rows"] = rows_as_json(plan, map);
  return {
      .title = "What overturns in " + plan.scene.name + " over " + plan.x.key + " and " + plan.y.key,
      .units = {{"x", plan.x.unit},
                {"y", plan.y.unit},
                {"verdict", "that of most runs that ended; the probability tells how many"},
                {"probability", "1, of runs in which a body overturns; low, high: 95 % by Wilson's score"},
                {"open", "runs after which a way leads from a place to a door; low, high: as of probability"},
                {"overturn_time_s", "s, median of the first overturning; early, late: quantiles 0.1 and 0.9"},
                {"cpu_s", "s, of the solving thread, the scene's reading included"}},
      .settings = {{"ensemble", plan.ensemble},
                   {"perturbation",
                    plan.ensemble > 1 ? ordered_json(plan.factors.in_words()) : ordered_json(nullptr)},
                   {"vary", plan.factors.texts},
                   {"seed", plan.factors.seed},
                   {"records", plan.factors.records},
                   {"duration_s", plan.scene.setup.run.duration},
                   {"set", plan.set}},
      .entries = entries,
      .chart = [&plan, &map](const std::string& origin,
                             study::ChartFormat format) { return overturn_chart(plan, map, origin, format); },
      .text = picture(plan, map) + fit_in_words(plan, map) + models_in_words(plan, map),
      .each = plan.chunk > 1 ? fmt::format(" of up to {} runs", plan.chunk) : "",
      .pace = fmt::format(", {:.3g} ms CPU time a run", 1e3 * cpu / std::max(1, map.run))};
}

constexpr double k_usual_spread = 0.05;

}  // namespace

study::Ensemble ensemble_of(const Study& study, const StudyOptions& options) {
  return {.runs = options.ensemble.value_or(study.usual_runs),
          .spread = options.spread.value_or(options.vary.empty() ? k_usual_spread : 0),
          .vary = options.vary,
          .seed = static_cast<std::uint64_t>(options.seed)};
}

const Study k_overturn_study = {
    .name = "overturn",
    .about = "what overturns over two keys of a scene, such as frequency and amplitude",
    .x = "frequency or duration of the first shake",
    .y = "its amplitude",
    .takes_ensemble = true,
    .sweep = [](io::Scene scene, const StudyOptions& options) {
      const auto plan = std::make_shared<study::OverturnPlan>(study::plan_overturn(
          std::move(scene), options.x, options.y, ensemble_of(k_overturn_study, options)));
      return sweep_of(plan, work_on(*plan), overturn_findings, plan->chunk > 1 ? "parts" : "runs");
    }};

}  // namespace topple::app
