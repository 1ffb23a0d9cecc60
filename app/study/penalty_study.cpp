#include <fmt/format.h>

#include <sstream>

#include "app/study/study.h"
#include "app/support/errors.h"
#include "solver/contact/contact_law.h"
#include "solver/study/penalty/penalty_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;
using Case = study::PenaltyRow::Case;

ordered_json law_json(const ContactLaw& law) {
  return {{"law", traits(law).word},
          {"alpha_N", law.alpha},
          {"q", law.q},
          {"friction", law.friction},
          {"restitution", law.restitution},
          {"normal_speed_m_s", law.normal_speed},
          {"slip_speed_m_s", law.slip_speed}};
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
      text += fmt::format("  {:<10}{:<24}{}{}\n", traits(row.law).word, results.groups[row.group].names,
                          row.computed ? fmt::format("{:.2g}", 1e6 * *row.computed) : row.status,
                          row.computed && !*row.kept() ? "  over the bound" : "");
  return text;
}

std::string restitution_table(const study::PenaltyStudy& results) {
  std::string speeds, lines;
  for (const ContactLawTraits& law : contact_laws()) {
    lines += fmt::format("  {:<12}", law.word);
    for (const study::PenaltyRow& row : results.rows) {
      if (row.kind != Case::restitution || row.law.kind != law.kind) continue;
      if (&law == contact_laws().data()) speeds += fmt::format("{:>7g}", *row.at);
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

std::string tables(const study::PenaltyStudy& results, const study::Advice& advice) {
  std::string text;
  for (int g = 0; g < static_cast<int>(results.groups.size()); ++g) {
    const study::BodyGroup& group = results.groups[g];
    text += group.obstacle.empty() ? alpha_table(results, g) : group.names + " " + group.obstacle + "\n";
  }
  return text + creep_table(results) + restitution_table(results) + advice_text(advice);
}

}  // namespace

const Study k_penalty_study = {
    .name = "penalty",
    .about = "what the contact law of a scene does, and the alpha to take",
    .timed = true,
    .left_out = "the last",
    .solve = [](io::Scene scene, const StudyOptions& options) -> Solve {
      if (const std::string why = study::why_not_studied(scene.setup); !why.empty())
        throw BadInput("study penalty: " + options.scene + " " + why);
      return [scene = std::move(scene), jobs = options.jobs.value_or(1)](
                 const std::function<bool(int done, int of)>& go_on) -> Findings {
        const study::PenaltyStudy results =
            study::study_penalty(scene.name, scene.title, scene.setup, {.jobs = jobs}, go_on);
        const study::Advice advice = advise(results);
        return {.title = "Penalty contact of " + results.scene +
                         ": force, rest, creep, restitution, and what alpha does to standing bodies",
                .units = {{"alpha_N", "N"},
                          {"time_step_s", "s, null: adaptive or none"},
                          {"computed", "the row's unit"},
                          {"reference", "the row's unit"},
                          {"error", "1, |computed - reference|/|reference|"}},
                .settings = {{"contact", law_json(results.law)},
                             {"time_step_s",
                              results.time_step > 0 ? ordered_json(results.time_step) : ordered_json("auto")},
                             {"bodies",
                              "alone on the floor, in their reference pose; creep: with the scene's walls"}},
                .entries = {{"run", results.run},
                            {"of", results.of},
                            {"recommendation", advice_as_json(advice)},
                            {"bodies", groups_as_json(results)},
                            {"cases", study::cases_as_json()},
                            {"rows", rows_as_json(results)}},
                .chart =
                    [results, advice](const std::string& origin, study::ChartFormat format) {
                      return penalty_chart(results, advice, origin, format);
                    },
                .text = tables(results, advice),
                .run = results.run,
                .of = results.of};
      };
    }};

}  // namespace topple::app
