#include "solver/study/validate/furniture_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/study/validate/block_run.h"

namespace topple::study {
namespace {

constexpr int k_sheet_width = 1240, k_sheet_height = 760;
constexpr double k_left = 92, k_right = 30, k_column = k_sheet_width / 2.;  // px
constexpr const char* k_colours[] = {"#0072b2", "#d98a00", "#a3203a", "#009e73", "#7b4fa3"};
constexpr const char* k_points[] = {"7", "5", "9", "11", "13"};
constexpr double k_beside = 0.012;  // of a decade, between points of two pieces

/// Panel whose points lie at x(value, point) where it has one.
template <class Place>
void add_points(Plot& plot, const std::vector<FurnitureValue>& values,
                const std::vector<FurnitureCurve>& curves, const Place& x) {
  const std::vector<FurniturePoint> points = furniture_points(values);
  for (std::size_t p = 0; p < values.size(); ++p) {
    std::string rows;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points[k].piece != p || !curves[k].half) continue;
      const double at = x(values[p], points[k]);
      if (!(at > 0)) continue;
      const FurnitureCurve::Half& half = *curves[k].half;
      const double aside = std::pow(10, k_beside * (static_cast<double>(p) - 2));
      rows += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", at * aside, half.median, half.low, half.high);
    }
    const std::string block = fmt::format("piece{}", p);
    plot.data += data_block(block, rows, 4);
    plot.layers.push_back(fmt::format("${} with yerrorlines pt {} ps 1.1 lw 1.6 lc rgb '{}' notitle", block,
                                      k_points[p % std::size(k_points)],
                                      k_colours[p % std::size(k_colours)]));
  }
}

std::string frame(const Sheet& sheet, double left, double bottom, double top, const char* x_label,
                  const char* heading) {
  return sheet.label(bold(heading, 1), left, top + 26) +
         sheet.place(left, left - k_left + k_column - k_right, bottom, top) +
         fmt::format(
             "set xlabel '{}' offset 0,0.3\nset ylabel 'acceleration that half overturn at, over A_{{R50}}' "
             "offset 1,0\nset border 3 lc rgb '#444444' lw 1\n{}",
             x_label, grid("#dddddd"));
}

}  // namespace

std::string furniture_chart(const std::vector<FurnitureValue>& values,
                            const std::vector<FurnitureCurve>& curves, const std::string& origin,
                            ChartFormat format) {
  const Sheet sheet{k_sheet_width, k_sheet_height};
  const double top = sheet.height, bottom = 80, plot_top = top - 190;
  std::string out =
      sheet.label(bold("Furniture values of the Japanese evaluation against planar blocks", 1.5), k_left,
                  top - 34) +
      sheet.lines(
          {fmt::format("{} floors of each frequency and level: noise, even spectrum within a third of an "
                       "octave to either side, 20 s; bars: 95 %",
                       k_motions),
           origin},
          k_left, top - 74, 24, k_grey_as_is);
  out += frame(sheet, k_left, bottom, plot_top, "frequency of the floor over F_b",
               "Without slip, over frequency");
  out +=
      "set logscale xy\nset xrange [0.2:5]\nset yrange [0.5:20]\nset xtics (0.25,0.5,1,2,4) nomirror\n"
      "set ytics (0.5,1,2,5,10,20) nomirror\nset key left top Left reverse samplen 2 spacing 1.2\n";
  Plot frequency;
  frequency.add("formula", "0.2 1\n1 1\n5 5\n", "with lines lw 3 lc rgb '#444444' title 'formula'");
  add_points(frequency, values, curves, [](const FurnitureValue&, const FurniturePoint& point) {
    return point.friction == k_rough ? point.ratio : 0;
  });
  for (std::size_t p = 0; p < values.size(); ++p)
    frequency.add(fmt::format("key{}", p), "",
                  fmt::format("with linespoints pt {} lw 1.6 lc rgb '{}' title {}",
                              k_points[p % std::size(k_points)], k_colours[p % std::size(k_colours)],
                              "'" + plain(values[p].name) + fmt::format(", {:g} m'", values[p].height)));
  out += frequency.data + frequency.command() + "unset label\n";
  out += frame(sheet, k_left + k_column, bottom, plot_top, "friction over B/H",
               "With slip, at half of the corner frequency");
  out += "set xrange [0.5:6]\nset yrange [0.5:20]\nset xtics (0.5,1,2,5) nomirror\nunset key\n";
  Plot friction;
  friction.add("formula", "0.5 1\n6 1\n", "with lines lw 3 lc rgb '#444444' notitle");
  friction.add("slides", "1 0.5\n1 20\n", "with lines lw 1.5 dt (4,4) lc rgb '#444444' notitle");
  add_points(friction, values, curves, [](const FurnitureValue& value, const FurniturePoint& point) {
    return point.friction == k_rough ? 0 : point.friction / value.slenderness();
  });
  out += sheet.label("it slides: none", k_left + k_column + 8, plot_top - 14, k_grey);
  out += friction.data + friction.command() + "unset label\nunset logscale\n";
  return sheet.script(format, out);
}

}  // namespace topple::study
