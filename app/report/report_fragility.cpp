// Part of the report page: how likely bodies lift, slide and overturn over the floor's peak acceleration.
#include <fmt/format.h>

#include <algorithm>

#include "app/report/report_parts.h"

namespace topple::app {
namespace {

const Phrase& name_of_state(std::size_t state) {
  static constexpr const Phrase* k_states_named[] = {&words::k_state_uplift, &words::k_state_slide,
                                                     &words::k_state_overturn};
  return *k_states_named[state];
}

std::string interval(const study::Interval& of) {
  return fmt::format("{}\u2013{}", short_shown(of.low, 3), short_shown(of.high, 3));
}

std::string medians(const ReportPage& page, const study::FragilityResults& found) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t b = 0; b < found.bodies.size(); ++b)
    for (std::size_t s = 0; s < study::k_states; ++s) {
      const study::FragilityCurve& curve = found.curves[b][s];
      const std::string name = b < page.bodies().size() ? found.bodies[b] : page.text(words::k_any_body);
      std::vector<std::string> row{escaped(s == 0 ? name : ""), page.say(name_of_state(s))};
      if (curve.fit.fit) {
        row.push_back(short_shown(curve.median, 3));
        row.push_back(interval(curve.median_of_runs));
        row.push_back(shown(curve.fit.fit->beta, 2));
      } else {
        const std::optional<study::Interval> step = curve.step();
        const bool never =
            std::ranges::all_of(curve.levels, [](const study::Level& level) { return level.hits == 0; });
        const bool steady = std::ranges::is_sorted(curve.levels, {}, [](const study::Level& level) {
          return static_cast<double>(level.hits) / std::max(level.runs, 1);
        });
        row.push_back(page.say(never    ? words::k_in_no_run
                               : !step  ? words::k_no_curve
                               : steady ? words::k_jumps
                                        : words::k_rises_and_falls));
        row.push_back(step ? interval(*step) : "\u2013");
        row.emplace_back("\u2013");
      }
      rows.push_back(std::move(row));
    }
  return page.table({page.say(words::k_body), page.say(words::k_state), page.say(words::k_median),
                     page.say(words::k_median_interval), "\u03b2"},
                    rows);
}

std::string criteria(const ReportPage& page, const study::FragilityResults& found) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t b = 0; b < found.criteria.size(); ++b) {
    const study::BodyCriteria& c = found.criteria[b];
    if (!c.why_not.empty()) continue;
    rows.push_back({escaped(found.bodies[b]), short_shown(c.west, 3), short_shown(c.ishiyama, 3),
                    short_shown(c.evaluation, 3), shown(c.corner, 2)});
  }
  if (rows.empty()) return "";
  return page.table({page.say(words::k_body), page.say(words::k_of_west), page.say(words::k_of_ishiyama),
                     page.say(words::k_of_evaluation), page.say(words::k_corner)},
                    rows) +
         page.paragraph(page.say(words::k_criteria_note, short_shown(found.frequency, 3)), "note");
}

std::string figure(ReportPage& page, const study::FragilityPlan& plan, const study::FragilityResults& found) {
  constexpr int k_places = 120;
  LineChart chart;
  chart.x_label = page.text(words::k_peak_acceleration);
  chart.y_label = page.text(words::k_chance);
  chart.height = 250;
  chart.x_from = 0, chart.x_to = plan.levels.values.back();
  chart.y_to = 1;
  const std::array<study::FragilityCurve, study::k_states>& curves = found.curves.back();
  std::string keys;
  for (std::size_t s = 0; s < study::k_states; ++s) {
    if (!curves[s].fit.fit) continue;
    ChartCurve curve{page.text(name_of_state(s)), {}, {}};
    for (int n = 1; n <= k_places; ++n) {
      curve.x.push_back(chart.x_to * n / k_places);
      curve.y.push_back(curves[s].probability(plan, curve.x.back()));
    }
    const std::string number = fmt::format("{} ", chart.curves.size() + 1);
    keys += fmt::format(
        "<span><svg viewBox=\"0 0 46 16\"><line x1=\"0\" y1=\"8\" x2=\"46\" y2=\"8\" {}/></svg>{}{}</span>\n",
        svg_stroke(chart.curves.size()), number, escaped(curve.name));
    chart.curves.push_back(std::move(curve));
  }
  if (chart.curves.empty()) return "";
  chart.numbered = chart.curves.size() > 1;
  const std::string who = found.bodies.size() > 1 ? page.text(words::k_any_body) : found.bodies.front();
  return page.figure(svg_chart(chart) + "<div class=\"keys\">\n" + keys + "</div>\n",
                     page.say(words::k_fragility_figure, page.next_figure(), who));
}

}  // namespace

std::string fragility_part(ReportPage& page) {
  const Report& report = page.report();
  if (!report.fragility_plan) return "";
  const study::FragilityPlan& plan = *report.fragility_plan;
  const study::FragilityResults& found = report.fragility;
  return "<h3>" + page.say(words::k_fragility) + "</h3>\n" +
         page.paragraph(page.say(words::k_fragility_text, found.runs, plan.levels.count(),
                                 short_shown(plan.levels.values.front()),
                                 short_shown(plan.levels.values.back()), plan.factors.in_words(),
                                 short_shown(1e3 * plan.slide))) +
         medians(page, found) + figure(page, plan, found) + criteria(page, found);
}

}  // namespace topple::app
