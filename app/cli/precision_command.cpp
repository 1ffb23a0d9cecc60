#include <fmt/format.h>

#include <filesystem>

#include "app/cli/study_commands.h"
#include "app/study/study_results.h"
#include "app/study/sweep.h"
#include "app/study/told_scene.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "solver/study/common/measure.h"
#include "solver/study/precision/precision_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

MakeWork work_on(const study::PrecisionPlan& plan) {
  return [&plan] {
    return [&plan](int k, const std::function<bool()>& give_up) { return study::run_case(plan, k, give_up); };
  };
}

ordered_json document(const study::PrecisionPlan& plan, const study::PrecisionStudy& results,
                      const Crew& crew, const StudyOptions& options, double wall_s) {
  ordered_json json = sweep_json(
      "precision", "Error against CPU time of " + plan.scene.name, plan.scene, crew, options,
      {{"tilt_error", "1, root mean square over the window, over the least critical angle"},
       {"overturn_time_error", "1, relative"},
       {"peak_stress_error", "1, relative"},
       {"energy_error", "1, energy that nothing explains over the largest exchanged"},
       {"window_s", "s, in which runs are compared; the two references part at its end, or it is the run's"},
       {"alpha_N", "N"},
       {"time_step_s", "s, null: by tolerance"},
       {"cpu_s_per_s", "1, CPU time of the solving thread, settling included, over simulated time"},
       {"wall_s", "s"}},
      {{"duration_s", plan.scene.setup.run.duration},
       {"interval_s", plan.interval},
       {"parted", study::k_parted},
       {"ends",
        "when all bodies have overturned (tilt over 60 deg for 0.5 s), unless the scene names a stop"}});
  json["run"] = results.run;
  json["of"] = results.of;
  json["wall_s"] = wall_s;
  json.update(findings_as_json(plan, results));
  json["rows"] = rows_as_json(plan, results);
  return json;
}

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
    if (const auto place = place_of_default(plan, results, measure))
      text += fmt::format(
          "  {}: off by {}; others are as exact for {:.2g} of its cost, {:.2g} times nearer for all of it\n",
          name(measure), percent(*own.errors[index(measure)]), 1 / place->dearer, place->coarser);
  }
  return text;
}

}  // namespace

int precision_command(const StudyOptions& options) {
  Crew crew(options.jobs.value_or(1));
  defer_interrupts();
  if (!crew.leads()) {
    if (const auto heard = crew.listen()) {
      const study::PrecisionPlan plan = study::plan_precision(scene_from(*heard));
      crew.serve(work_on(plan), options.quick);
    }
    return k_done;
  }
  const study::PrecisionPlan plan = study::plan_precision(io::load_scene(options.scene, options.overrides));
  const std::string stem = place_for_results(options.folder, "precision");
  const auto start = Clock::now();
  const std::optional<SweepEnd> end = sweep(crew,
                                            {.kind = "precision",
                                             .stem = stem,
                                             .settings = settings_of(plan),
                                             .order = case_order(plan),
                                             .told = told(plan.scene),
                                             .make = work_on(plan)},
                                            options);
  if (!end) return k_interrupted;
  const double wall_s = seconds_since(start);
  const study::PrecisionStudy results = gather(plan, end->rows);
  const ordered_json json = document(plan, results, crew, options, wall_s);
  write_sweep(*end, stem, json, [&](study::ChartFormat format) {
    return precision_chart(plan, results, origin_text(), format);
  });
  fmt::print("{}{}{}{} in {:.1f} s{}\n{}.csv, .json, .svg, .png\n", reference_in_words(plan, results),
             cheapest_in_words(plan, results), default_in_words(plan, results), end->runs_in_words(), wall_s,
             end->left_in_words(options.quick, "the dearest"), stem);
  return k_done;
}

}  // namespace topple::app
