#include <fmt/format.h>

#include "app/validate/validation.h"
#include "app/validate/validation_page.h"
#include "solver/study/validate/toss_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

struct Tosses {
  std::vector<study::Toss> tosses;
  study::TossFit fit;
  study::TossResults results;
};

struct TossLine {
  const char *name, *unit;
  study::Quantiles study::TossScores::*of;
  double factor;
  int digits;
};
constexpr TossLine k_toss_lines[] = {
    {"last place", "mm", &study::TossScores::place, 1e3, 1},
    {"last place, share of travel", "%", &study::TossScores::place_share, 1e2, 1},
    {"yaw, right face up", "deg", &study::TossScores::yaw, 1, 1},
    {"time to rest", "ms", &study::TossScores::rest, 1e3, 0},
    {"position, mean over time", "mm", &study::TossScores::position, 1e3, 1},
    {"angle, mean over time", "deg", &study::TossScores::angle, 1, 1}};

std::string face_in_words(const study::TossScores& scores) {
  return fmt::format("{:.1f} % ({:.1f} to {:.1f} %)", 100. * scores.face_right / scores.tosses,
                     100 * scores.face_interval.low, 100 * scores.face_interval.high);
}

std::string shown(const TossLine& line, const study::TossScores& scores) {
  const study::Quantiles& q = scores.*line.of;
  return fmt::format("{:.{}f} / {:.{}f}", q.median * line.factor, line.digits, q.ninetieth * line.factor,
                     line.digits);
}

std::string in_words(const Tosses& of) {
  const study::TossScores &fitted = of.results.of_fitted, &published = of.results.of_published;
  std::string text = fmt::format(
      "{} tosses; friction {:g}, restitution {:g} {}, offset of the data {:.2f} mm; median / 90 %\n",
      fitted.tosses, of.fit.contact.friction, of.fit.contact.restitution,
      of.results.fitted_here ? "fitted here, each toss by the other nine tenths"
                             : fmt::format("fitted on {} tosses", of.fit.tosses),
      1e3 * of.fit.offset);
  text += fmt::format("{:<34} {:>18} {:>18}\n", "error", "fitted", "as published");
  for (const TossLine& line : k_toss_lines)
    text += fmt::format("{:<34} {:>18} {:>18}\n", fmt::format("{}, {}", line.name, line.unit),
                        shown(line, fitted), shown(line, published));
  text +=
      fmt::format("right face up: {}; as published {}\n", face_in_words(fitted), face_in_words(published));
  if (fitted.failed + published.failed > 0)
    text += fmt::format("{} runs failed\n", fitted.failed + published.failed);
  return text;
}

std::string page_of(const Tosses& of) {
  const study::TossScores &fitted = of.results.of_fitted, &published = of.results.of_published;
  std::vector<std::vector<std::string>> rows, instants;
  for (const TossLine& line : k_toss_lines)
    rows.push_back(
        {fmt::format("{}, {}", line.name, line.unit), shown(line, fitted), shown(line, published)});
  rows.push_back({"right face up (95 %)", face_in_words(fitted), face_in_words(published)});
  for (std::size_t n = 0; n < fitted.over_time.size(); ++n) {
    const auto &one = fitted.over_time[n], &other = published.over_time[n];
    instants.push_back(
        {fmt::format("{:.1f} s", one.time), std::to_string(one.tosses),
         fmt::format("{:.1f} / {:.1f}", 1e3 * one.position.median, 1e3 * one.position.ninetieth),
         fmt::format("{:.1f} / {:.1f}", one.angle.median, one.angle.ninetieth),
         fmt::format("{:.1f} / {:.1f}", 1e3 * other.position.median, 1e3 * other.position.ninetieth),
         fmt::format("{:.1f} / {:.1f}", other.angle.median, other.angle.ninetieth)});
  }
  return html_section(
             "Result",
             html_tiles(
                 {{fmt::format("{:.0f} mm", 1e3 * fitted.place.median), "median error of the last place"},
                  {fmt::format("{:.1f} %", 100. * fitted.face_right / fitted.tosses), "right face up"},
                  {fmt::format("{:.0f} mm", 1e3 * fitted.position.median), "median error of position"},
                  {std::to_string(fitted.tosses), "tosses"}}) +
                 html_paragraph(
                     "Each toss is computed from its first row: place, rotation and velocities as measured. "
                     "Median / 90 % of the errors.") +
                 html_table({"error", "fitted", "as published"}, rows)) +
         k_chart_here +
         html_section("Over time", html_table({"", "tosses", "position, mm", "angle, deg", "as published, mm",
                                               "as published, deg"},
                                              instants)) +
         html_section(
             "What is fitted",
             html_paragraph(fmt::format(
                 "Friction {:g}{} and restitution {:g}{}, once for all tosses: of a grid those of the least "
                 "mean of "
                 "position over the edge plus angle. As published: {:g} and {:g}. The cube's middle rests "
                 "{:.2f} mm "
                 "lower in the data than half an edge: the board is put that much lower, in all runs.",
                 of.fit.contact.friction,
                 of.results.fitted_here
                     ? fmt::format(" ({:g} to {:g})", of.fit.low.friction, of.fit.high.friction)
                     : "",
                 of.fit.contact.restitution,
                 of.results.fitted_here
                     ? fmt::format(" ({:g} to {:g})", of.fit.low.restitution, of.fit.high.restitution)
                     : "",
                 study::k_published.friction, study::k_published.restitution, -1e3 * of.fit.offset))) +
         html_section(
             "What this does not show",
             html_paragraph("A cube of 105 mm on one board. What a measured first row is wrong by is in the "
                            "errors. Nothing is said of slender bodies, nor of bodies that bend."));
}

std::optional<Comparison> compare_tosses(const ValidationOptions& options, const std::string& stem) {
  const auto all = std::make_shared<Tosses>();
  all->tosses = study::read_tosses(options.data);
  const bool here = options.fit.empty();
  if (here)
    all->fit.offset = study::offset_of(all->tosses);
  else
    all->fit = study::toss_fit_from_json(study::unpacked(options.fit), options.fit);
  const std::vector<study::CubeContact> contacts =
      here ? study::contact_grid() : std::vector<study::CubeContact>{all->fit.contact, study::k_published};
  ordered_json settings{
      {"validate", "tosses"}, {"tosses", study::fingerprint(all->tosses)}, {"offset", all->fit.offset}};
  for (const study::CubeContact& one : contacts)
    settings["contacts"].push_back({one.friction, one.restitution});
  const auto rows = run_cases(options, "tosses", stem, settings, static_cast<int>(contacts.size()), [&] {
    return [&](int k, const std::function<bool()>& give_up) {
      return study::run_toss_case(all->tosses, contacts[static_cast<std::size_t>(k)], all->fit.offset,
                                  give_up);
    };
  });
  if (!rows) return std::nullopt;
  std::vector<study::TossOutcomes> outcomes;
  for (const std::string& row : *rows) outcomes.push_back(study::outcomes_in(row));
  const auto is_published = [](const study::CubeContact& one) {
    return one.friction == study::k_published.friction && one.restitution == study::k_published.restitution;
  };
  const auto published = std::ranges::find_if(contacts.rbegin(), contacts.rend(), is_published);
  all->results.published = outcomes[static_cast<std::size_t>(contacts.rend() - published) - 1];
  if (here) all->fit = study::fit_tosses(outcomes, all->fit.offset);
  all->results.fitted = here ? study::cross_validated(outcomes) : outcomes.front();
  all->results.fitted_here = here;
  all->results.of_fitted = study::scored_tosses(all->results.fitted);
  all->results.of_published = study::scored_tosses(all->results.published);
  return Comparison{.title = "A tossed cube",
                    .entries = study::tosses_json(all->fit, all->results),
                    .rows = study::toss_rows(all->tosses, all->results),
                    .chart =
                        [all](const std::string& origin, study::ChartFormat format) {
                          return study::toss_chart(all->fit, all->results, origin, format);
                        },
                    .page = page_of(*all),
                    .text = in_words(*all),
                    .fit = here ? std::optional(study::fit_as_json(all->fit)) : std::nullopt};
}

}  // namespace

const Validation k_tosses_validation = {
    .name = "tosses",
    .about = "where and how a tossed cube comes to rest",
    .source =
        "S. Pfrommer, M. Halm, M. Posa, ContactNets, CoRL 2020, github.com/DAIRLab/contact-nets "
        "(BSD-3-Clause, "
        "copyright (c) 2020, Dynamic Autonomy and Intelligent Robotics Lab)",
    .needs_data = true,
    .takes_fit = true,
    .compare = compare_tosses};

}  // namespace topple::app
