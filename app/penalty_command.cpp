#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/log.h"
#include "app/progress.h"
#include "app/study_results.h"
#include "solver/io/scene.h"
#include "solver/study/penalty_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
using Case = study::PenaltyRow::Case;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

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
           {{"jobs", options.jobs},
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

std::string cell(const study::PenaltyRow& row, double value, const char* pattern) {
  return row.computed ? fmt::format("{:>11}", fmt::format(fmt::runtime(pattern), value))
                      : fmt::format("{:>11}", row.status.substr(0, 10));
}

/// What alpha does to one group of bodies, a line an alpha.
std::string alpha_table(const study::PenaltyStudy& results, int group) {
  std::string text = fmt::format("{}\n{:>11}{:>11}{:>11}{:>11}{:>11}", results.groups[group].names,
                                 "alpha, kgf", "depth/L", "bounce, Hz", "tipping, %", "fall, %");
  for (const double ratio : study::k_pulse_ratios)
    text += fmt::format("{:>11}", fmt::format("w/p={:g}, %", ratio));
  text += fmt::format("{:>11}\n", "step, ms");
  for (const double alpha : results.alphas) {
    text += fmt::format("{:>11.6g}", alpha / k_standard_gravity);
    double step = results.time_step;
    for (const study::PenaltyRow& row : results.rows) {
      if (row.group != group || row.kind == Case::creep || row.coarse || row.law.alpha != alpha) continue;
      if (row.time_step > 0) step = row.time_step;
      if (row.kind == Case::depth || row.kind == Case::frequency)
        text += cell(row, row.computed.value_or(0), row.kind == Case::depth ? "{:.2e}" : "{:.4g}");
      else
        text += cell(row, row.computed ? 100 * (*row.computed / *row.reference - 1) : 0, "{:.2f}");
    }
    text += (step > 0 ? fmt::format("{:>11.3g}", 1e3 * step) : fmt::format("{:>11}", "auto")) + "\n";
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
  std::string text = fmt::format("{:<14}", "impact, m/s");
  for (const ContactLawKind kind : study::k_laws) {
    std::string line;
    for (const study::PenaltyRow& row : results.rows) {
      if (row.kind != Case::restitution || row.law.kind != kind) continue;
      if (kind == study::k_laws[0]) text += fmt::format("{:>7g}", *row.at);
      line += row.computed ? fmt::format("{:>7.3f}", *row.computed) : fmt::format("{:>7}", "-");
    }
    text += fmt::format("{}\n", kind == study::k_laws[0] ? "" : "");
    text += fmt::format("{:<14}{}", "e, " + study::law_name(kind), line);
  }
  return text + "\n";
}

std::string advice_text(const study::Advice& advice) {
  std::string text =
      advice.alpha ? "recommended alpha: " + study::kgf_text(*advice.alpha) : "no alpha to recommend";
  if (advice.alpha && advice.time_step && !advice.resolved)
    text += fmt::format(" with time_step = {:.2g} ms", 1e3 * *advice.time_step);
  text += "\n";
  for (const std::string& reason : advice.reasons) text += "  " + reason + "\n";
  return text;
}

}  // namespace

int penalty_command(const StudyOptions& options) {
  const io::Scene scene = io::load_scene(options.scene);
  if (const std::string why = study::why_not_studied(scene.setup); !why.empty())
    throw BadInput("study penalty: " + options.scene + " " + why);
  const std::string stem = place_for_results(options.folder, "penalty");
  defer_interrupts();
  const auto start = Clock::now();
  std::optional<Progress> progress;
  const study::PenaltyStudy results = study::study_penalty(
      scene.name, scene.title, scene.setup, {.jobs = options.jobs}, [&](int done, int of) {
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
