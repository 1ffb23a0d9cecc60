// What the sections of the report page are made with.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/report/report.h"
#include "app/report/report_words.h"
#include "app/report/svg_chart.h"

namespace topple::app {

/// The page in the making.
class ReportPage {
 public:
  ReportPage(const Report& report, Language language) : report_(report), language_(language) {}

  const Report& report() const { return report_; }
  const nlohmann::ordered_json& bodies() const { return report_.summary["bodies"]; }
  std::string name(std::size_t body) const { return bodies()[body]["name"].get<std::string>(); }

  /// A phrase in the page's language, as HTML: what it is said of is text, which is escaped.
  template <class... Of>
  std::string say(const Phrase& phrase, const Of&... of) const {
    return escaped(say_in(language_, phrase, of...));
  }
  /// The same not escaped, for charts.
  template <class... Of>
  std::string text(const Phrase& phrase, const Of&... of) const {
    return say_in(language_, phrase, of...);
  }
  std::string language_code() const { return language_ == Language::english ? "en" : "ja"; }

  /// Sections are numbered in the order in which they stand.
  int falling_section() const { return 2; }
  int certain_section() const { return 3 + shows_anchors() + shows_ways(); }
  bool shows_anchors() const {
    return !report_.summary["anchors"].empty() || !report_.summary["wedges"].empty();
  }
  bool shows_ways() const { return report_.summary.contains("ways"); }
  int next_section() { return ++section_; }
  int next_figure() { return ++figure_; }

  /// <section> with its number and name.
  std::string section(const Phrase& title, const std::string& content);
  std::string paragraph(const std::string& html, const char* kind = "") const;
  /// English sentences below a head; nothing where there are none.
  std::string list(const Phrase& head, const std::vector<std::string>& sentences) const;
  std::string figure(const std::string& html, const std::string& caption) const;
  /// Head and rows of cells in HTML; columns beyond the first are numbers, set to the right, when `numbers`.
  std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows,
                    bool numbers = true) const;

 private:
  const Report& report_;
  const Language language_;
  int section_ = 0, figure_ = 0;
};

/// With a true minus sign.
std::string shown(double value, int decimals);
/// To `digits` significant digits, without exponent where it can be read.
std::string short_shown(double value, int digits = 4);
/// "1.0049 ± 0.0002": as many decimals as the error has sense for, `most` at most; the error is rounded up.
/// A dash where there is no value.
std::string with_error(const nlohmann::ordered_json& value, const nlohmann::ordered_json& error, double unit,
                       int most);

/// Of a place, whether one still gets out; a dash where there is no door.
std::string way_in_words(const ReportPage& page, const nlohmann::ordered_json& way);

std::string floor_section(ReportPage& page);
std::string falling_section(ReportPage& page);
std::string ways_section(ReportPage& page);
std::string anchors_section(ReportPage& page);
std::string certain_section(ReportPage& page);
/// Of the certain_section(); empty: there is no fragility.
std::string fragility_part(ReportPage& page);
std::string assumptions_section(ReportPage& page);
std::string settings_section(ReportPage& page);

}  // namespace topple::app
