#include "solver/study/overturn/overturn_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "solver/study/common/map_panel.h"

namespace topple::study {
namespace {

constexpr int k_height = 1064, k_single = 1240, k_double = 1960;  // px, sheets of one panel and of two
constexpr int k_left = 112, k_bottom = 92, k_top = 300;           // around panels
constexpr int k_map_right = 1070, k_second_left = 1424, k_second_right = 1926;
constexpr int k_margin = 20, k_mark_row = 26;  // px: right of marks; from one row of them to the next

struct Look {
  Verdict verdict;
  CellStyle cell;
};
constexpr Look k_looks[] = {{Verdict::stands, "#edf2f7", "", "stands: no side of a base lifts"},
                            {Verdict::rocks, "#a9cbe4", "pt 7 lc rgb '#2b5c86'", "rocks and stays up"},
                            {Verdict::some, "#f2ab5e", "pt 9 lc rgb '#5a2d00'", "some bodies overturn"},
                            {Verdict::all, "#a3203a", "pt 2 lw 1.6 lc rgb '#ffffff'", "all bodies overturn"},
                            {Verdict::failed, "#f5e663", "pt 1 lw 2 lc rgb '#000000'", "the run failed"}};
constexpr CellStyle k_failed = k_looks[4].cell;
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
        marks_(rows_of_marks()),
        sheet_{with_fragility_ ? k_double : k_single,
               k_height + k_mark_row * (static_cast<int>(marks_.size()) - 1)},
        panel_{sheet_, k_left, k_map_right, k_bottom, k_height - k_top, &plan.x, &plan.y} {}

  std::string script(const std::string& origin, ChartFormat format) {
    return sheet_.script(format, header(origin) + map_panel() + (with_fragility_ ? fragility() : ""));
  }

 private:
  using Rows = std::vector<std::vector<Look>>;

  const OverturnPoint& point(int i, int j) const {
    return map_.points[static_cast<std::size_t>(j * plan_.x.count() + i)];
  }

  std::string header(const std::string& origin) const {
    const std::string what = plan_.ensemble > 1 ? "How often a body overturns in " : "What overturns in ";
    std::string settings = fmt::format("{:g} s simulated", plan_.scene.setup.run.duration);
    for (const std::string& change : plan_.set) settings += ", " + change;
    if (plan_.ensemble > 1) settings += ". Varied from run to run: " + plan_.factors.in_words();
    const int top = sheet_.height;
    return sheet_.label(bold(plain(what + plan_.scene.name), 1.5), k_left, top - 34) +
           sheet_.lines({plan_.scene.title, settings, origin + ", " + coverage()}, k_left, top - 74, 26,
                        k_grey_as_is) +
           marks() + criteria_in_words();
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
    return map_.run == map_.of ? points : runs_in_words(map_.run, map_.of) + ", " + points;
  }

  bool shows(Verdict verdict) const {
    return std::ranges::any_of(map_.points, [=](const OverturnPoint& p) { return p.verdict == verdict; });
  }

  /// px, at most.
  static double width_of(const std::string& words) { return 64 + 9.2 * static_cast<double>(words.size()); }

  /// What the marks of the map mean, in rows that the sheet is wide enough for.
  Rows rows_of_marks() const {
    std::vector<Look> looks(std::begin(k_looks), std::end(k_looks));
    if (with_fragility_) looks = {{Verdict::failed, {k_failed.fill, k_failed.mark, "every run failed"}}};
    looks.push_back(k_open);
    Rows rows(1);
    double x = k_left;
    for (const Look& look : looks) {
      if (!shows(look.verdict)) continue;
      const double width = width_of(look.cell.meaning);
      if (x + width > k_single - k_margin) {
        rows.emplace_back();
        x = k_left;
      }
      rows.back().push_back(look);
      x += width;
    }
    return rows;
  }

  std::string marks() const {
    std::string out;
    double x = k_left, y = sheet_.height - 160 + k_mark_row;
    for (const std::vector<Look>& row : marks_) {
      x = k_left;
      y -= k_mark_row;
      for (const Look& look : row) {
        out += sheet_.swatch(x, y, look.cell);
        x += width_of(look.cell.meaning);
      }
    }
    if (has_medians())
      out += sheet_.stroke(x, x + 34, y, "lc rgb '#e7298a' lw 3") +
             sheet_.label("", x + 17, y, "point pt 7 ps 0.8 lc rgb '#e7298a'") +
             sheet_.label("median of the fitted lognormal, where there is one within the map", x + 44, y);
    return out;
  }

  std::string criteria_in_words() const {
    if (!map_.criteria.why_not.empty())
      return sheet_.label(plain("No criteria are drawn: " + map_.criteria.why_not), k_left, k_height - 190,
                          k_grey);
    std::vector<std::string> lines{fmt::format(
        "Curves: a rigid block like {} alone on the floor, b = {:.0f} mm, h = {:.0f} mm, that does not slip "
        "(its friction: {:g})",
        plain(map_.criteria.bodies), 1e3 * map_.criteria.body.base, 1e3 * map_.criteria.body.height,
        map_.criteria.body.grip * plan_.scene.setup.parameters.contact.friction)};
    for (const Criterion& c : map_.criteria.list) lines.push_back(plain(c.label) + ": " + c.about);
    for (std::string& line : lines) line = scaled(line, 0.94);
    return sheet_.lines(lines, k_left, k_height - 186, 22, k_grey);
  }

  bool has_medians() const {
    return with_fragility_ &&
           std::ranges::any_of(map_.fragility, [](const Fragility& f) { return f.fit.has_value(); });
  }

  std::function<bool(int i, int j)> has(Verdict verdict) const {
    return [this, verdict](int i, int j) { return point(i, j).verdict == verdict; };
  }

  std::string map_panel() {
    Plot plot;
    if (plan_.ensemble > 1) {
      plot.data = panel_.cells("probability", [&](int i, int j) { return point(i, j).probability(); });
      plot.layers = {"$probability using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder lc palette notitle"};
      panel_.fill_cells(plot, "failed", has(Verdict::failed), k_failed, 1);
    } else {
      for (const Look& look : k_looks)
        panel_.fill_cells(plot, fmt::format("verdict{}", static_cast<int>(look.verdict)), has(look.verdict),
                          look.cell, look.verdict == Verdict::rocks ? 0.45 : 0.8);
    }
    panel_.fill_cells(plot, "open", has(Verdict::not_computed), k_open.cell, 1);
    std::string labels;
    for (std::size_t k = 0; k < map_.criteria.list.size(); ++k) {
      const Criterion& c = map_.criteria.list[k];
      outline(plot, fmt::format("curve{}", k), c.x, c.y, 5.5, 2.4,
              k_dashes[std::min(k, std::size(k_dashes) - 1)]);
      labels += end_label(c);
    }
    if (has_medians()) {
      plot.add("medians", medians(), "with linespoints lc rgb '#ffffff' lw 6 pt 7 ps 1.1 notitle");
      plot.layers.push_back("$medians with linespoints lc rgb '#e7298a' lw 3 pt 7 ps 0.8 notitle");
    }
    plot.layers.push_back("$own with points pt 7 ps 2.9 lc rgb '#ffffff' notitle");
    plot.layers.push_back("$own with points pt 6 ps 2.5 lw 3 lc rgb '#000000' notitle");
    plot.layers.push_back("$own with points pt 7 ps 0.8 lc rgb '#000000' notitle");
    std::string out = plot.data + panel_.own_block() + labels + own_label() + panel_.axes() +
                      axis_label("y", plan_.y, "1.4,0");
    if (plan_.ensemble > 1)
      out +=
          std::string(k_viridis) +
          fmt::format(
              "set cbrange [0:1]\nset colorbox user origin screen {:.5f},{:.5f} size screen {:.5f},{:.5f}\n"
              "set cbtics 0.25\nset cblabel 'share of runs in which a body overturns' offset 0.4,0\n",
              (k_map_right + 128.) / sheet_.width, panel_.bottom / sheet_.height, 22. / sheet_.width,
              (panel_.top - panel_.bottom) / sheet_.height);
    return out + plot.command() + "unset label\nunset arrow\nunset object\nunset colorbox\n";
  }

  /// Beside the right edge where the curve leaves there, on the map where it leaves below, else above.
  std::string end_label(const Criterion& c) const {
    const double most_x = plan_.x.edges().back(), most_y = plan_.y.edges().back(),
                 least_y = plan_.y.edges().front();
    for (std::size_t n = c.x.size(); n-- > 0;) {
      if (c.y[n] > most_y || c.y[n] < least_y) continue;
      if (n + 1 == c.x.size() && panel_.x(c.x[n]) > panel_.x(most_x) - 60)
        return sheet_.label(plain(c.label), panel_.right + 8, panel_.y(c.y[n]), "left");
      if (n + 1 < c.x.size() && c.y[n + 1] < least_y)
        return sheet_.label(plain(c.label), panel_.x(c.x[n]) + 10, panel_.y(c.y[n]) + 12, "left front");
      return sheet_.label(plain(c.label), panel_.x(c.x[n]), panel_.top + 14, "center");
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
      out += map_.fragility_along_y ? point_row(at, f.fit->median) : point_row(f.fit->median, at);
    }
    return out;
  }

  std::string own_label() const {
    if (!panel_.own_shown()) return "";
    const double x = panel_.x(*plan_.x.own), y = panel_.y(*plan_.y.own);
    const bool right = x < (panel_.left + panel_.right) / 2;
    return "set style textbox 1 opaque noborder fillcolor '#ffffff' margins 0.6,0.4\n" +
           sheet_.label(panel_.own_in_words(), x + (right ? 20 : -20), y,
                        std::string(right ? "left" : "right") + " front boxed bs 1");
  }

  std::string fragility() const {
    std::string out = sheet_.place(k_second_left, k_second_right, k_bottom, k_height - k_top);
    if (map_.fragility.empty())
      return out +
             sheet_.label("no fragility curve: neither axis is an amplitude or scale above 0",
                          (k_second_left + k_second_right) / 2., k_height / 2., "center") +
             no_axes("unset xlabel\nunset ylabel\n") + "unset logscale\nplot NaN notitle\n";
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
    const double y = k_height - k_top + (ground ? 46 : -6) + 24 * static_cast<double>(lines.size());
    out += sheet_.label(bold(plain("At " + other.key + " = " +
                                   valued(other, other.values[static_cast<std::size_t>(map_.own_column)])),
                             1.08),
                        k_second_left, y + 28) +
           sheet_.lines(lines, k_second_left, y, 24, k_grey);
    std::string shares;
    for (const Level& level : over) {
      if (level.runs == 0) continue;
      const Interval bounds = wilson(level.hits, level.runs);
      shares += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", level.intensity,
                            static_cast<double>(level.hits) / level.runs, bounds.low, bounds.high);
    }
    out += data_block("shares", shares + "NaN NaN NaN NaN\n") + axis_scale("x", along);
    const auto proportional = [&](const FloorPeak& peak) {
      return std::abs(peak.velocity * peaks[0].acceleration - peaks[0].velocity * peak.acceleration) <
             1e-6 * peak.velocity * peaks[0].acceleration;
    };
    const bool above = ground && std::ranges::all_of(peaks, proportional);
    if (above) out += axis_above(axis_over(pgv, peaks));
    out +=
        "unset logscale y\nset yrange [-0.02:1.02]\nset ytics autofreq nomirror\nset grid ytics lc rgb "
        "'#dddddd' lw 0.8\n";
    out += axis_label("x", along, "0,0.2") +
           "set ylabel 'share of runs in which a body overturns, 95 % intervals (Wilson)' offset 1.2,0\n"
           "set border " +
           (above ? "7\n" : "3\n");
    Plot plot;
    if (at.fit) {
      std::string fit;
      const std::vector<double> ends = along.edges();
      for (int k = 0; k <= 200; ++k) {
        const double part = k / 200.;
        const double a = along.logarithmic ? ends.front() * std::pow(ends.back() / ends.front(), part)
                                           : std::lerp(ends.front(), ends.back(), part);
        fit += point_row(a, at.fit->probability(a));
      }
      plot.add("fit", fit, "with lines lc rgb '#e7298a' lw 3 notitle");
    }
    plot.layers.push_back("$shares with yerrorbars pt 7 ps 1.1 lw 1.8 lc rgb '#0072b2' notitle");
    return out + plot.data + plot.command();
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
    return axis_scale("x2", axis) + axis_label("x2", axis, "0,-0.4");
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
  const Rows marks_;
  const Sheet sheet_;
  const MapPanel panel_;
};

}  // namespace

std::string overturn_chart(const OverturnPlan& plan, const OverturnMap& map, const std::string& origin,
                           ChartFormat format) {
  return Chart(plan, map).script(origin, format);
}

}  // namespace topple::study
