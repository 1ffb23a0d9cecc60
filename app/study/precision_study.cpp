#include <fmt/format.h>

#include "app/study/study.h"
#include "solver/study/precision/precision_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

constexpr double k_better = 1.05;  // in cost or error; less is written as 1

std::string percent(double share) {
  return share == 0 ? "0 %" : fmt::format("{:.2g} %", 100 * share);
}

std::string reference_in_words(const study::PrecisionPlan& plan, const study::PrecisionStudy& results) {
  const study::Reference& reference = results.references.front();
  if (reference.run < 0) return "no reference: " + reference.why_not + "\n";
  const study::Errors& off = reference.uncertainty;
  std::string text = fmt::format("reference: {}; {} is off by", in_words(plan, reference.run),
                                 in_words(plan, reference.check));
  for (int m = 0; m < study::k_measures; ++m)
    if (off[static_cast<std::size_t>(m)])
      text += fmt::format("{} {} ({})", m > 0 ? "," : "", percent(*off[static_cast<std::size_t>(m)]),
                          name(static_cast<study::Measure>(m)));
  if (reference.order) text += fmt::format("; order of convergence {:.2g}", *reference.order);
  text += fmt::format("\ncompared over {:.4g} of {:.4g} s", reference.window, reference.end);
  return text + (reference.window < reference.end - plan.interval ? ", then the two part\n" : "\n");
}

/// The cheapest settings of the scene's own law and alpha, a line a measure and error.
std::string cheapest_in_words(const study::PrecisionPlan& plan, const study::PrecisionStudy& results) {
  std::string text =
      fmt::format("{:<16}{:<8}{:<48}{}\n", "error of", "within", "cheapest", "CPU time per simulated s");
  for (int m = 0; m < study::k_measures; ++m)
    for (const double level : study::k_levels) {
      const auto measure = static_cast<study::Measure>(m);
      const std::optional<int> k = cheapest(plan, results, 0, measure, level);
      text += fmt::format(
          "{:<16}{:<8}{:<48}{}\n", level == study::k_levels[0] ? name(measure) : "", percent(level),
          k ? in_words(plan, *k) : "-",
          k ? fmt::format("{:.3g} ms", 1e3 * *results.rows[static_cast<std::size_t>(*k)].cost) : "");
    }
  return text;
}

std::string default_in_words(const study::PrecisionPlan& plan, const study::PrecisionStudy& results) {
  const study::PrecisionRow& own = results.rows.front();
  if (!own.cost) return "";
  std::string text = fmt::format("{}: {:.3g} ms per simulated s\n", in_words(plan, 0), 1e3 * *own.cost);
  for (int m = 0; m < study::k_measures; ++m) {
    const auto measure = static_cast<study::Measure>(m);
    if (const auto place = place_of_default(plan, results, measure)) {
      const bool cheaper = place->cost_ratio > k_better, nearer = place->error_ratio > k_better;
      text += fmt::format("  {}: off by {}", name(measure), percent(*own.errors[index(measure)]));
      if (const auto& off = results.references.front().uncertainty[index(measure)])
        text += fmt::format(", the reference itself by {}", percent(*off));
      text += "; ";
      const char* const others =
          own.errors[index(study::Measure::peak_stress)] ? "others with stresses" : "others";
      if (cheaper)
        text += fmt::format("{} are as exact for {:.2g} of its cost", others, 1 / place->cost_ratio);
      if (nearer)
        text += fmt::format("{} {:.2g} times nearer for all of it",
                            cheaper ? "," : fmt::format("{} are", others), place->error_ratio);
      text += cheaper || nearer ? "\n" : "no other is as exact for less, or nearer for the same\n";
    }
  }
  return text;
}

Findings precision_findings(const study::PrecisionPlan& plan, const study::PrecisionStudy& results) {
  ordered_json entries{{"run", results.run}, {"of", results.of}};
  entries.update(findings_as_json(plan, results));
  entries["rows"] = rows_as_json(plan, results);
  return {
      .title = "Error against CPU time of " + plan.scene.name,
      .units = {{"tilt_error", "1, root mean square over the window, over the least critical angle"},
                {"overturn_time_error", "1, relative"},
                {"peak_stress_error", "1, relative"},
                {"energy_error", "1, energy that nothing explains over the largest exchanged"},
                {"window_s",
                 "s, in which runs are compared; the two references part at its end, or it is the run's"},
                {"alpha_N", "N"},
                {"time_step_s", "s, null: by tolerance"},
                {"cpu_s_per_s", "1, CPU time of the solving thread, settling included, over simulated time"}},
      .settings = {{"duration_s", plan.scene.setup.run.duration},
                   {"interval_s", plan.interval},
                   {"parted", study::k_parted},
                   {"ends",
                    "when all bodies have overturned (tilt over 60 deg for 0.5 s), unless the scene names a "
                    "stop"}},
      .entries = entries,
      .chart = [&plan, &results](
                   const std::string& origin,
                   study::ChartFormat format) { return precision_chart(plan, results, origin, format); },
      .text = reference_in_words(plan, results) + cheapest_in_words(plan, results) +
              default_in_words(plan, results)};
}

}  // namespace

const Study k_precision_study = {
    .name = "precision",
    .about = "error against CPU time of a scene's integrators, steps and models",
    .timed = true,
    .left_out = "the dearest",
    .sweep = [](io::Scene scene, const StudyOptions&) {
      const auto plan = std::make_shared<study::PrecisionPlan>(study::plan_precision(std::move(scene)));
      return sweep_of(plan, work_on(*plan), precision_findings);
    }};

}  // namespace topple::app
