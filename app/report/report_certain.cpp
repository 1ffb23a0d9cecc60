// Section of the report page: how certain the outcome is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/report_parts.h"
#include "solver/frame/integrator.h"
#include "solver/study/common/refinement.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

/// One of a table of how often something came about in the trials that finished.
struct Counted {
  std::string name;
  int runs;
};

std::string share_table(const ReportPage& page, const Phrase& what, const Phrase& came_about,
                        const std::vector<Counted>& list, int runs) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, hits] : list) {
    const study::Interval interval = study::wilson(hits, runs);
    rows.push_back(
        {escaped(name), page.say(words::k_runs, hits, runs), shown(100. * hits / runs, 0) + " %",
         fmt::format("{}\u2013{} %", shown(100 * interval.low, 0), shown(100 * interval.high, 0))});
  }
  return rows.empty() ? ""
                      : page.table({page.say(what), page.say(came_about), page.say(words::k_share),
                                    page.say(words::k_interval)},
                                   rows);
}

/// In how many of the trials that finished.
template <class F>
int count_trials(const ReportPage& page, F holds) {
  return static_cast<int>(std::ranges::count_if(
      page.report().trials, [&](const study::Trial& trial) { return trial.finished && holds(trial); }));
}

/// How often the way from each place stays open; empty: there are no places.
std::string ways_table(const ReportPage& page, int runs) {
  const Room& room = page.report().scene->setup.room;
  std::vector<Counted> list;
  for (std::size_t p = 0; room.ways() > 0 && p < room.places.size(); ++p)
    list.push_back(
        {room.places[p].name, count_trials(page, [p](const study::Trial& trial) { return trial.open[p]; })});
  return share_table(page, words::k_place, words::k_open_in, list, runs);
}

/// How often each anchor that may break does; empty: there is none.
std::string anchors_table(const ReportPage& page, int runs) {
  const Setup& setup = page.report().scene->setup;
  const std::vector<Anchor>& anchors = setup.model.anchors;
  const std::vector<bool>& in_place = setup.parameters.anchors;
  std::vector<Counted> list;
  for (std::size_t k = 0; k < anchors.size(); ++k)
    if ((in_place.empty() || in_place[k]) && std::isfinite(anchors[k].strength))
      list.push_back(
          {anchors[k].name, count_trials(page, [k](const study::Trial& trial) { return trial.broke[k]; })});
  return share_table(page, words::k_anchor_name, words::k_broke_in, list, runs);
}

std::string probability(ReportPage& page) {
  const Report& report = page.report();
  const auto failed = std::ranges::count_if(report.trials, [](const study::Trial& t) { return !t.finished; });
  const int runs = static_cast<int>(report.trials.size()) - static_cast<int>(failed);
  std::string out = "<h3>" + page.say(words::k_probability, short_shown(100 * report.spread)) + "</h3>\n";
  out += page.paragraph(page.say(words::k_probability_text, report.trials.size(), shown(1 - report.spread, 2),
                                 shown(1 + report.spread, 2)));
  std::string factors;
  for (const study::Trial& trial : report.trials)
    if (!trial.finished) factors += (factors.empty() ? "" : ", ") + shown(trial.factor, 3);
  if (failed > 0)
    out += page.paragraph(page.say(words::k_runs_failed, failed, report.trials.size(), factors));
  if (runs == 0) return out;
  std::vector<Counted> list;
  DotChart chart;
  chart.x_label = page.text(words::k_factor);
  chart.x_from = 1 - report.spread, chart.x_to = 1 + report.spread;
  for (std::size_t b = 0; b < page.bodies().size(); ++b) {
    DotChart::Row row{.name = page.name(b), .x = {}, .filled = {}};
    int hits = 0;
    for (const study::Trial& trial : report.trials) {
      if (!trial.finished) continue;
      hits += trial.overturned[b];
      row.x.push_back(trial.factor);
      row.filled.push_back(trial.overturned[b]);
    }
    list.push_back({page.name(b), hits});
    chart.rows.push_back(std::move(row));
  }
  out += share_table(page, words::k_body, words::k_overturned_in, list, runs);
  out += page.figure(svg_dots(chart), page.say(words::k_dots, page.next_figure()));
  return out + ways_table(page, runs) + anchors_table(page, runs) +
         page.paragraph(page.say(words::k_interval_note), "note");
}

std::string disagreements(const ReportPage& page, const ordered_json& estimate) {
  std::string out;
  for (const ordered_json& e : estimate["bodies"]) {
    if (e["same_course"].get<bool>()) continue;
    const std::string name = e["name"].get<std::string>();
    const auto body =
        std::ranges::find_if(page.bodies(), [&](const ordered_json& b) { return b["name"] == name; });
    if (!out.empty()) out += "; ";
    const bool fell = (*body)["overturned"].get<bool>();
    out += !fell ? page.text(words::k_open_stays, name)
                 : page.text(e.value("falls_refined", false) ? words::k_open_impacts : words::k_open_falls,
                             name, shown((*body)["overturn_time_s"].get<double>(), 3));
  }
  return out;
}

std::string error(const ReportPage& page) {
  const ordered_json& estimate = page.report().summary["error_estimate"];
  const Parameters& p = page.report().scene->setup.parameters;
  std::string out = "<h3>" + page.say(words::k_error) + "</h3>\n";
  const std::string how =
      study::is_by_tolerance(p)
          ? page.text(words::k_tightened,
                      short_shown(study::compared(page.report().scene->setup).parameters.tolerance))
          : page.text(words::k_halved, short_shown(1e3 * page.report().summary["time_step_s"].get<double>() /
                                                   study::k_finer_step));
  out += page.paragraph(
      page.say(words::k_error_text, how, page.falling_section(), short_shown(study::k_error_of_difference)));
  if (estimate.contains("failed"))
    out += page.paragraph(page.say(words::k_error_failed, estimate["failed"].get<std::string>()));
  else if (!estimate["disagreements"].empty())
    out += page.paragraph(page.say(words::k_error_open, disagreements(page, estimate)), "notice");
  for (const ordered_json& body : estimate.value("parted", ordered_json::array()))
    out += page.paragraph(page.say(words::k_error_parted, body.get<std::string>()), "notice");
  if (const ordered_json& balance = page.report().summary["energy"]["balance_error"]; !balance.is_null())
    out += page.paragraph(page.say(words::k_balance, short_shown(100 * balance.get<double>(), 2)));
  return out +
         page.list(words::k_warnings, page.report().summary["warnings"].get<std::vector<std::string>>());
}

}  // namespace

std::string certain_section(ReportPage& page) {
  return page.section(
      words::k_certain,
      (page.report().trials.empty() ? page.paragraph(page.say(words::k_no_probability)) : probability(page)) +
          fragility_part(page) + error(page));
}

}  // namespace topple::app
