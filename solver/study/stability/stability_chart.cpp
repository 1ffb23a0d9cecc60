#include "solver/study/stability/stability_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/study/common/gnuplot.h"
#include "solver/study/common/map_panel.h"

namespace topple::study {
namespace {

constexpr int k_columns = 3;
constexpr double k_left = 118, k_right = 44, k_bottom = 84, k_top = 20;                   // px, of the sheet
constexpr double k_wide = 476, k_high = 372, k_between = 92, k_above = 76, k_below = 76;  // of panels
constexpr double k_line = 23;                                                             // of text
constexpr double k_near = 20;  // px, between tags of lines

/// How a fate is drawn: told apart in grey by luminance, and by marks.
struct Look {
  Fate fate;
  const char *fill, *mark;  // "": hatched; no mark
  const char* meaning;
};
constexpr Look k_looks[] = {
    {Fate::stable, "#edf3f7", "", "stable, with the right verdict"},
    {Fate::undecided, "#d3d3d3", "pt 7 lc rgb '#666666'", "no verdict to compare with"},
    {Fate::loses, "#9cc5e3", "pt 11 lc rgb '#1d4f7c'", "energy lost"},
    {Fate::wrong, "#f4b25f", "pt 4 lw 2 lc rgb '#5a2d00'", "wrong verdict"},
    {Fate::tunnels, "#b79ad3", "pt 13 lc rgb '#3a1a5e'", "tunnels"},
    {Fate::grows, "#b3243f", "pt 9 lc rgb '#ffffff'", "energy grows"},
    {Fate::no_solution, "#5b2333", "pt 2 lw 1.6 lc rgb '#ffffff'", "Newton failure"},
    {Fate::refused, "#66727d", "pt 1 lw 1.6 lc rgb '#ffffff'", "refused: above its limit"},
    {Fate::failed, "#f5e663", "pt 3 lw 1.6 lc rgb '#000000'", "no rest to start from"},
    {Fate::not_computed, "", "", "not computed"}};

constexpr const char* k_dashes[] = {"1", "(18,6)", "(5,5)", "(18,5,4,5)", "(10,4)", "(2,4)", "(24,8,4,8)"};

class Chart {
 public:
  Chart(const StabilityPlan& plan, const StabilityMap& map, const std::vector<StabilityLimit>& limits)
      : plan_(plan),
        map_(map),
        limits_(limits),
        rows_(static_cast<int>(plan.methods.size()) / k_columns + 1) {
    sheet_.width = static_cast<int>(k_left + k_columns * k_wide + (k_columns - 1) * k_between + k_right);
    sheet_.height = static_cast<int>(k_top + header_height() + rows_ * (k_above + k_high) +
                                     (rows_ - 1) * k_below + k_bottom);
  }

  std::string script(const std::string& origin, ChartFormat format) {
    std::string out = sheet_.begin(format) + header(origin) + legend();
    for (std::size_t m = 0; m < plan_.methods.size(); ++m) out += map_of(m);
    return out + "unset multiplot\n";
  }

 private:
  std::string text(const std::string& words, double x, double y, const std::string& how = "") const {
    return sheet_.label(words, x, y, how);
  }

  double header_height() const { return 50 + k_line * (7 + static_cast<double>(limits_.size())); }

  std::string header(const std::string& origin) const {
    double y = sheet_.height - k_top - 22;
    const Axis &x_axis = plan_.x, &y_axis = plan_.y;
    std::string out =
        text(bold(plain("Where time integration fails in " + plan_.scene.name), 1.5), k_left, y);
    y -= 34;
    const auto line = [&](const std::string& words) {
      out += text(words, k_left, y, std::string("noenhanced ") + k_grey);
      y -= k_line;
    };
    line(plan_.scene.title);
    line(fmt::format("{} by {} over {} by {} points, {:.3g} s of {:g} s simulated{}", x_axis.key, y_axis.key,
                     x_axis.count(), y_axis.count(), plan_.horizon, plan_.scene.setup.run.duration,
                     plan_.horizon < plan_.scene.setup.run.duration
                         ? fmt::format(": up to {:g} s after the last body has overturned", k_after_fall)
                         : ""));
    line(origin + ", " +
         (map_.run == map_.of ? fmt::format("{} runs", map_.run)
                              : fmt::format("{} of {} runs", map_.run, map_.of)));
    line(fmt::format(
        "Right is what {} runs as the scene has it agree on: at a quarter and at half of its step{}. They "
        "agree at {} of {} places across the step.",
        plan_.references(),
        plan_.references() > 2
            ? fmt::format(", and with amplitudes {:g} % lower and higher", 100 * k_reference_spread)
            : "",
        std::ranges::count_if(map_.references, [](const Agreement& r) { return r.decided; }),
        map_.references.size()));
    line(std::string(
             "Maps a to d: every body a frame; the implicit methods halve a fixed step up to six times "
             "before they give up.") +
         (plan_.methods.back().of_scene() ? " The last one: bodies as the scene has them." : ""));
    line(
        fmt::format("Energy grows or is lost: {:g} % of the largest exchanged appears or vanishes, or the "
                    "integrator takes {:g} %. Tunnels: 1 - l/L > 1 and {:g} above that of the reference.",
                    100 * k_stable_balance, 100 * k_stable_damping, k_through));
    y -= 6;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const StabilityLimit& limit = limits_[k];
      out += stroke(k_left, k_left + 56, y, k) + tag(k, k_left + 74, y);
      out += text(limit.formula + ":  " + limit.about + here(limit), k_left + 94, y, k_grey);
      y -= k_line;
    }
    return out;
  }

  static std::string here(const StabilityLimit& limit) {
    return limit.at_scene ? fmt::format(" (the scene: {:.3g} {})", *limit.at_scene, limit.unit) : "";
  }

  std::string stroke(double from, double to, double y, std::size_t k) const {
    return fmt::format(
        "set arrow from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} nohead lc rgb '#000000' lw 2.4 dt {}\n",
        from / sheet_.width, y / sheet_.height, to / sheet_.width, y / sheet_.height,
        k_dashes[k % std::size(k_dashes)]);
  }

  std::string tag(std::size_t k, double x, double y) const {
    return text(fmt::format("{{/:Bold*0.86 {}}}", k + 1), x, y, "center front") +
           fmt::format(
               "set object circle at screen {:.5f},{:.5f} size screen {:.5f} front fs empty border lc rgb "
               "'#000000' lw 1\n",
               x / sheet_.width, y / sheet_.height, 9. / sheet_.width);
  }

  MapPanel panel(std::size_t place) const {
    const std::size_t above = place / k_columns;
    const auto column = static_cast<double>(place % k_columns), row = static_cast<double>(above);
    const double left = k_left + column * (k_wide + k_between);
    const double top = sheet_.height - k_top - header_height() - k_above - row * (k_above + k_high + k_below);
    return {sheet_, left, left + k_wide, top - k_high, top, &plan_.x, &plan_.y};
  }

  static char letter(std::size_t method) { return static_cast<char>('a' + method); }

  /// Behind the last map: a row for each fate that was met, a column for each map.
  std::string legend() const {
    const MapPanel place = panel(plan_.methods.size());
    double y = place.top - 8;
    const double first = place.left + 326;
    const auto column = [&](std::size_t m) { return first + 40 * static_cast<double>(m); };
    std::string out = text(bold("What became of the runs", 1), place.left, y + 30);
    for (std::size_t m = 0; m < plan_.methods.size(); ++m)
      out += text(bold(std::string(1, letter(m)), 1), column(m), y + 30, "right");
    for (const Look& look : k_looks) {
      int all = 0;
      for (std::size_t m = 0; m < plan_.methods.size(); ++m) all += map_.count(m, look.fate);
      if (all == 0 && look.fate == Fate::not_computed) continue;
      out += sheet_.swatch(place.left, y, look.fill, look.mark, look.meaning);
      for (std::size_t m = 0; m < plan_.methods.size(); ++m)
        out += text(std::to_string(map_.count(m, look.fate)), column(m), y, "right");
      y -= 28;
    }
    if (!plan_.x.own || !plan_.y.own) return out;
    out += text("", place.left + 12, y, "point pt 6 ps 2 lw 3 lc rgb '#000000'") +
           text("the scene: " + valued(plan_.x, *plan_.x.own) + ", " + valued(plan_.y, *plan_.y.own),
                place.left + 34, y);
    return out;
  }

  /// Where the tag of a line goes: beside its highest place within the map, at the right of a level one.
  struct TagPlace {
    double x, y;
  };
  static std::optional<TagPlace> end_of(const StabilityLimit& limit, const MapPanel& panel) {
    std::optional<TagPlace> best;
    for (std::size_t n = 0; n < limit.x.size(); ++n) {
      const double x = panel.x(limit.x[n]), y = panel.y(limit.y[n]);
      if (x < panel.left || x > panel.right || y < panel.bottom - 1 || y > panel.top + 1) continue;
      if (!best || y > best->y + 1 || (y > best->y - 1 && x > best->x)) best = TagPlace{x, y};
    }
    if (!best) return best;
    if (best->y > panel.top - k_near) return TagPlace{best->x, panel.top + 13};
    return TagPlace{panel.right + 14, best->y};
  }

  std::string map_of(std::size_t m) const {
    const MapPanel at = panel(m);
    const SteppingMethod& method = plan_.methods[m];
    std::string data, plot, tags;
    for (const Look& look : k_looks) {
      const std::string block = fmt::format("fate{}", static_cast<int>(look.fate));
      data += at.cells(block, [&](int i, int j) {
        return map_.cells[m][static_cast<std::size_t>(j * plan_.x.count() + i)].fate == look.fate
                   ? std::optional(0.)
                   : std::nullopt;
      });
      const std::string style = *look.fill ? fmt::format("solid noborder fc rgb '{}'", look.fill)
                                           : std::string("pattern 4 noborder fc rgb '#888888'");
      plot += fmt::format("${} using 1:2:3:4:5:6 with boxxyerror fs {} notitle, ", block, style);
      if (*look.mark)
        plot += fmt::format("${} using 1:2 with points {} ps {:.2f} notitle, ", block, look.mark,
                            at.mark_size() * (look.fate == Fate::undecided ? 0.5 : 0.85));
    }
    std::vector<TagPlace> taken;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const StabilityLimit& limit = limits_[k];
      if (std::ranges::find(limit.methods, method.name) == limit.methods.end()) continue;
      data += fmt::format("$limit{} << END\n", k);
      for (std::size_t n = 0; n < limit.x.size(); ++n)
        data += fmt::format("{:.6g} {:.6g}\n", limit.x[n], limit.y[n]);
      data += limit.x.empty() ? "NaN NaN\nEND\n" : "END\n";
      // a light line below keeps the dark one apart from any ground
      plot += fmt::format(
          "$limit{0} with lines lc rgb '#ffffff' lw 5 notitle, $limit{0} with lines lc rgb '#000000' lw 2.2 "
          "dt "
          "{1} notitle, ",
          k, k_dashes[k % std::size(k_dashes)]);
      std::optional<TagPlace> end = end_of(limit, at);
      if (!end) continue;
      while (std::ranges::any_of(taken, [&](const TagPlace& t) {
        return std::abs(t.x - end->x) < k_near && std::abs(t.y - end->y) < k_near;
      }))
        end->x += k_near;
      taken.push_back(*end);
      tags += tag(k, end->x, end->y);
    }
    data += "$own << END\n" + own_point() + "END\n";
    plot +=
        "$own with points pt 6 ps 2 lw 6 lc rgb '#ffffff' notitle, $own with points pt 6 ps 2 lw 3 lc rgb "
        "'#000000' notitle";
    std::string out = data + tags;
    out += text(bold(fmt::format("{}  {}", letter(m), method.label), 1.08), at.left, at.top + 56);
    out += text(fmt::format("{} of {} stable", map_.count(m, Fate::stable),
                            plan_.points() - map_.count(m, Fate::not_computed)),
                at.left, at.top + 34, k_grey);
    out += sheet_.place(at.left, at.right, at.bottom, at.top);
    out += "set border 15 lc rgb '#444444' lw 1 front\nset tics out scale 0.7,0.4 front\nunset key\n";
    out += axis_scale("x", plan_.x, 2) + axis_scale("y", plan_.y, 2);
    out += "set xlabel " + gnuplot_quoted(axis_title(plan_.x)) + " offset 0,0.2\n";
    out += m % k_columns == 0 ? "set ylabel " + gnuplot_quoted(axis_title(plan_.y)) + " offset 0.4,0\n"
                              : std::string("unset ylabel\n");
    return out + "plot " + plot + "\nunset label\nunset arrow\nunset object\n";
  }

  std::string own_point() const {
    const auto inside = [](const Axis& axis) {
      return axis.own && *axis.own >= axis.edges().front() && *axis.own <= axis.edges().back();
    };
    return inside(plan_.x) && inside(plan_.y) ? fmt::format("{:.9g} {:.9g}\n", *plan_.x.own, *plan_.y.own)
                                              : "NaN NaN\n";
  }

  const StabilityPlan& plan_;
  const StabilityMap& map_;
  const std::vector<StabilityLimit>& limits_;
  const int rows_;
  Sheet sheet_{};
};

}  // namespace

std::string stability_chart(const StabilityPlan& plan, const StabilityMap& map,
                            const std::vector<StabilityLimit>& limits, const std::string& origin,
                            ChartFormat format) {
  return Chart(plan, map, limits).script(origin, format);
}

}  // namespace topple::study
