#include "solver/study/stability/stability_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/study/common/map_panel.h"

namespace topple::study {
namespace {

constexpr int k_columns = 3;
constexpr double k_left = 118, k_right = 44, k_bottom = 84, k_top = 20;                   // px, of the sheet
constexpr double k_wide = 476, k_high = 372, k_between = 92, k_above = 76, k_below = 76;  // of panels
constexpr double k_line = 23;                                                             // of text
constexpr double k_near = 20;  // px, between tags of lines

struct Look {
  Fate fate;
  CellStyle cell;
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
    std::string content = header(origin) + legend();
    for (std::size_t m = 0; m < plan_.methods.size(); ++m) content += map_of(m);
    return sheet_.script(format, content);
  }

 private:
  double header_height() const { return 50 + k_line * (7 + static_cast<double>(limits_.size())); }

  std::string header(const std::string& origin) const {
    const Axis &x_axis = plan_.x, &y_axis = plan_.y;
    const std::vector<std::string> lines{
        plan_.scene.title,
        fmt::format("{} by {} over {} by {} points, {:.3g} s of {:g} s simulated{}", x_axis.key, y_axis.key,
                    x_axis.count(), y_axis.count(), plan_.horizon, plan_.scene.setup.run.duration,
                    plan_.horizon < plan_.scene.setup.run.duration
                        ? fmt::format(": up to {:g} s after the last body has overturned", k_after_fall)
                        : ""),
        origin + ", " + runs_in_words(map_.run, map_.of),
        fmt::format("Right is what {} runs as the scene has it agree on: at a quarter and at half of its "
                    "step{}. They agree at {} of {} places across the step.",
                    plan_.references(),
                    plan_.references() > 2 ? fmt::format(", and with amplitudes {:g} % lower and higher",
                                                         100 * k_reference_spread)
                                           : "",
                    std::ranges::count_if(map_.references, [](const Agreement& r) { return r.decided; }),
                    map_.references.size()),
        std::string(
            "Maps a to d: every body a frame; the implicit methods halve a fixed step up to six times "
            "before they give up.") +
            (plan_.methods.back().of_scene() ? " The last one: bodies as the scene has them." : ""),
        fmt::format("Energy grows or is lost: {:g} % of the largest exchanged appears or vanishes, or the "
                    "integrator takes {:g} %. Tunnels: 1 - l/L > 1 and {:g} above that of the reference.",
                    100 * k_stable_balance, 100 * k_stable_damping, k_through)};
    const double top = sheet_.height - k_top;
    std::string out = sheet_.label(bold(plain("Where time integration fails in " + plan_.scene.name), 1.5),
                                   k_left, top - 22) +
                      sheet_.lines(lines, k_left, top - 56, k_line, k_grey_as_is);
    double y = top - 62 - k_line * static_cast<double>(lines.size());
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const StabilityLimit& limit = limits_[k];
      out +=
          sheet_.stroke(k_left, k_left + 56, y,
                        std::string("lc rgb '#000000' lw 2.4 dt ") + k_dashes[k % std::size(k_dashes)]) +
          tag(k, k_left + 74, y) +
          sheet_.label(
              limit.formula + ":  " + limit.about +
                  (limit.at_scene ? fmt::format(" (the scene: {:.3g} {})", *limit.at_scene, limit.unit) : ""),
              k_left + 94, y, k_grey);
      y -= k_line;
    }
    return out;
  }

  std::string tag(std::size_t k, double x, double y) const {
    return sheet_.label(bold(std::to_string(k + 1), 0.86), x, y, "center front") +
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
    std::string out = sheet_.label(bold("What became of the runs", 1), place.left, y + 30);
    for (std::size_t m = 0; m < plan_.methods.size(); ++m)
      out += sheet_.label(bold(std::string(1, letter(m)), 1), column(m), y + 30, "right");
    for (const Look& look : k_looks) {
      int all = 0;
      for (std::size_t m = 0; m < plan_.methods.size(); ++m) all += map_.count(m, look.fate);
      if (all == 0 && look.fate == Fate::not_computed) continue;
      out += sheet_.swatch(place.left, y, look.cell);
      for (std::size_t m = 0; m < plan_.methods.size(); ++m)
        out += sheet_.label(std::to_string(map_.count(m, look.fate)), column(m), y, "right");
      y -= 28;
    }
    if (!plan_.x.own || !plan_.y.own) return out;
    return out + sheet_.label("", place.left + 12, y, "point pt 6 ps 2 lw 3 lc rgb '#000000'") +
           sheet_.label(place.own_in_words(), place.left + 34, y);
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
    Plot plot;
    std::string tags;
    for (const Look& look : k_looks) {
      const auto met = [&](int i, int j) {
        return map_.cells[m][static_cast<std::size_t>(j * plan_.x.count() + i)].fate == look.fate;
      };
      at.fill_cells(plot, fmt::format("fate{}", static_cast<int>(look.fate)), met, look.cell,
                    look.fate == Fate::undecided ? 0.5 : 0.85);
    }
    std::vector<TagPlace> taken;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const StabilityLimit& limit = limits_[k];
      if (std::ranges::find(limit.methods, method.name) == limit.methods.end()) continue;
      outline(plot, fmt::format("limit{}", k), limit.x, limit.y, 5, 2.2, k_dashes[k % std::size(k_dashes)]);
      std::optional<TagPlace> end = end_of(limit, at);
      if (!end) continue;
      while (std::ranges::any_of(taken, [&](const TagPlace& t) {
        return std::abs(t.x - end->x) < k_near && std::abs(t.y - end->y) < k_near;
      }))
        end->x += k_near;
      taken.push_back(*end);
      tags += tag(k, end->x, end->y);
    }
    plot.layers.push_back("$own with points pt 6 ps 2 lw 6 lc rgb '#ffffff' notitle");
    plot.layers.push_back("$own with points pt 6 ps 2 lw 3 lc rgb '#000000' notitle");
    return plot.data + at.own_block() + tags +
           sheet_.label(bold(fmt::format("{}  {}", letter(m), method.label), 1.08), at.left, at.top + 56) +
           sheet_.label(fmt::format("{} of {} stable", map_.count(m, Fate::stable),
                                    plan_.points() - map_.count(m, Fate::not_computed)),
                        at.left, at.top + 34, k_grey) +
           at.axes(2) +
           (m % k_columns == 0 ? axis_label("y", plan_.y, "0.4,0") : std::string("unset ylabel\n")) +
           plot.command() + "unset label\nunset arrow\nunset object\n";
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
