#include "solver/study/overturn/fragility_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/study/common/map_panel.h"

namespace topple::study {
namespace {

constexpr int k_sheet_width = 1240;
constexpr int k_head = 176, k_criteria = 84, k_plot = 430, k_foot = 84;  // px, heights
constexpr int k_from_left = 92, k_from_right = 26;                       // px, around a panel
constexpr double k_lines = 22;                                           // px, pitch
constexpr double k_key = 44;                                             // px, beside words

struct StateLook {
  const char *colour, *point;
};
constexpr std::array<StateLook, k_states> k_looks_of_states{
    {{"#0072b2", "pt 7"}, {"#d98a00", "pt 9"}, {"#a3203a", "pt 5"}}};

/// As many decimals as the interval has sense for.
std::string between(const Interval& interval) {
  return fmt::format("{:.4g} to {:.4g}", interval.low, interval.high);
}

/// Curves over the measure, as many as there are looks at most.
struct Panel {
  std::string title;
  struct Curve {
    std::string word;
    const FragilityCurve* of;
  };
  std::vector<Curve> curves;
  std::optional<std::size_t> criteria = std::nullopt;  ///< of this body
  bool keyed = false;                                  ///< the words above have the colours of their curves
};

int hits(const FragilityCurve& curve) {
  int sum = 0;
  for (const Level& level : curve.levels) sum += level.hits;
  return sum;
}

class FragilityChart {
 public:
  FragilityChart(const FragilityPlan& plan, const FragilityResults& results)
      : plan_(plan), results_(results), shown_(bodies_shown()) {
    for (const std::size_t b : shown_) {
      Panel& of = panels_.emplace_back(Panel{results.bodies[b], {}, b});
      for (std::size_t s = 0; s < k_states; ++s)
        of.curves.push_back({damage_states()[s].title, &results.curves[b][s]});
    }
    if (!results.closed.empty()) panels_.push_back(ways());
    columns_ = panels_.size() > 1 ? 2 : 1;
    std::size_t most = 0;
    for (const Panel& of : panels_) {
      std::size_t lines = 0;
      for (const Panel::Curve& curve : of.curves) lines += words(of, curve).size();
      most = std::max(most, lines);
    }
    panel_head_ = k_criteria + static_cast<int>(k_lines) * static_cast<int>(most);
    const int rows = (static_cast<int>(panels_.size()) + columns_ - 1) / columns_;
    sheet_ = {k_sheet_width, k_head + rows * (panel_head_ + k_plot + k_foot)};
  }

  std::string script(const std::string& origin, ChartFormat format) const {
    std::string out = header(origin);
    for (std::size_t k = 0; k < panels_.size(); ++k) out += panel(k);
    return sheet_.script(format, out);
  }

 private:
  /// Of the places from which the way is closed most often.
  Panel ways() const {
    const std::vector<FragilityCurve>& closed = results_.closed;
    std::vector<std::size_t> order(closed.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t p) { return hits(closed[p]); });
    order.resize(std::min(order.size(), k_looks_of_states.size()));
    std::ranges::sort(order);
    Panel out{fmt::format("No way out{}", order.size() < closed.size()
                                              ? fmt::format(", {} of {} places", order.size(), closed.size())
                                              : ""),
              {},
              std::nullopt,
              true};
    for (const std::size_t p : order)
      out.curves.push_back({"from " + plan_.scene.setup.room.places[p].name, &closed[p]});
    return out;
  }

  std::vector<std::size_t> bodies_shown() const {
    std::vector<std::size_t> order(results_.bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (order.size() <= k_panels) return order;
    std::ranges::stable_sort(order, std::greater<>(),
                             [&](std::size_t b) { return hits(results_.curves[b].back()); });
    order.resize(k_panels);
    std::ranges::sort(order);
    if (order.back() + 1 != results_.bodies.size()) order.back() = results_.bodies.size() - 1;
    return order;
  }

  std::string header(const std::string& origin) const {
    const int top = sheet_.height;
    const std::string varied = plan_.factors.texts.empty() ? "nothing" : plan_.factors.in_words();
    std::string out = sheet_.label(bold(plain("How likely bodies overturn in " + plan_.scene.name), 1.5),
                                   k_from_left, top - 34) +
                      sheet_.lines({plan_.scene.title,
                                    fmt::format("{:g} s simulated. Varied from run to run: {}",
                                                plan_.scene.setup.run.duration, varied),
                                    origin + ", " + coverage()},
                                   k_from_left, top - 74, 24, k_grey_as_is);
    double x = k_from_left;
    for (std::size_t s = 0; s < k_states; ++s) {
      const std::string words = damage_states()[s].title +
                                std::string(s == 1 ? fmt::format(" over {:g} mm", 1e3 * plan_.slide) : "");
      out += sample(s, x, top - 152) + sheet_.label(words, x + 44, top - 152);
      x += 84 + 9.2 * static_cast<double>(words.size());
    }
    return out + sheet_.label("bars: 95 % of the share (Wilson)", x, top - 152, k_grey);
  }

  std::string coverage() const {
    std::string out = results_.runs == results_.of ? fmt::format("{} runs", results_.of)
                                                   : fmt::format("{} of {} runs", results_.runs, results_.of);
    if (results_.planar < results_.runs) out += ", as rigid bodies";
    if (shown_.size() < results_.bodies.size())
      out += fmt::format("; {} of {} shown", shown_.size(), results_.bodies.size());
    return out;
  }

  /// Lines about a curve above its panel.
  std::vector<std::string> words(const Panel& of, const Panel::Curve& drawn) const {
    const FragilityCurve& curve = *drawn.of;
    const double room = static_cast<double>(k_sheet_width) / columns_ - k_from_left - k_from_right;
    const double width = room - (of.keyed ? k_key : 0);
    if (!curve.fit.fit) return wrapped(drawn.word + ": no curve, " + curve.fit.why_not, width);
    const std::string unit = plan_.levels.unit.empty() ? "" : " " + plan_.levels.unit;
    const Interval median = curve.median_of_records.value_or(curve.median_of_runs),
                   beta = curve.beta_of_records.value_or(curve.beta_of_runs);
    return wrapped(fmt::format("{}: median {:.4g}{} ({}), β {:.3g} ({:.2g} to {:.2g}){}", drawn.word,
                               curve.median, unit, between(median), curve.fit.fit->beta, beta.low, beta.high,
                               curve.scatter > 1 ? "; a poor fit" : ""),
                   width);
  }

  std::string sample(std::size_t look, double x, double y) const {
    const StateLook& as = k_looks_of_states[look];
    return sheet_.stroke(x, x + 34, y, fmt::format("lc rgb '{}' lw 3", as.colour)) +
           sheet_.label("", x + 17, y, fmt::format("point {} ps 1.1 lc rgb '{}'", as.point, as.colour));
  }

  std::string panel(std::size_t k) const {
    const Panel& of = panels_[k];
    const double width = static_cast<double>(k_sheet_width) / columns_;
    const double left = width * static_cast<double>(k % static_cast<std::size_t>(columns_)) + k_from_left,
                 right = left - k_from_left + width - k_from_right;
    const double top =
        sheet_.height - k_head -
        static_cast<double>(k / static_cast<std::size_t>(columns_)) * (panel_head_ + k_plot + k_foot);
    const double plot_top = top - panel_head_, bottom = plot_top - k_plot;
    std::string out = sheet_.label(bold(plain(of.title), 1.15), left, top - 12);
    double y = top - 38;
    for (std::size_t s = 0; s < of.curves.size(); ++s) {
      const std::vector<std::string> lines = words(of, of.curves[s]);
      if (of.keyed) out += sample(s, left, y);  // the sheet's key does not name it
      out += sheet_.lines(lines, left + (of.keyed ? k_key : 0), y, k_lines, k_grey_as_is);
      y -= k_lines * static_cast<double>(lines.size());
    }
    out +=
        sheet_.place(left, right, bottom, plot_top) + axis_scale("x", plan_.levels) +
        axis_label("x", measure_axis(), "0,0.2") +
        "unset logscale y\nset yrange [-0.02:1.02]\nset ytics 0.2 nomirror\nset ylabel 'probability' offset "
        "1.2,0\nset border 3 lc rgb '#444444' lw 1\nset grid ytics lc rgb '#dddddd' lw 0.8\n";
    Plot plot;
    if (of.criteria) out += criteria(*of.criteria, left, right, plot_top, plot);
    for (std::size_t s = 0; s < of.curves.size(); ++s) add_curve(*of.curves[s].of, s, plot);
    return out + plot.data + plot.command() + "unset label\nunset arrow\nunset object\n";
  }

  Axis measure_axis() const {
    Axis axis = plan_.levels;
    axis.key = plan_.measure->title;
    return axis;
  }

  /// In lines of a width, px, those behind the first indented.
  static std::vector<std::string> wrapped(std::string rest, double width) {
    const auto most = static_cast<std::size_t>(width / 9.2);
    std::vector<std::string> lines;
    while (rest.size() > most) {
      const std::size_t end = rest.rfind(' ', most);
      if (end == std::string::npos || rest.find_first_not_of(' ') > end) break;
      lines.push_back(rest.substr(0, end));
      rest = "    " + rest.substr(end + 1);
    }
    lines.push_back(rest);
    return lines;
  }

  /// Lines across, with their names above the panel where they do not meet.
  std::string criteria(std::size_t b, double left, double right, double top, Plot& plot) const {
    if (b >= results_.criteria.size() || !results_.criteria[b].why_not.empty()) return "";
    const BodyCriteria& c = results_.criteria[b];
    struct Line {
      const char *name, *dash;
      double at;
    };
    std::vector<Line> lines{
        {"West", "1", c.west}, {"Ishiyama", "(14,6)", c.ishiyama}, {"A_{R50}", "(4,4)", c.evaluation}};
    std::ranges::sort(lines, {}, &Line::at);
    const std::vector<double> ends = plan_.levels.edges();
    const auto place = [&](double value) {
      const double part = plan_.levels.logarithmic
                              ? std::log(value / ends.front()) / std::log(ends.back() / ends.front())
                              : (value - ends.front()) / (ends.back() - ends.front());
      return left + part * (right - left);
    };
    std::string out;
    double free = left - 60;
    int row = 0;
    for (const Line& line : lines) {
      if (!(line.at > ends.front() && line.at < ends.back())) continue;
      const std::string block = fmt::format("criterion{}", plot.layers.size());
      plot.add(block, point_row(line.at, -0.02) + point_row(line.at, 1.02),
               fmt::format("with lines lc rgb '#444444' lw 1.8 dt {} notitle", line.dash));
      const double x = place(line.at);
      row = x < free ? row + 1 : 0;
      out += sheet_.label(line.name, x, top + 12 + 18 * row, "center textcolor rgb '#444444'");
      free = x + 78;
    }
    return out;
  }

  void add_curve(const FragilityCurve& curve, std::size_t s, Plot& plot) const {
    const StateLook& look = k_looks_of_states[s];
    if (curve.fit.fit) {
      const std::vector<double> ends = plan_.levels.edges();
      std::string rows;
      for (int n = 0; n <= 200; ++n) {
        const double part = n / 200.;
        const double at = plan_.levels.logarithmic ? ends.front() * std::pow(ends.back() / ends.front(), part)
                                                   : std::lerp(ends.front(), ends.back(), part);
        rows += point_row(at, curve.probability(plan_, at));
      }
      plot.add(fmt::format("fit{}", s), rows,
               fmt::format("with lines lc rgb '{}' lw 3 notitle", look.colour));
    }
    std::string shares;
    for (const Level& level : curve.levels) {
      if (level.runs == 0) continue;
      const Interval bounds = wilson(level.hits, level.runs);
      shares += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", level.intensity,
                            static_cast<double>(level.hits) / level.runs, bounds.low, bounds.high);
    }
    plot.data += data_block(fmt::format("shares{}", s), shares, 4);
    plot.layers.push_back(fmt::format("$shares{} with yerrorbars {} ps 1 lw 1.6 lc rgb '{}' notitle", s,
                                      look.point, look.colour));
  }

  const FragilityPlan& plan_;
  const FragilityResults& results_;
  const std::vector<std::size_t> shown_;
  std::vector<Panel> panels_;
  int columns_ = 1;
  int panel_head_ = 0;  // px
  Sheet sheet_{};
};

}  // namespace

std::string fragility_chart(const FragilityPlan& plan, const FragilityResults& results,
                            const std::string& origin, ChartFormat format) {
  return FragilityChart(plan, results).script(origin, format);
}

}  // namespace topple::study
