#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "app/cli/study_commands.h"
#include "app/study/study_results.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "solver/io/scene/scene.h"
#include "solver/study/common/laws.h"
#include "solver/study/penalty/penalty_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;
using Case = study::PenaltyRow::Case;

ordered_json law_json(const ContactLaw& law) {
  return {{"law", study::law_name(law.kind)},
          {"alpha_N", law.alpha},
          {"q", law.q},
          {"friction", law.friction},
          {"restitution", law.restitution},
          {"normal_speed_m_s", law.normal_speed},
          {"slip_speed_m_s", law.slip_speed}};
}

ordered_json document(const study::PenaltyStudy& results, const study::Advice& advice,
                      const StudyOptions& options, double wall_s) {
  return {{"topple", TOPPLE_VERSION},
          {"schema", 1},
          {"study", "penalty"},
          {"scene", results.scene},
          {"title", "Penalty contact of " + results.scene +
                        ": force, rest, creep, restitution, and what alpha "
                        "does to standing bodies"},
          {"scene_title", results.title},
          {"units",
           {{"alpha_N", "N"},
            {"time_step_s", "s, null: adaptive or none"},
            {"computed", "the row's unit"},
            {"reference", "the row's unit"},
            {"error", "1, |computed - reference|/|reference|"},
            {"wall_s", "s"}}},
          {"machine", machine_json()},
          {"settings",
           {{"jobs", options.jobs.value_or(1)},
            {"quick", options.quick},
            {"contact", law_json(results.law)},
            {"time_step_s", results.time_step > 0 ? ordered_json(results.time_step) : ordered_json("auto")},
            {"bodies", "alone on the floor, in their reference pose; creep: with the scene's walls"}}},
          {"run", results.run},
          {"of", results.of},
          {"wall_s", wall_s},
          {"recommendation", advice_as_json(advice)},
          {"bodies", groups_as_json(results)},
          {"cases", study::cases_as_json()},
          {"rows", rows_as_json(results)}};
}

constexpr std::size_t k_column = 12;

std::string cell(const std::string& text) {
  return fmt::format("{:>{}}", text.size() < k_column ? text : "-", k_column);
}

std::string cell(const study::PenaltyRow& row) {
  if (!row.computed) return cell(row.status);
  if (row.kind == Case::depth) return cell(fmt::format("{:.2e}", *row.computed));
  if (row.kind == Case::frequency) return cell(fmt::format("{:.4g}", *row.computed));
  return cell(fmt::format("{:+.2f}", 100 * (*row.computed / *row.reference - 1)));
}

/// What alpha does to one group of bodies, a line an alpha.
std::string alpha_table(const study::PenaltyStudy& results, int group) {
  std::string text = results.groups[group].names + "\n";
  for (const char* head : {"alpha, kgf", "depth/L", "bounce, Hz", "tipping, %", "fallback, %"})
    text += cell(head);
  for (const double ratio : study::k_pulse_ratios) text += cell(fmt::format("w/p={:g}, %", ratio));
  text += cell("step, ms") + "\n";
  for (const double alpha : results.alphas) {
    text += cell(fmt::format("{:.7g}", alpha / k_standard_gravity));
    double step = results.time_step;
    for (const study::PenaltyRow& row : results.rows) {
      if (row.group != group || row.kind == Case::creep || row.coarse || row.law.alpha != alpha) continue;
      if (row.time_step > 0) step = row.time_step;
      text += cell(row);
    }
    text += cell(step > 0 ? fmt::format("{:.3g}", 1e3 * step) : "auto") + "\n";
  }
  return text;
}

std::string creep_table(const study::PenaltyStudy& results) {
  std::string text = fmt::format("creep in {:g} s at rest, um (bound {:g})\n", study::k_creep_time,
                                 1e6 * study::k_creep_bound);
  for (const study::PenaltyRow& row : results.rows)
    if (row.kind == Case::creep)
      text +=
          fmt::format("  {:<10}{:<24}{}{}\n", study::law_name(row.law.kind), results.groups[row.group].names,
                      row.computed ? fmt::format("{:.2g}", 1e6 * *row.computed) : row.status,
                      row.computed && !*row.kept() ? "  over the bound" : "");
  return text;
}

std::string restitution_table(const study::PenaltyStudy& results) {
  std::string speeds, lines;
  for (const ContactLawKind kind : study::k_laws) {
    lines += fmt::format("  {:<12}", study::law_name(kind));
    for (const study::PenaltyRow& row : results.rows) {
      if (row.kind != Case::restitution || row.law.kind != kind) continue;
      if (kind == study::k_laws[0]) speeds += fmt::format("{:>7g}", *row.at);
      lines += row.computed ? fmt::format("{:>7.3f}", *row.computed) : fmt::format("{:>7}", "-");
    }
    lines += "\n";
  }
  return fmt::format("restitution at\n  {:<12}{}\n{}", "speed, m/s", speeds, lines);
}

/// Lines of up to 100 characters, the first behind a dash.
std::string wrapped(const std::string& sentence) {
  constexpr std::size_t k_line = 100;
  std::string text, line = "-";
  std::istringstream words(sentence);
  for (std::string word; words >> word; line += " " + word) {
    if (line.size() + 1 + word.size() <= k_line) continue;
    text += line + "\n";
    line = " ";
  }
  return text + line + "\n";
}

std::string advice_text(const study::Advice& advice) {
  std::string text = advice.alpha       ? "recommended alpha: " + study::kgf_text(*advice.alpha)
                     : advice.undecided ? "no alpha to recommend yet"
                                        : "no alpha to recommend";
  if (advice.alpha && advice.time_step && !advice.resolved)
    text += fmt::format(" with time_step = {:.2g} ms", 1e3 * *advice.time_step);
  text += "\n";
  for (const std::string& reason : advice.reasons) text += wrapped(reason);
  return text;
}

}  // namespace

int penalty_command(const StudyOptions& options) {
  const io::Scene scene = io::load_scene(options.scene, options.overrides);
  if (const std::string why = study::why_not_studied(scene.setup); !why.empty())
    throw BadInput("study penalty: " + options.scene + " " + why);
  const std::string stem = place_for_results(options.folder, "penalty");
  defer_interrupts();
  const auto start = Clock::now();
  std::optional<Progress> progress;
  const study::PenaltyStudy results = study::study_penalty(
      scene.name, scene.title, scene.setup, {.jobs = options.jobs.value_or(1)}, [&](int done, int of) {
        if (!progress) progress.emplace("study penalty", "runs", of, options.quiet);
        progress->update(done);
        return !interrupted() && !(options.quick && seconds_since(start) > k_quick);
      });
  progress.reset();
  if (interrupted()) {
    say("interrupted before every case had run");
    return k_interrupted;
  }
  const double wall_s = seconds_since(start);
  const study::Advice advice = advise(results);
  const ordered_json json = document(results, advice, options, wall_s);
  write_study(stem, json["rows"], json, [&](study::ChartFormat format) {
    return penalty_chart(results, advice, origin_text(), format);
  });
  for (int g = 0; g < static_cast<int>(results.groups.size()); ++g) {
    const study::BodyGroup& group = results.groups[g];
    fmt::print("{}",
               group.obstacle.empty() ? alpha_table(results, g) : group.names + " " + group.obstacle + "\n");
  }
  fmt::print("{}{}{}", creep_table(results), restitution_table(results), advice_text(advice));
  const char* const covered = !options.quick              ? ""
                              : results.run == results.of ? ": --quick left nothing out"
                                                          : ": --quick left out the last";
  fmt::print("{} of {} runs in {:.1f} s{}\n{}.csv, .json, .svg, .png\n", results.run, results.of, wall_s,
             covered, stem);
  return k_done;
}

}  // namespace topple::app
