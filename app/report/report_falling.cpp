// Sections of the report page: what falls and when, and what anchors change.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/report/report_parts.h"
#include "app/support/base64.h"
#include "app/support/force_error.h"
#include "app/support/terms.h"
#include "solver/run/overturn.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t k_names = 3;    // bodies; more have the numbers of the chart in pictures
constexpr std::size_t k_curves = 8;   // more cannot be told apart
constexpr double k_far_below = 0.15;  // of the critical angle: tilts below it would be flat beside it
constexpr double k_same_angle = 0.5;  // degrees

std::string verdict(const ReportPage& page, const ordered_json& body) {
  const Phrase& said = body["overturned"].get<bool>()              ? words::k_overturns
                       : body["first_beyond_critical_s"].is_null() ? words::k_stays
                                                                   : words::k_comes_back;
  return "<span class=\"verdict-cell\">" + page.say(said) + "</span>";
}

/// The errors of body `b`, or nothing that says anything.
ordered_json errors_of(const ReportPage& page, std::size_t b) {
  const ordered_json& e = page.report().summary["error_estimate"];
  if (e.contains("bodies")) return e["bodies"][b];
  return {{"overturn_time_s", nullptr},
          {"peak_tilt_deg", nullptr},
          {"peak_slide_m", nullptr},
          {"peak_stress_Pa", nullptr}};
}

std::string outcome_table(const ReportPage& page) {
  const bool stresses = std::ranges::any_of(
      page.bodies(), [](const ordered_json& b) { return !b["peak_stress_Pa"].is_null(); });
  std::vector<std::string> head{page.say(words::k_body),          page.say(words::k_verdict),
                                page.say(words::k_overturn_time), page.say(words::k_uplift),
                                page.say(words::k_impacts),       page.say(words::k_tilt),
                                page.say(words::k_critical),      page.say(words::k_slide)};
  if (stresses) head.push_back(page.say(words::k_stress));
  std::vector<std::vector<std::string>> rows;
  for (std::size_t b = 0; b < page.bodies().size(); ++b) {
    const ordered_json &body = page.bodies()[b], e = errors_of(page, b);
    const std::optional<double>& critical = page.report().tilts[b].critical;
    rows.push_back(
        {escaped(page.name(b)), verdict(page, body),
         with_error(body["overturn_time_s"], e["overturn_time_s"], 1, 3),
         body["first_uplift_s"].is_null() ? "\u2013" : shown(body["first_uplift_s"].get<double>(), 2),
         std::to_string(body["impacts"].get<int>()),
         with_error(body["peak_tilt_deg"], e["peak_tilt_deg"], 1, 2),
         critical ? shown(*critical, 2) : "\u2013",
         with_error(body["peak_slide_m"], e["peak_slide_m"], 1e-3, 1)});
    if (stresses) rows.back().push_back(with_error(body["peak_stress_Pa"], e["peak_stress_Pa"], 1e6, 1));
  }
  const bool flows = stresses && std::ranges::any_of(page.bodies(), [](const ordered_json& b) {
                       return b["hinges"].get<int>() > 0;
                     });
  const std::vector<Material>& materials = page.report().scene->setup.model.materials;
  const bool yields = std::ranges::any_of(materials, [](const Material& m) { return m.yield > 0; });
  return page.table(head, rows) +
         page.paragraph(page.say(words::k_table_note, short_shown(100 * k_uplift),
                                 short_shown(k_uplift_angle * k_degrees), page.certain_section()),
                        "note") +
         (stresses && !yields ? page.paragraph(page.say(words::k_stress_note), "note") : "") +
         (flows ? page.paragraph(page.say(words::k_flow_note), "note") : "");
}

/// The bodies that tilt most, at most k_curves, in their order.
std::vector<std::size_t> drawn(const ReportPage& page) {
  std::vector<std::size_t> bodies(page.bodies().size());
  std::iota(bodies.begin(), bodies.end(), 0);
  std::ranges::stable_sort(bodies, std::greater<>(),
                           [&](std::size_t b) { return page.bodies()[b]["peak_tilt_deg"].get<double>(); });
  bodies.resize(std::min(bodies.size(), k_curves));
  std::ranges::sort(bodies);
  return bodies;
}

std::string keys(const ReportPage& page, const std::vector<std::size_t>& bodies) {
  std::string out = "<div class=\"keys\">\n";
  for (std::size_t c = 0; c < bodies.size(); ++c)
    out += fmt::format(
        "<span><svg viewBox=\"0 0 46 16\"><line x1=\"0\" y1=\"8\" x2=\"46\" y2=\"8\" {}/></svg>{} "
        "{}</span>\n",
        svg_stroke(c), c + 1, escaped(page.name(bodies[c])));
  return out + "</div>\n";
}

std::string tilt_figure(ReportPage& page) {
  const Report& report = page.report();
  const std::vector<std::size_t> bodies = drawn(page);
  LineChart chart;
  chart.x_label = page.text(words::k_time);
  chart.y_label = page.text(words::k_tilt_axis);
  chart.height = 250;
  chart.numbered = bodies.size() > 1;
  chart.x_to = report.summary["simulated_s"].get<double>();
  double most = 0;
  std::vector<double> critical;
  for (const std::size_t b : bodies) {
    const TiltCurve& curve = report.tilts[b];
    chart.curves.push_back({page.name(b), curve.time, curve.tilt});
    for (const double tilt : curve.tilt) most = std::max(most, tilt);
    if (curve.critical) critical.push_back(*curve.critical);
    if (const ordered_json& at = page.bodies()[b]["overturn_time_s"]; !at.is_null() && curve.critical)
      chart.marks.push_back({chart.curves.size() - 1, at.get<double>(), *curve.critical});
  }
  chart.y_to = 1.15 * std::max(most, 1e-3);
  if (!critical.empty() && std::ranges::max(critical) - std::ranges::min(critical) < k_same_angle &&
      most > k_far_below * critical.front()) {
    chart.levels = {critical.front()};
    chart.level_label = page.text(words::k_critical_level, shown(critical.front(), 2));
    chart.y_to = 1.15 * std::max(most, critical.front());
  }
  const std::string which =
      bodies.size() < page.bodies().size() ? page.text(words::k_most_tilted_only, bodies.size()) : "";
  return page.figure(svg_chart(chart) + (chart.numbered ? keys(page, bodies) : ""),
                     page.say(chart.marks.empty() ? words::k_tilt_chart_standing : words::k_tilt_chart,
                              page.next_figure(), which));
}

std::string caption(const ReportPage& page, const KeyPicture& picture) {
  const std::string time = shown(picture.time, 2);
  switch (picture.kind) {
    case KeyPicture::Kind::start:
      return page.say(words::k_at_start, time);
    case KeyPicture::Kind::falling:
      return page.say(words::k_at_fall, time, page.name(picture.body), shown(picture.tilt, 0));
    case KeyPicture::Kind::most_tilted:
      return page.say(words::k_at_most, time, page.name(picture.body), shown(picture.tilt, 2));
    case KeyPicture::Kind::end:
      break;
  }
  return page.say(words::k_at_end, time);
}

std::string pictures(ReportPage& page) {
  std::string out = "<div class=\"pictures\">\n";
  for (const KeyPicture& picture : page.report().pictures) {
    std::string labels;
    for (const KeyPicture::Label& label : picture.labels)
      labels += fmt::format(
          "<span style=\"left:{:.1f}%;top:{:.1f}%\">{}</span>", label.left, label.top,
          page.bodies().size() > k_names ? std::to_string(label.body + 1) : escaped(page.name(label.body)));
    out += fmt::format(
        "<figure><div class=\"picture\"><img alt=\"{0}\" src=\"data:image/png;base64,{1}\">{2}</div>"
        "<figcaption>{0}</figcaption></figure>\n",
        caption(page, picture), base64(picture.png), labels);
  }
  return page.figure(out + "</div>\n", page.say(words::k_pictures, page.next_figure()));
}

}  // namespace

std::string falling_section(ReportPage& page) {
  std::string out = outcome_table(page);
  if (!page.bodies().empty()) out += tilt_figure(page);
  if (!page.report().pictures.empty()) out += pictures(page);
  return page.section(words::k_falling, out);
}

namespace {

/// A row for each anchor.
std::string holding_table(ReportPage& page) {
  std::vector<std::vector<std::string>> rows;
  bool assumed = false;
  const ordered_json& anchors = page.report().summary["anchors"];
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    const ordered_json &a = anchors[k], error = force_error(page.report().summary, k);
    const bool fixing = !a["fixing"].is_null(), bounded = !a["strength_N"].is_null();
    assumed = assumed || fixing;
    const double peak = a["peak_force_N"].get<double>();
    const bool never = was_never_in_place(a);
    std::string share = never     ? page.say(words::k_anchor_away)
                        : bounded ? percent_of(peak, a["strength_N"].get<double>())
                                  : "\u2013";
    if (a["broke"].get<bool>())
      share = page.say(words::k_anchor_broke, shown(a["break_time_s"].get<double>(), 2));
    rows.push_back({escaped(a["name"].get<std::string>()), escaped(a["body"].get<std::string>()),
                    !a["leads_to"].is_null()   ? escaped(a["leads_to"].get<std::string>())
                    : a["other_end"].is_null() ? page.say(words::k_anchor_frame)
                                               : escaped(a["other_end"]["body"].get<std::string>()),
                    escaped(a[fixing ? "fixing" : "type"].get<std::string>()),
                    short_shown(a["stiffness_N_m"].get<double>() / 1e3),
                    bounded ? short_shown(a["strength_N"].get<double>()) : "\u2013",
                    never             ? "\u2013"
                    : error.is_null() ? short_shown(peak)
                                      : with_error(peak, error, 1, 1),
                    share});
  }
  for (const ordered_json& w : page.report().summary["wedges"]) {
    assumed = true;
    const bool in_place = !w["nodes"].empty();
    rows.push_back(
        {escaped(w["name"].get<std::string>()), escaped(w["body"].get<std::string>()),
         in_place ? page.say(words::k_lifted_by, short_shown(1e3 * w["lift_m"].get<double>())) : "\u2013",
         "stopper", "\u2013", "\u2013", "\u2013", in_place ? "\u2013" : page.say(words::k_anchor_away)});
  }
  std::vector<std::string> head;
  for (const Phrase* what :
       {&words::k_anchor_name, &words::k_anchor_of, &words::k_anchor_to, &words::k_anchor_kind,
        &words::k_anchor_stiffness, &words::k_anchor_strength, &words::k_anchor_peak, &words::k_anchor_share})
    head.push_back(page.say(*what));
  return page.table(head, rows) + (assumed ? page.paragraph(page.say(words::k_assumed_fixings), "note") : "");
}

/// Bodies that nothing holds, and that fare differently without what holds the others.
std::string differ_unheld(const ReportPage& page, const ordered_json& without) {
  const Setup& setup = page.report().scene->setup;
  std::string names;
  for (std::size_t b = 0; b < page.bodies().size(); ++b) {
    const int body = static_cast<int>(b);
    const auto lifts = [&](const Wedge& wedge) { return wedge.body == body && wedge.in_place(); };
    if (page.bodies()[b]["overturned"] == without["bodies"][b]["overturned"] ||
        is_held(setup.model, setup.parameters, body) || std::ranges::any_of(setup.wedges, lifts))
      continue;
    names += (names.empty() ? "" : ", ") + page.name(b);
  }
  return names;
}

/// What the run with anchors is not warned of as well.
std::vector<std::string> warned_without(const ReportPage& page, const ordered_json& without) {
  const auto with = page.report().summary["warnings"].get<std::vector<std::string>>();
  auto warnings = without["warnings"].get<std::vector<std::string>>();
  std::erase_if(warnings, [&](const std::string& one) { return std::ranges::find(with, one) != with.end(); });
  return warnings;
}

}  // namespace

std::string anchors_section(ReportPage& page) {
  std::string out = holding_table(page);
  if (!page.report().without_anchors) return page.section(words::k_anchors_away, out);
  const ordered_json& without = *page.report().without_anchors;
  out += page.paragraph(page.say(words::k_anchors_text));
  if (without["status"] == "diverged")
    return page.section(
        words::k_anchors,
        out + page.paragraph(page.say(words::k_without_failed, without["message"].get<std::string>())));
  std::vector<std::vector<std::string>> rows;
  const auto time = [](const ordered_json& body) {
    return with_error(body["overturn_time_s"], nullptr, 1, 2);
  };
  for (std::size_t b = 0; b < page.bodies().size(); ++b) {
    const ordered_json &with = page.bodies()[b], &bare = without["bodies"][b];
    rows.push_back({escaped(page.name(b)), verdict(page, with), verdict(page, bare), time(with), time(bare),
                    with_error(with["peak_tilt_deg"], nullptr, 1, 2),
                    with_error(bare["peak_tilt_deg"], nullptr, 1, 2),
                    with_error(with["peak_slide_m"], nullptr, 1e-3, 1),
                    with_error(bare["peak_slide_m"], nullptr, 1e-3, 1)});
  }
  const auto pair = [&](const Phrase& what) {
    return std::vector<std::string>{page.say(what) + ", " + page.say(words::k_with),
                                    page.say(what) + ", " + page.say(words::k_without)};
  };
  std::vector<std::string> head{page.say(words::k_body)};
  for (const Phrase* what : {&words::k_verdict, &words::k_overturn_time, &words::k_tilt, &words::k_slide})
    for (const std::string& cell : pair(*what)) head.push_back(cell);
  out += page.table(head, rows);
  if (page.shows_ways()) {
    std::vector<std::vector<std::string>> ways;
    for (std::size_t p = 0; p < without["ways"].size(); ++p) {
      const ordered_json &with = page.report().summary["ways"][p], &bare = without["ways"][p];
      ways.push_back(
          {escaped(with["place"].get<std::string>()), way_in_words(page, with), way_in_words(page, bare)});
    }
    const std::vector<std::string> way = pair(words::k_way);
    out += page.table({page.say(words::k_place), way[0], way[1]}, ways);
  }
  if (const std::string names = differ_unheld(page, without); !names.empty())
    out += page.paragraph(page.say(words::k_unheld_differ, names), "note");
  out += page.list(words::k_warnings_without, warned_without(page, without));
  return page.section(words::k_anchors, out);
}

}  // namespace topple::app
