#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/page_style.h"
#include "app/report/report_parts.h"
#include "app/support/terms.h"
#include "app/support/titles.h"
#include "solver/model/accelerogram.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t k_short = 15;       // rows of a table that stays on one sheet
constexpr std::size_t k_narrow = 4;       // columns that need no full width
constexpr std::size_t k_named_falls = 3;  // in the sentence at the top

std::string tile(const std::string& figure, const std::string& label) {
  return "<div><b>" + figure + "</b><span>" + label + "</span></div>\n";
}

std::vector<std::size_t> fallen(const ReportPage& page) {
  std::vector<std::size_t> found;
  for (std::size_t b = 0; b < page.bodies().size(); ++b)
    if (page.bodies()[b]["overturned"].get<bool>()) found.push_back(b);
  std::ranges::stable_sort(found, {},
                           [&](std::size_t b) { return page.bodies()[b]["overturn_time_s"].get<double>(); });
  return found;
}

std::size_t most_tilted(const ReportPage& page) {
  std::size_t most = 0;
  for (std::size_t b = 1; b < page.bodies().size(); ++b)
    if (page.bodies()[b]["peak_tilt_deg"] > page.bodies()[most]["peak_tilt_deg"]) most = b;
  return most;
}

/// By the share of the angle at which it would overturn; of bodies that have none, by the angle.
std::size_t nearest_to_falling(const ReportPage& page) {
  std::optional<std::size_t> most;
  const auto share = [&](std::size_t b) { return page.bodies()[b]["peak_critical_share"].get<double>(); };
  for (std::size_t b = 0; b < page.bodies().size(); ++b)
    if (page.report().tilts[b].critical && (!most || share(b) > share(*most))) most = b;
  return most.value_or(most_tilted(page));
}

std::string fall_time(const ReportPage& page, std::size_t body) {
  return shown(page.bodies()[body]["overturn_time_s"].get<double>(), 2);
}

/// Of those that fall, in their order, all that do when the first does.
std::string first_of(const ReportPage& page, const std::vector<std::size_t>& falls) {
  std::string out = page.name(falls[0]);
  for (std::size_t k = 1; k < falls.size() && fall_time(page, falls[k]) == fall_time(page, falls[0]); ++k) {
    if (k == k_named_falls) return out + ", …";
    out += ", " + page.name(falls[k]);
  }
  return out;
}

/// Degrees, of what comes nearest to overturning: when it does. Of a body that has no angle of overturning
/// its greatest.
double told_tilt(const ReportPage& page, std::size_t body) {
  const ordered_json& of = page.bodies()[body];
  const std::optional<double>& critical = page.report().tilts[body].critical;
  return critical ? of["peak_critical_share"].get<double>() * *critical : of["peak_tilt_deg"].get<double>();
}

std::string verdict(const ReportPage& page) {
  const std::vector<std::size_t> falls = fallen(page);
  const std::size_t count = page.bodies().size();
  std::string out;
  if (falls.empty()) {
    const std::size_t most = nearest_to_falling(page);
    const ordered_json& body = page.bodies()[most];
    const std::optional<double>& critical = page.report().tilts[most].critical;
    const std::string tilt = shown(told_tilt(page, most), 2);
    if (!critical) return page.say(words::k_nothing_falls_far, page.name(most), tilt);
    const auto share = body["peak_critical_share"].get<double>();
    const Setup& setup = page.report().scene->setup;
    const Phrase& said = share > 1 ? words::k_nothing_stays_over
                         : is_held(setup.model, setup.parameters, static_cast<int>(most))
                             ? words::k_nothing_falls_held
                             : words::k_nothing_falls;
    out = page.say(said, page.name(most), tilt, shown(*critical, 2));
    const ordered_json& e = page.report().summary["error_estimate"];
    const ordered_json tilt_error =
        e.contains("bodies") ? e["bodies"][most]["peak_tilt_deg"] : ordered_json();
    if (!tilt_error.is_null() && share < 1 && tilt_error.get<double>() > (1 - share) * *critical)
      out += " " + page.say(words::k_error_reaches, shown(tilt_error.get<double>(), 1));
    return out;
  }
  if (falls.size() > k_named_falls)
    return page.say(words::k_many_fall, falls.size(), count, first_of(page, falls),
                    fall_time(page, falls[0]));
  for (const std::size_t b : falls) out += page.say(words::k_falls, page.name(b), fall_time(page, b)) + " ";
  if (falls.size() < count) out += page.say(words::k_others_stay, count - falls.size(), count);
  return out;
}

/// The figure that verdict() tells of where nothing falls.
std::string nearest_tile(const ReportPage& page) {
  const std::size_t most = nearest_to_falling(page);
  const Phrase& what = page.report().tilts[most].critical ? words::k_tilt_of_nearest : words::k_greatest_tilt;
  return tile(shown(told_tilt(page, most), 2) + "°", page.say(what) + ": " + escaped(page.name(most)));
}

/// Whether some body overturns in some of the runs about the input only.
bool sensitive(const ReportPage& page) {
  for (std::size_t b = 0; b < page.bodies().size(); ++b) {
    const auto seen = [&](bool fell) {
      return std::ranges::any_of(
          page.report().trials, [&](const study::Trial& t) { return t.finished && t.overturned[b] == fell; });
    };
    if (seen(true) && seen(false)) return true;
  }
  return false;
}

/// As part of an address: what has a meaning there is written as bytes.
std::string address_of(const std::string& file) {
  std::string out = "./";
  for (const char c : file)
    if (const auto byte = static_cast<unsigned char>(c);
        byte <= ' ' || byte == 0x7f || std::string_view("%#?\\").find(c) != std::string_view::npos)
      out += fmt::format("%{:02X}", byte);
    else
      out += c;
  return out;
}

/// Bodies of which a finer run takes another course.
std::string open_ones(const ReportPage& page) {
  const ordered_json& e = page.report().summary["error_estimate"];
  if (!e.contains("bodies")) return "";
  std::string out;
  for (const ordered_json& body : e["bodies"])
    if (!body["same_course"].get<bool>()) out += (out.empty() ? "" : ", ") + body["name"].get<std::string>();
  return out;
}

/// Who is hit, and whose way out is closed or the narrowest.
std::string people(const ReportPage& page) {
  std::string out;
  const ordered_json ways = page.report().summary.value("ways", ordered_json::array());
  for (const ordered_json& way : ways) {
    const auto place = way["place"].get<std::string>();
    for (const ordered_json& hit : way["hit_by"])
      out += page.say(words::k_is_hit, place, hit["body"].get<std::string>(),
                      shown(hit["time_s"].get<double>(), 2)) +
             " ";
    std::string blocked;
    for (const ordered_json& body : way.value("blocked_by", ordered_json::array()))
      blocked += (blocked.empty() ? "" : ", ") + body.get<std::string>();
    if (way["open"] == false && way["before"]["open"] == true)
      out += page.say(way["caught"] == true ? words::k_is_caught : words::k_is_shut_in, place, blocked) + " ";
  }
  const auto width = [](const ordered_json& way) { return way["widest_m"].get<double>(); };
  if (!ways.empty() &&
      std::ranges::all_of(ways, [](const ordered_json& way) { return way["open"] == true; })) {
    const ordered_json& narrowest = *std::ranges::min_element(ways, {}, width);
    out += page.say(words::k_ways_stay, shown(width(narrowest), 2), narrowest["place"].get<std::string>());
  }
  return out;
}

std::string result(const ReportPage& page) {
  const Report& report = page.report();
  const std::vector<std::size_t> falls = fallen(page);
  std::string out = page.paragraph(verdict(page), "verdict");
  if (report.summary["status"] == "stopped")
    out += page.paragraph(page.say(words::k_until, short_shown(report.summary["simulated_s"].get<double>())),
                          "notice");
  if (const std::string told = people(page); !told.empty()) out += page.paragraph(told, "verdict");
  if (!report.page.empty())
    out += page.paragraph("<a href=\"" + escaped(address_of(report.page)) + "\">" +
                          page.say(report.page_is_live ? words::k_live_page : words::k_replay_page) + "</a>");
  std::string broken;
  for (const ordered_json& a : report.summary["anchors"])
    if (a["broke"].get<bool>())
      broken += (broken.empty() ? "" : ", ") + page.text(words::k_one_breaks, a["name"].get<std::string>(),
                                                         shown(a["break_time_s"].get<double>(), 2));
  if (!broken.empty()) out += page.paragraph(page.say(words::k_holding_breaks, broken), "notice");
  if (const std::string open = open_ones(page); !open.empty())
    out += page.paragraph(page.say(words::k_open, page.certain_section(), open), "notice");
  if (sensitive(page)) out += page.paragraph(page.say(words::k_sensitive, page.certain_section()), "notice");
  out += "<div class=\"figures\">\n";
  if (!page.bodies().empty())
    out +=
        tile(page.say(words::k_of, falls.size(), page.bodies().size()), page.say(words::k_figure_overturned));
  if (!falls.empty())
    out += tile(fall_time(page, falls[0]) + " s",
                page.say(words::k_first_fall) + ": " + escaped(first_of(page, falls)));
  else if (!page.bodies().empty())
    out += nearest_tile(page);
  if (!report.scene->setup.parameters.shakes.empty()) {
    out += tile(short_shown(study::peak(report.motion) / k_gal) + " gal", page.say(words::k_peak_floor));
    const double intensity = study::instrumental_intensity(study::intensity_acceleration(report.motion));
    const Phrase& degree =
        words::k_degrees_of_intensity[static_cast<std::size_t>(study::intensity_scale(intensity))];
    out += tile(page.say(words::k_degree_figure, page.text(degree)),
                page.say(words::k_instrumental, shown(intensity, 1)));
  }
  return out + "</div>\n" + page.paragraph(page.say(words::k_not_validated), "notice");
}

}  // namespace

std::string ReportPage::section(const Phrase& title, const std::string& content) {
  return fmt::format("<section>\n<h2>{}. {}</h2>\n{}</section>\n", next_section(), say(title), content);
}

std::string ReportPage::paragraph(const std::string& html, const char* kind) const {
  return (*kind ? fmt::format("<p class=\"{}\">", kind) : "<p>") + html + "</p>\n";
}

std::string ReportPage::list(const Phrase& head, const std::vector<std::string>& sentences) const {
  if (sentences.empty()) return "";
  std::string out = paragraph(say(head)) + "<ul lang=\"en\">\n";
  for (const std::string& sentence : sentences) out += "<li>" + escaped(sentence) + "</li>\n";
  return out + "</ul>\n";
}

std::string ReportPage::figure(const std::string& html, const std::string& caption) const {
  return "<figure>\n" + html + "<figcaption>" + caption + "</figcaption>\n</figure>\n";
}

std::string ReportPage::table(const std::vector<std::string>& head,
                              const std::vector<std::vector<std::string>>& rows, bool numbers) const {
  const bool narrow = head.size() <= k_narrow && numbers;
  std::string out =
      fmt::format("<div class=\"wide{}\"><table class=\"{}{}\">\n", rows.size() <= k_short ? " short" : "",
                  numbers ? "numbers" : "settings", narrow ? " narrow" : "");
  if (!head.empty()) {
    out += "<thead><tr>";
    for (const std::string& cell : head) out += "<th scope=\"col\">" + cell + "</th>";
    out += "</tr></thead>\n";
  }
  out += "<tbody>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      out += c == 0 ? "<th scope=\"row\">" + row[c] + "</th>" : "<td>" + row[c] + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string shown(double value, int decimals) {
  std::string digits = fmt::format("{:.{}f}", value, decimals);
  if (digits[0] == '-')
    digits = (digits.find_first_not_of("-0.") == std::string::npos ? "" : "\u2212") + digits.substr(1);
  return digits;
}

std::string short_shown(double value, int digits) {
  const std::string text = fmt::format("{:.{}g}", value, digits);
  return text[0] == '-' ? "\u2212" + text.substr(1) : text;
}

std::string with_error(const ordered_json& value, const ordered_json& error, double unit, int most) {
  if (value.is_null()) return "\u2013";
  const double x = value.get<double>() / unit;
  if (error.is_null()) return shown(x, most);
  const double e = error.get<double>() / unit;
  const int decimals = e > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(e))), 0, most) : most;
  const double last = std::pow(10, -decimals);
  return shown(x, decimals) + " ± " + shown(std::max(std::ceil(e / last), 1.) * last, decimals);
}

std::string report_page(const Report& report, Language language) {
  ReportPage page(report, language);
  const std::string title =
      escaped(report.scene->title.empty() ? report.scene->name : title_in(language, report.scene->title));
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"generator\" "
      "content=\"topple {}\">\n<link rel=\"icon\" href=\"data:,\">\n<title>{}: "
      "{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      page.language_code(), TOPPLE_VERSION, page.say(words::k_report), title, k_page_style);
  out += fmt::format(
      "<header>\n<p>{}</p>\n<h1>{}</h1>\n<p>{}</p>\n</header>\n<main>\n<section>\n<h2>{}</h2>\n{}</"
      "section>\n",
      page.say(words::k_report), title, page.say(words::k_origin, report.scene->name, TOPPLE_VERSION),
      page.say(words::k_result), result(page));
  out += floor_section(page);
  out += falling_section(page);
  if (page.shows_ways()) out += ways_section(page);
  if (page.shows_anchors()) out += anchors_section(page);
  out += certain_section(page);
  out += assumptions_section(page);
  out += settings_section(page);
  return out + fmt::format("</main>\n<footer>{}</footer>\n</body>\n</html>\n",
                           page.say(words::k_repeat, report.command));
}

}  // namespace topple::app
