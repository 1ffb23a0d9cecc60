#include <fmt/format.h>

#include "app/study/coarser_models.h"
#include "app/study/study.h"
#include "solver/study/overturn/fragility_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

constexpr double k_usual_slide = 0.05;  // m
constexpr double k_square = 1 - 1e-6;   // share of the motion, across an edge: all of it

std::string between(const study::Interval& interval) {
  return fmt::format("{:.4g} to {:.4g}", interval.low, interval.high);
}

std::string line_of(const study::FragilityPlan& plan, const study::FragilityCurve& curve, const char* state) {
  std::string out = fmt::format("  {:<9}", state);
  if (!curve.fit.fit) return out + "no curve: " + curve.fit.why_not + "\n";
  const study::Lognormal& fit = *curve.fit.fit;
  const std::string unit = plan.levels.unit.empty() ? "" : " " + plan.levels.unit;
  out += fmt::format("median {:.4g}{} (95 %: {}), beta {:.3g} ({})", curve.median, unit,
                     between(curve.median_of_runs), fit.beta, between(curve.beta_of_runs));
  if (curve.scatter > 1)
    out += fmt::format("; shares scatter {:.2g} times as far as by chance", curve.scatter);
  if (curve.median_of_records)
    out += fmt::format("; among records {}, beta {}", between(*curve.median_of_records),
                       between(*curve.beta_of_records));
  return out + "\n";
}

/// At the level where it is open least.
std::string open_share(const study::FragilityPlan& plan, const study::FragilityCurve& closed) {
  const auto share = [](const study::Level& level) {
    return level.runs > 0 ? static_cast<double>(level.hits) / level.runs : -1;
  };
  const auto worst = std::ranges::max_element(closed.levels, {}, share);
  if (worst == closed.levels.end() || worst->runs == 0) return "";
  const int open = worst->runs - worst->hits;
  const study::Interval bounds = study::wilson(open, worst->runs);
  return fmt::format(
      "  open      least at {:.4g}{}, in {} of {} runs: probability {:.3g} (95 %: {:.3g} to {:.3g})\n",
      worst->intensity, plan.levels.unit.empty() ? "" : " " + plan.levels.unit, open, worst->runs,
      static_cast<double>(open) / worst->runs, bounds.low, bounds.high);
}

std::string criteria_in_words(const study::FragilityPlan& plan, const study::FragilityResults& results,
                              std::size_t b) {
  if (b >= results.criteria.size()) return "";
  const study::BodyCriteria& c = results.criteria[b];
  if (!c.why_not.empty()) return "  no criteria: " + c.why_not + "\n";
  return fmt::format(
      "  West {:.4g}, Ishiyama {:.4g}, evaluation A_R50 {:.4g} {} (corner {:.3g} Hz, motion {:.3g} Hz){}\n",
      c.west, c.ishiyama, c.evaluation, plan.levels.unit, c.corner, results.frequency,
      !c.along_a_line ? ", of motion over the nearest edge alone; the axis takes all directions together"
      : c.share < k_square
          ? fmt::format(", over the edge that lifts first, across which {:.3g} of the motion goes", c.share)
          : "");
}

std::string in_words(const study::FragilityPlan& plan, const study::FragilityResults& results) {
  std::string text = fmt::format(
      "probability over the {}{}, sliding over {:g} mm before the critical angle\n", plan.measure->title,
      plan.levels.unit.empty() ? "" : ", " + plan.levels.unit, 1e3 * plan.slide);
  if (results.runs < results.of)
    text +=
        fmt::format("of {} of {} runs alone; the others are not computed yet\n", results.runs, results.of);
  for (std::size_t b = 0; b < results.bodies.size(); ++b) {
    text += results.bodies[b] + "\n";
    for (std::size_t s = 0; s < study::k_states; ++s)
      text += line_of(plan, results.curves[b][s], study::damage_states()[s].word);
    text += criteria_in_words(plan, results, b);
  }
  for (std::size_t p = 0; p < results.closed.size(); ++p)
    text += "way out from " + plan.scene.setup.room.places[p].name + "\n" +
            open_share(plan, results.closed[p]) + line_of(plan, results.closed[p], "closed");
  if (results.failed > 0)
    text += fmt::format("{} run{} failed, the first: {}\n", results.failed, results.failed == 1 ? "" : "s",
                        results.status);
  const bool all = results.planar == results.runs;
  text += coarser_in_words(plan.scene, plan.set);
  return text + fmt::format("{} of {} runs as planar blocks{}\n", results.planar, results.runs,
                            all ? ""
                            : results.why_not_planar.empty()
                                ? study::k_climbed
                                : ", the others as bodies in space; the scene itself is none: " +
                                      results.why_not_planar);
}

Findings findings(const study::FragilityPlan& plan, const study::FragilityResults& results) {
  ordered_json entries{{"run", results.runs},
                       {"of", results.of},
                       {"failed", results.failed},
                       {"planar", results.planar},
                       {"cpu_s", results.cpu}};
  entries.update(curves_as_json(plan, results));
  entries["rows"] = rows_as_json(plan, results);
  return {
      .title = "How likely bodies overturn in " + plan.scene.name + " over the " + plan.measure->title,
      .units = {{"measure", plan.levels.unit},
                {"median", plan.levels.unit + ", of a lognormal distribution; _95: by Fisher's information; "
                                              "_95_of_records: records drawn anew from themselves"},
                {"probability", "1, of runs; low, high: 95 % by Wilson's score"},
                {"cpu_s", "s, of the solving threads"}},
      .settings = {{"vary", plan.factors.texts},
                   {"seed", plan.factors.seed},
                   {"records", plan.factors.records},
                   {"runs_of_a_record_at_a_level", plan.runs},
                   {"slide_m", plan.slide},
                   {"duration_s", plan.scene.setup.run.duration},
                   {"set", plan.set}},
      .entries = entries,
      .chart = [&plan, &results](
                   const std::string& origin,
                   study::ChartFormat format) { return fragility_chart(plan, results, origin, format); },
      .text = in_words(plan, results),
      .each = fmt::format(" of up to {} runs", plan.chunk),
      .pace = fmt::format(", {:.4g} runs a second and core{}",
                          static_cast<double>(results.runs) / std::max(1e-9, results.cpu),
                          results.runs < results.of ? " of those that ended" : "")};
}

}  // namespace

const Study k_fragility_study = {
    .name = "fragility",
    .about = "probability of uplift, sliding and overturning over a measure of the floor's motion",
    .x = "pga=50 gal..2000 gal:24 (pga, pgv, arias, jma)",
    .takes_ensemble = true,
    .takes_slide = true,
    .usual_runs = 400,
    .sweep = [](io::Scene scene, const StudyOptions& options) {
      const auto plan = std::make_shared<study::FragilityPlan>(
          study::plan_fragility(std::move(scene), options.x, ensemble_of(k_fragility_study, options),
                                options.slide.value_or(k_usual_slide)));
      const MakeWork make = [plan = plan.get()] {
        return [runner = study::FragilityRunner(*plan)](int k, const std::function<bool()>& give_up) mutable {
          return runner.run(k, give_up);
        };
      };
      return sweep_of(plan, make, findings, "parts");
    }};

}  // namespace topple::app
