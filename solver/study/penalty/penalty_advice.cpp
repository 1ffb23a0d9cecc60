#include "solver/study/penalty/penalty_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace topple::study {
namespace {

using nlohmann::ordered_json;
using Case = PenaltyRow::Case;

bool same(double a, double b) {
  return std::abs(a - b) < 1e-6 * b;
}

bool decides(const PenaltyRow& row, double alpha) {
  return (row.kind == Case::depth || row.kind == Case::tipping || row.kind == Case::fall_back ||
          row.kind == Case::half_sine) &&
         row.status != "slides" && !row.coarse && same(row.law.alpha, alpha);
}

std::string percent(double share) {
  return fmt::format("{:.2g} %", 100 * share);
}

/// "steady tipping 1.9 % off", with the body's name where there are several.
std::string row_in_words(const PenaltyStudy& study, const PenaltyRow& row) {
  std::string what = row.kind == Case::depth       ? "depth at rest"
                     : row.kind == Case::tipping   ? "steady tipping"
                     : row.kind == Case::fall_back ? "fall-back time"
                                                   : fmt::format("half-sine (w/p = {:g})", *row.at);
  const auto stands = [](const BodyGroup& group) { return group.obstacle.empty(); };
  if (std::count_if(study.groups.begin(), study.groups.end(), stands) > 1)
    what = study.groups[row.group].names + ": " + what;
  if (!row.computed) return what + ": " + row.status;
  if (row.kind == Case::depth) return what + " " + percent(*row.computed) + " of L";
  return what + " " + percent(*row.error()) + (*row.computed < *row.reference ? " low" : " high");
}

std::string steps_in_words(double period, double step) {
  return fmt::format("{:.3g} steps of {:.3g} ms", period / step, 1e3 * step);
}

/// Shortest period of the bounce of any body, s.
double least_period(const PenaltyStudy& study, double alpha) {
  double period = 1e300;
  for (const BodyGroup& group : study.groups) {
    if (!group.obstacle.empty()) continue;
    ContactLaw law = study.law;
    law.alpha = alpha;
    period = std::min(period, 1 / bounce_frequency(group.theory, law));
  }
  return period;
}

std::string judged(const AlphaVerdict& verdict, const std::string& whose) {
  const std::string begin = whose + ", " + kgf_text(verdict.alpha) + ", ";
  if (!verdict.missed.empty())
    return begin +
           fmt::format("cannot give the right verdict within 2 %: {}.", fmt::join(verdict.missed, "; "));
  return begin + (verdict.complete ? "keeps every bound." : "was not judged: runs are missing.");
}

std::string bounds_in_words() {
  return fmt::format(
      "Bounds: depth at rest {:g} % of L; {:g} % of rigid contact for the steady acceleration that tips, the "
      "time to fall back from half of the critical angle, and the least half-sine that overturns.",
      100 * k_depth_bound, 100 * k_theory_bound);
}

/// What steady tipping alone asks for.
std::string steady_in_words(const BodyGroup& group) {
  return fmt::format(
      "Steady tipping of {}: on its edge the weight sinks the row of contacts there, and the lean of "
      "(L/s)(W/(n_e alpha))^(1/q) comes off b/h = {:.4g}; theory asks for {} at {:g} %.",
      group.names, group.theory.rigid_limit(), kgf_text(group.steady_alpha), 100 * k_theory_bound);
}

/// What the scene's own step gives where it does not resolve the bounce.
std::vector<std::string> at_own_step(const PenaltyStudy& study, double alpha) {
  std::vector<std::string> found;
  for (const PenaltyRow& row : study.rows)
    if (row.coarse && same(row.law.alpha, alpha) && row.computed) found.push_back(row_in_words(study, row));
  return found;
}

void add_step(const PenaltyStudy& study, double alpha, Advice& advice) {
  if (study.time_step <= 0) {
    advice.resolved = true;
    advice.reasons.push_back("Step: adaptive, it follows the bounce.");
    return;
  }
  const double period = least_period(study, alpha);
  advice.resolved = period >= k_period_steps * study.time_step;
  advice.time_step = std::min(study.time_step, period / k_period_steps);
  std::string text = fmt::format("Step: a bounce takes {:.3g} ms there, {}", 1e3 * period,
                                 steps_in_words(period, study.time_step));
  if (advice.resolved) {
    advice.reasons.push_back(text + fmt::format("; {:g} resolve it.", k_period_steps));
    return;
  }
  advice.reasons.push_back(text +
                           fmt::format("; {:g} resolve it: time_step = {:.2g} ms, as the runs here took.",
                                       k_period_steps, 1e3 * *advice.time_step));
  if (const std::vector<std::string> coarse = at_own_step(study, alpha); !coarse.empty())
    advice.reasons.push_back(fmt::format("With the scene's own step of {:.3g} ms: {}.", 1e3 * study.time_step,
                                         fmt::join(coarse, "; ")));
  const auto above = std::find_if(study.alphas.begin(), study.alphas.end(), [&](double tried) {
    return least_period(study, tried) < k_period_steps * study.time_step;
  });
  if (above == study.alphas.begin()) return;
  const AlphaVerdict best = verdict(study, *std::prev(above));
  advice.reasons.push_back(
      fmt::format("No alpha keeps the bounds with {:g} steps of {:.3g} ms a bounce; the stiffest tried with "
                  "them, {}, misses: {}.",
                  k_period_steps, 1e3 * study.time_step, kgf_text(best.alpha), fmt::join(best.missed, "; ")));
}

ordered_json verdict_as_json(const AlphaVerdict& verdict) {
  return {{"alpha_N", verdict.alpha},
          {"keeps_bounds", verdict.complete         ? ordered_json(verdict.missed.empty())
                           : verdict.missed.empty() ? ordered_json(nullptr)
                                                    : ordered_json(false)},
          {"kept", verdict.kept},
          {"missed", verdict.missed}};
}

}  // namespace

AlphaVerdict verdict(const PenaltyStudy& study, double alpha) {
  AlphaVerdict found{alpha, true, {}, {}};
  for (const PenaltyRow& row : study.rows) {
    if (!decides(row, alpha)) continue;
    if (row.status == "not run")
      found.complete = false;
    else
      (row.kept().value_or(true) ? found.kept : found.missed).push_back(row_in_words(study, row));
  }
  return found;
}

Advice advise(const PenaltyStudy& study) {
  Advice advice;
  advice.of_scene = verdict(study, study.law.alpha);
  advice.of_default = verdict(study, ContactLaw().alpha);
  std::vector<AlphaVerdict> tried;
  for (const double alpha : study.alphas) tried.push_back(verdict(study, alpha));
  for (std::size_t k = 0; k < tried.size() && !advice.alpha; ++k)
    if (tried[k].good() && (k + 1 == tried.size() || tried[k + 1].good())) advice.alpha = tried[k].alpha;
  advice.undecided = !advice.alpha && std::ranges::any_of(tried, &AlphaVerdict::undecided);
  std::vector<std::string>& reasons = advice.reasons;
  if (advice.alpha) {
    reasons.push_back(fmt::format("It is the smallest tried that keeps every bound: {}.",
                                  fmt::join(verdict(study, *advice.alpha).kept, "; ")));
  } else if (advice.undecided) {
    reasons.push_back("Runs are missing that would decide it.");
  } else {
    reasons.push_back(fmt::format("No alpha from {} to {} keeps every bound; the last misses: {}.",
                                  kgf_text(tried.front().alpha), kgf_text(tried.back().alpha),
                                  fmt::join(tried.back().missed, "; ")));
  }
  reasons.push_back(bounds_in_words());
  for (const BodyGroup& group : study.groups) {
    if (!group.obstacle.empty()) continue;
    const double rigid = group.theory.rigid_limit(), friction = group.theory.grip * study.law.friction;
    reasons.push_back(
        rigid <= friction
            ? steady_in_words(group)
            : fmt::format("{} slides before it tips, b/h = {:.3g} with friction {:g}: its depth at "
                          "rest alone counts.",
                          group.names, rigid, friction));
  }
  if (advice.alpha) add_step(study, *advice.alpha, advice);
  reasons.push_back(judged(advice.of_scene, "The scene's alpha"));
  if (!same(study.law.alpha, ContactLaw().alpha))
    reasons.push_back(judged(advice.of_default, "The paper's alpha"));
  return advice;
}

ordered_json advice_as_json(const Advice& advice) {
  return {{"alpha_N", advice.alpha ? ordered_json(*advice.alpha) : ordered_json(nullptr)},
          {"time_step_s", advice.time_step ? ordered_json(*advice.time_step) : ordered_json(nullptr)},
          {"resolved_by_the_scenes_step", advice.resolved},
          {"reasons", advice.reasons},
          {"scene", verdict_as_json(advice.of_scene)},
          {"default", verdict_as_json(advice.of_default)}};
}

std::string kgf_text(double alpha) {
  const double kgf = alpha / k_standard_gravity;
  const double digit = std::pow(10., std::floor(std::log10(kgf)) - 3);
  return fmt::format("{:.7g} kgf", std::round(kgf / digit) * digit);
}

}  // namespace topple::study
