#include "solver/study/overturn/overturn_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/study/common/gnuplot.h"
#include "solver/study/common/map_panel.h"

namespace topple::study {
namespace {

constexpr int k_height = 1064, k_single = 1240, k_double = 1960;  // px, sheets of one panel and of two
constexpr int k_left = 112, k_bottom = 92, k_top = 300;           // around panels
constexpr int k_map_right = 1070, k_second_left = 1424, k_second_right = 1926;
constexpr int k_margin = 20, k_mark_row = 26;  // px: right of marks; from one row of them to the next

/// How a verdict is drawn: told apart in grey by luminance, and by marks.
struct Look {
  Verdict verdict;
  const char *fill, *mark;  // "": hatched; no mark
  const char* meaning;
};
constexpr Look k_looks[] = {{Verdict::stands, "#edf2f7", "", "stands: no side of a base lifts"},
                            {Verdict::rocks, "#a9cbe4", "pt 7 lc rgb '#2b5c86'", "rocks and stays up"},
                            {Verdict::some, "#f2ab5e", "pt 9 lc rgb '#5a2d00'", "some bodies overturn"},
                            {Verdict::all, "#a3203a", "pt 2 lw 1.6 lc rgb '#ffffff'", "all bodies overturn"},
                            {Verdict::failed, "#f5e663", "pt 1 lw 2 lc rgb '#000000'", "the run failed"}};
constexpr Look k_open = {Verdict::not_computed, "", "", "not computed"};

/// Nodes of viridis (S. van der Walt and N. Smith 2015), whose luminance grows evenly.
constexpr const char* k_viridis =
    "set palette defined (0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', 5 '#28ae80', "
    "6 '#5ec962', 7 '#addc30', 8 '#fde725')\n";

constexpr const char* k_dashes[] = {"1", "(14,6)", "(4,4)"};

/// Sees plan and map, knows its place on the sheet.
class Chart {
 public:
  Chart(const OverturnPlan& plan, const OverturnMap& map)
      : plan_(plan),
        map_(map),
        with_fragility_(plan.ensemble > 1),
        marks_(with_fragility_ ? Rows(1) : rows_of_marks()),
        panel_{{with_fragility_ ? k_double : k_single,
                k_height + k_mark_row * (static_cast<int>(marks_.size()) - 1)},
               k_left,
               k_map_right,
               k_bottom,
               k_height - k_top,
               &plan.x,
               &plan.y} {}

  std::string script(const std::string& origin, ChartFormat format) {
    return panel_.sheet.begin(format) + header(origin) + map_panel() + (with_fragility_ ? fragility() : "") +
           "unset multiplot\n";
  }

 private:
  using Rows = std::vector<std::vector<Look>>;

  const OverturnPoint& point(int i, int j) const {
    return map_.points[static_cast<std::size_t>(j * plan_.x.count() + i)];
  }

  std::string text(const std::string& words, double x, double y, const std::string& how = "") const {
    return panel_.sheet.label(words, x, y, how);
  }

  std::string header(const std::string& origin) const {
    const std::string what = plan_.ensemble > 1 ? "How often a body overturns in " : "What overturns in ";
    const int top = panel_.sheet.height;
    std::string out = text(bold(plain(what + plan_.scene.name), 1.5), k_left, top - 34);
    const std::string grey = std::string("noenhanced ") + k_grey;
    out += text(plan_.scene.title, k_left, top - 74, grey);
    std::string settings = fmt::format("{:g} s simulated", plan_.scene.setup.run.duration);
    for (const std::string& change : plan_.set) settings += ", " + change;
    if (plan_.ensemble > 1)
      settings += fmt::format(". Amplitude of every shake times an even random factor in {:g} to {:g}",
                              1 - plan_.spread, 1 + plan_.spread);
    out += text(settings, k_left, top - 100, grey);
    out += text(origin + ", " + coverage(), k_left, top - 126, grey);
    out += plan_.ensemble > 1 ? marks_of_ensemble() : marks_of_verdicts();
    return out + criteria_in_words();
  }

  std::string coverage() const {
    int least = plan_.ensemble, most = 0;
    for (const OverturnPoint& p : map_.points) {
      least = std::min(least, p.runs + p.failed);
      most = std::max(most, p.runs + p.failed);
    }
    const std::string points = plan_.ensemble == 1 ? "one run a point"
                               : least == most     ? fmt::format("{} runs a point", most)
                                                   : fmt::format("{} to {} runs a point", least, most);
    return map_.run == map_.of ? points : fmt::format("{} of {} runs, {}", map_.run, map_.of, points);
  }

  bool shows(Verdict verdict) const {
    return std::ranges::any_of(map_.points, [=](const OverturnPoint& p) { return p.verdict == verdict; });
  }

  /// px, at most.
  static double width_of(const std::string& words) { return 64 + 9.2 * static_cast<double>(words.size()); }

  /// What the marks of the map mean, in rows that the sheet is wide enough for.
  Rows rows_of_marks() const {
    Rows rows(1);
    double x = k_left;
    const auto add = [&](const Look& look) {
      if (!shows(look.verdict)) return;
      const double width = width_of(look.meaning);
      if (x + width > k_single - k_margin) {
        rows.emplace_back();
        x = k_left;
      }
      rows.back().push_back(look);
      x += width;
    };
    std::ranges::for_each(k_looks, add);
    add(k_open);
    return rows;
  }

  std::string marks_of_verdicts() const {
    std::string out;
    double y = panel_.sheet.height - 160;
    for (const std::vector<Look>& row : marks_) {
      double x = k_left;
      for (const Look& look : row) {
        out += panel_.sheet.swatch(x, y, look.fill, look.mark, look.meaning);
        x += width_of(look.meaning);
      }
      y -= k_mark_row;
    }
    return out;
  }

  std::string marks_of_ensemble() const {
    std::string out;
    double x = k_left;
    const double y = k_height - 160;
    if (shows(Verdict::failed)) {
      out += panel_.sheet.swatch(x, y, k_looks[4].fill, k_looks[4].mark, "every run failed");
      x += width_of("every run failed");
    }
    if (shows(Verdict::not_computed)) {
      out += panel_.sheet.swatch(x, y, k_open.fill, k_open.mark, k_open.meaning);
      x += width_of(k_open.meaning);
    }
    const Sheet& s = panel_.sheet;
    if (has_medians())
      out += fmt::format(
                 "set arrow from screen {0:.5f},{2:.5f} to screen {1:.5f},{2:.5f} nohead lc rgb '#e7298a' lw "
                 "3\n",
                 x / s.width, (x + 34) / s.width, y / s.height) +
             text("", x + 17, y, "point pt 7 ps 0.8 lc rgb '#e7298a'") +
             text("median of the fitted lognormal, where there is one within the map", x + 44, y);
    return out;
  }

  std::string criteria_in_words() const {
    if (!map_.criteria.why_not.empty())
      return text(plain("No criteria are drawn: " + map_.criteria.why_not), k_left, k_height - 190, k_grey);
    std::vector<std::string> lines{fmt::format(
        "Curves: a rigid block like {} alone on the floor, b = {:.0f} mm, h = {:.0f} mm, that does not slip "
        "(friction of the scene: {:g})",
        plain(map_.criteria.bodies), 1e3 * map_.criteria.body.base, 1e3 * map_.criteria.body.height,
        plan_.scene.setup.parameters.contact.friction)};
    for (const Criterion& c : map_.criteria.list) lines.push_back(plain(c.label) + ": " + c.about);
    std::string out;
    for (std::size_t k = 0; k < lines.size(); ++k)
      out += text("{/*0.94 " + lines[k] + "}", k_left, k_height - 186 - 22 * static_cast<double>(k), k_grey);
    return out;
  }

  bool has_medians() const {
    return std::ranges::count_if(map_.fragility, [](const Fragility& f) { return f.fit.has_value(); }) > 0;
  }

  /// Cells of the points for which `wanted` gives a value.
  template <typename Wanted>
  std::string cells(const std::string& block, Wanted wanted) const {
    return panel_.cells(block, [&](int i, int j) { return wanted(point(i, j)); });
  }

  /// Data blocks, and what is plotted of them.
  std::pair<std::string, std::string> verdict_layers() const {
    std::string data, plot;
    for (const Look& look : k_looks) {
      const std::string block = fmt::format("verdict{}", static_cast<int>(look.verdict));
      data += cells(block, [&](const OverturnPoint& p) {
        return p.verdict == look.verdict ? std::optional(0.) : std::nullopt;
      });
      plot += fmt::format("${} using 1:2:3:4:5:6 with boxxyerror fs solid noborder fc rgb '{}' notitle, ",
                          block, look.fill);
      if (*look.mark)
        plot += fmt::format("${} using 1:2 with points {} ps {:.2f} notitle, ", block, look.mark,
                            panel_.mark_size() * (look.verdict == Verdict::rocks ? 0.45 : 0.8));
    }
    return {data, plot};
  }

  std::pair<std::string, std::string> probability_layers() const {
    std::string data = cells("probability", [](const OverturnPoint& p) { return p.probability(); });
    data += cells("failed", [](const OverturnPoint& p) {
      return p.verdict == Verdict::failed ? std::optional(0.) : std::nullopt;
    });
    std::string plot =
        "$probability using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder lc palette notitle, ";
    plot += fmt::format(
        "$failed using 1:2:3:4:5:6 with boxxyerror fs solid noborder fc rgb '{0}' notitle, "
        "$failed using 1:2 with points {1} ps {2:.2f} notitle, ",
        k_looks[4].fill, k_looks[4].mark, panel_.mark_size());
    return {data, plot};
  }

  std::string map_panel() {
    auto [data, plot] = plan_.ensemble > 1 ? probability_layers() : verdict_layers();
    data += cells("open", [](const OverturnPoint& p) {
      return p.verdict == Verdict::not_computed ? std::optional(0.) : std::nullopt;
    });
    plot += "$open using 1:2:3:4:5:6 with boxxyerror fs pattern 4 noborder fc rgb '#888888' notitle, ";
    std::string labels;
    for (std::size_t k = 0; k < map_.criteria.list.size(); ++k) {
      const Criterion& c = map_.criteria.list[k];
      data += fmt::format("$curve{} << END\n", k);
      for (std::size_t n = 0; n < c.x.size(); ++n) data += fmt::format("{:.6g} {:.6g}\n", c.x[n], c.y[n]);
      data += c.x.empty() ? "NaN NaN\nEND\n" : "END\n";
      // a light line below keeps the dark one apart from any ground
      plot += fmt::format(
          "$curve{0} with lines lc rgb '#ffffff' lw 5.5 notitle, $curve{0} with lines lc rgb '#000000' lw "
          "2.4 dt {1} notitle, ",
          k, k_dashes[std::min(k, std::size(k_dashes) - 1)]);
      labels += end_label(c);
    }
    if (plan_.ensemble > 1 && has_medians()) {
      data += "$medians << END\n" + medians() + "END\n";
      plot +=
          "$medians with linespoints lc rgb '#ffffff' lw 6 pt 7 ps 1.1 notitle, "
          "$medians with linespoints lc rgb '#e7298a' lw 3 pt 7 ps 0.8 notitle, ";
    }
    data += "$own << END\n" + own_point() + "END\n";
    plot +=
        "$own with points pt 7 ps 2.9 lc rgb '#ffffff' notitle, $own with points pt 6 ps 2.5 lw 3 lc rgb "
        "'#000000' notitle, "
        "$own with points pt 7 ps 0.8 lc rgb '#000000' notitle";
    std::string out = data + labels + own_label();
    out += panel_.sheet.place(panel_.left, panel_.right, panel_.bottom, panel_.top);
    out += "set border 15 lc rgb '#444444' lw 1 front\nset tics out scale 0.7,0.4 front\nunset key\n";
    out += axis_scale("x", plan_.x) + axis_scale("y", plan_.y);
    out += "set xlabel " + gnuplot_quoted(axis_title(plan_.x)) + " offset 0,0.2\nset ylabel " +
           gnuplot_quoted(axis_title(plan_.y)) + " offset 1.4,0\n";
    if (plan_.ensemble > 1)
      out +=
          std::string(k_viridis) +
          fmt::format(
              "set cbrange [0:1]\nset colorbox user origin screen {:.5f},{:.5f} size screen {:.5f},{:.5f}\n"
              "set cbtics 0.25\nset cblabel 'share of runs in which a body overturns' offset 0.4,0\n",
              (k_map_right + 128.) / panel_.sheet.width, panel_.bottom / panel_.sheet.height,
              22. / panel_.sheet.width, (panel_.top - panel_.bottom) / panel_.sheet.height);
    return out + "plot " + plot + "\nunset label\nunset arrow\nunset object\nunset colorbox\n";
  }

  /// Beside the right edge where the curve leaves there, else above the panel.
  std::string end_label(const Criterion& c) const {
    const double most_x = plan_.x.edges().back(), most_y = plan_.y.edges().back(),
                 least_y = plan_.y.edges().front();
    for (std::size_t n = c.x.size(); n-- > 0;) {
      if (c.y[n] > most_y || c.y[n] < least_y) continue;
      if (n + 1 == c.x.size() && panel_.x(c.x[n]) > panel_.x(most_x) - 60)
        return text(plain(c.label), panel_.right + 8, panel_.y(c.y[n]), "left");
      return text(plain(c.label), panel_.x(c.x[n]), panel_.top + 14, "center");
    }
    return "";
  }

  std::string medians() const {
    std::string out;
    const Axis& along = map_.fragility_along_y ? plan_.y : plan_.x;
    const Axis& other = map_.fragility_along_y ? plan_.x : plan_.y;
    for (std::size_t k = 0; k < map_.fragility.size(); ++k) {
      const Fragility& f = map_.fragility[k];
      if (!f.fit || f.fit->median < along.values.front() || f.fit->median > along.values.back()) {
        out += "\n";  // no line across what has none, nor to where nothing was run
        continue;
      }
      const double at = other.values[k];
      out += map_.fragility_along_y ? fmt::format("{:.6g} {:.6g}\n", at, f.fit->median)
                                    : fmt::format("{:.6g} {:.6g}\n", f.fit->median, at);
    }
    return out;
  }

  bool own_shown() const {
    const auto inside = [](const Axis& axis) {
      return axis.own && *axis.own >= axis.edges().front() && *axis.own <= axis.edges().back();
    };
    return inside(plan_.x) && inside(plan_.y);
  }

  std::string own_point() const {
    return own_shown() ? fmt::format("{:.9g} {:.9g}\n", *plan_.x.own, *plan_.y.own) : "NaN NaN\n";
  }

  std::string own_label() const {
    if (!own_shown()) return "";
    const double x = panel_.x(*plan_.x.own), y = panel_.y(*plan_.y.own);
    const bool right = x < (panel_.left + panel_.right) / 2;
    return "set style textbox 1 opaque noborder fillcolor '#ffffff' margins 0.6,0.4\n" +
           text(
               fmt::format("the scene: {}, {}", valued(plan_.x, *plan_.x.own), valued(plan_.y, *plan_.y.own)),
               x + (right ? 20 : -20), y, std::string(right ? "left" : "right") + " front boxed bs 1");
  }

  std::string fragility() const {
    const double middle_x = (k_second_left + k_second_right) / 2.;
    std::string out = panel_.sheet.place(k_second_left, k_second_right, k_bottom, k_height - k_top);
    if (map_.fragility.empty())
      return out +
             text("no fragility curve: neither axis is an amplitude or scale above 0", middle_x,
                  k_height / 2., "center") +
             "unset border\nunset tics\nunset xlabel\nunset ylabel\nset xrange [0:1]\nset yrange "
             "[0:1]\nunset "
             "logscale\nplot NaN notitle\n";
    const Axis& other = map_.fragility_along_y ? plan_.x : plan_.y;
    const std::vector<FloorPeak> peaks = floor_peaks(plan_, map_, map_.own_column);
    const std::vector<Level> own = levels(plan_, map_, map_.own_column);
    const GroundMeasure &pga = k_ground_measures[0], &pgv = k_ground_measures[1];
    const bool ground = !peaks.empty() && peaks.front().acceleration > 0;
    const Axis along = ground ? axis_over(pga, peaks) : map_.fragility_along_y ? plan_.y : plan_.x;
    const std::vector<Level> over = ground ? levels_over(pga, own, peaks) : own;
    const Fragility at = fit_fragility(over);
    std::vector<std::string> lines = fit_in_words(at, ground ? "PGA: " : "", along.unit);
    if (const Fragility by_velocity = fit_fragility(ground ? levels_over(pgv, own, peaks) : own);
        ground && by_velocity.fit)
      lines.insert(lines.begin() + 1, median_in_words(*by_velocity.fit, "PGV: ", pgv.unit));
    if (other.own)
      lines.insert(lines.begin(), "the value nearest to the scene's " + valued(other, *other.own));
    double y = k_height - k_top + (ground ? 46 : -6) + 24 * static_cast<double>(lines.size());
    out += text(bold(plain("At " + other.key + " = " +
                           valued(other, other.values[static_cast<std::size_t>(map_.own_column)])),
                     1.08),
                k_second_left, y + 28);
    for (const std::string& line : lines) out += text(line, k_second_left, std::exchange(y, y - 24), k_grey);
    out += "$shares << END\n";
    for (const Level& level : over) {
      if (level.runs == 0) continue;
      const Interval bounds = wilson(level.hits, level.runs);
      out += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", level.intensity,
                         static_cast<double>(level.hits) / level.runs, bounds.low, bounds.high);
    }
    out += "NaN NaN NaN NaN\nEND\n" + axis_scale("x", along);
    const auto proportional = [&](const FloorPeak& peak) {
      return std::abs(peak.velocity * peaks[0].acceleration - peaks[0].velocity * peak.acceleration) <
             1e-6 * peak.velocity * peaks[0].acceleration;
    };
    const bool above = ground && std::ranges::all_of(peaks, proportional);
    if (above) out += axis_above(axis_over(pgv, peaks));
    out +=
        "unset logscale y\nset yrange [-0.02:1.02]\nset ytics autofreq nomirror\nset grid ytics lc rgb "
        "'#dddddd' lw 0.8\n";
    out += "set xlabel " + gnuplot_quoted(axis_title(along)) + " offset 0,0.2\n";
    out += std::string(
               "set ylabel 'share of runs in which a body overturns, 95 % intervals (Wilson)' offset "
               "1.2,0\nset border ") +
           (above ? "7\n" : "3\n");
    std::string plot = "$shares with yerrorbars pt 7 ps 1.1 lw 1.8 lc rgb '#0072b2' notitle";
    if (at.fit) {
      out += "$fit << END\n";
      const std::vector<double> ends = along.edges();
      for (int k = 0; k <= 200; ++k) {
        const double part = k / 200.;
        const double a = along.logarithmic ? ends.front() * std::pow(ends.back() / ends.front(), part)
                                           : std::lerp(ends.front(), ends.back(), part);
        out += fmt::format("{:.6g} {:.6g}\n", a, at.fit->probability(a));
      }
      out += "END\n";
      plot = "$fit with lines lc rgb '#e7298a' lw 3 notitle, " + plot;
    }
    return out + "plot " + plot + "\n";
  }

  /// The intensity axis in a measure of the floor's motion.
  Axis axis_over(const GroundMeasure& measure, const std::vector<FloorPeak>& peaks) const {
    Axis axis = map_.fragility_along_y ? plan_.y : plan_.x;
    axis.key = measure.title;
    axis.unit = measure.unit;
    axis.own.reset();
    for (std::size_t i = 0; i < peaks.size(); ++i) axis.values[i] = peaks[i].*measure.value / measure.si;
    return axis;
  }

  /// A second scale above the panel, in proportion to the first.
  static std::string axis_above(const Axis& axis) {
    return axis_scale("x2", axis) + "set x2label " + gnuplot_quoted(axis_title(axis)) + " offset 0,-0.4\n";
  }

  static std::string median_in_words(const Lognormal& fit, const std::string& what, const std::string& unit) {
    const Interval range = fit.median_interval();
    return fmt::format("{}median {:.4g} {} ({:.4g} to {:.4g})", what, fit.median, unit, range.low,
                       range.high);
  }

  /// Three lines at most.
  static std::vector<std::string> fit_in_words(const Fragility& f, const std::string& what,
                                               const std::string& unit) {
    constexpr std::size_t k_line = 58;
    if (f.fit) {
      const Interval beta = f.fit->beta_interval();
      return {median_in_words(*f.fit, what, unit),
              fmt::format("lognormal, β = {:.3g} ({:.2g} to {:.2g}); in brackets 95 %", f.fit->beta, beta.low,
                          beta.high),
              fmt::format("deviance {:.3g} with {} degrees of freedom", f.fit->deviance, f.fit->freedom)};
    }
    const std::string words = plain("no lognormal: " + f.why_not);
    const std::size_t blank = words.size() > k_line ? words.rfind(' ', k_line) : std::string::npos;
    if (blank == std::string::npos) return {words};
    return {words.substr(0, blank), words.substr(blank + 1)};
  }

  const OverturnPlan& plan_;
  const OverturnMap& map_;
  const bool with_fragility_;
  const Rows marks_;  ///< of verdicts
  const MapPanel panel_;
};

}  // namespace

std::string overturn_chart(const OverturnPlan& plan, const OverturnMap& map, const std::string& origin,
                           ChartFormat format) {
  return Chart(plan, map).script(origin, format);
}

}  // namespace topple::study
