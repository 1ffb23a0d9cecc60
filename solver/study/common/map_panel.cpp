#include "solver/study/common/map_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/study/common/gnuplot.h"

namespace topple::study {
namespace {

/// 0..1 of the way across the cells.
double part(const Axis& axis, double value) {
  const std::vector<double> ends = axis.edges();
  return axis.logarithmic ? std::log(value / ends.front()) / std::log(ends.back() / ends.front())
                          : (value - ends.front()) / (ends.back() - ends.front());
}

}  // namespace

std::string axis_scale(const char* which, const Axis& axis, double decades) {
  const std::vector<double> ends = axis.edges();
  std::string out = fmt::format("set {}range [{:.9g}:{:.9g}]\n", which, ends.front(), ends.back());
  if (!axis.logarithmic)
    return out + fmt::format("unset logscale {0}\nset {0}tics autofreq nomirror\n", which);
  const bool crowded = ends.back() / ends.front() >= std::pow(10., decades);
  std::string tics;
  for (int e = static_cast<int>(std::floor(std::log10(ends.front()))); std::pow(10., e) < ends.back(); ++e)
    for (const double digit : {1., 2., 5.})
      if (const double at = digit * std::pow(10., e);
          at >= ends.front() && at <= ends.back() && (digit == 1 || !crowded))
        tics += fmt::format("{0}\"{1:.6g}\" {1:.6g}", tics.empty() ? "" : ",", at);
  return out + fmt::format("set logscale {0}\nset {0}tics nomirror ({1})\n", which, tics);
}

std::string axis_label(const char* which, const Axis& axis, const char* offset) {
  return fmt::format("set {}label {} offset {}\n", which,
                     gnuplot_quoted(plain(axis.key) + (axis.unit.empty() ? "" : ", " + axis.unit)), offset);
}

std::string valued(const Axis& axis, double value) {
  return fmt::format("{:.4g}{}{}", value, axis.unit.empty() ? "" : " ", axis.unit);
}

void outline(Plot& plot, const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
             double light_width, double dark_width, const char* dash) {
  std::string rows;
  for (std::size_t n = 0; n < x.size(); ++n) rows += point_row(x[n], y[n]);
  plot.add(name, rows, fmt::format("with lines lc rgb '#ffffff' lw {} notitle", light_width));
  plot.layers.push_back(
      fmt::format("${} with lines lc rgb '#000000' lw {} dt {} notitle", name, dark_width, dash));
}

double MapPanel::x(double value) const {
  return left + (right - left) * part(*x_axis, value);
}

double MapPanel::y(double value) const {
  return bottom + (top - bottom) * part(*y_axis, value);
}

std::string MapPanel::cells(const std::string& block,
                            const std::function<std::optional<double>(int i, int j)>& wanted) const {
  const std::vector<double> x = x_axis->edges(), y = y_axis->edges();
  std::string rows;
  for (int j = 0; j < y_axis->count(); ++j)
    for (int i = 0; i < x_axis->count(); ++i)
      if (const std::optional<double> value = wanted(i, j))
        rows += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.6g}\n", x_axis->values[i],
                            y_axis->values[j], x[i], x[i + 1], y[j], y[j + 1], *value);
  return data_block(block, rows, 7);
}

void MapPanel::fill_cells(Plot& plot, const std::string& block,
                          const std::function<bool(int i, int j)>& wanted, const CellStyle& look,
                          double part) const {
  plot.data += cells(block, [&](int i, int j) { return wanted(i, j) ? std::optional(0.) : std::nullopt; });
  plot.layers.push_back(
      fmt::format("${} using 1:2:3:4:5:6 with boxxyerror fs {} noborder fc rgb '{}' notitle", block,
                  *look.fill ? "solid" : "pattern 4", *look.fill ? look.fill : "#888888"));
  if (*look.mark)
    plot.layers.push_back(
        fmt::format("${} using 1:2 with points {} ps {:.2f} notitle", block, look.mark, mark_size() * part));
}

std::string MapPanel::axes(double decades) const {
  return sheet.place(left, right, bottom, top) +
         "set border 15 lc rgb '#444444' lw 1 front\nset tics out scale 0.7,0.4 front\nunset key\n" +
         axis_scale("x", *x_axis, decades) + axis_scale("y", *y_axis, decades) +
         axis_label("x", *x_axis, "0,0.2");
}

bool MapPanel::own_shown() const {
  const auto inside = [](const Axis& axis) {
    return axis.own && *axis.own >= axis.edges().front() && *axis.own <= axis.edges().back();
  };
  return inside(*x_axis) && inside(*y_axis);
}

std::string MapPanel::own_block() const {
  return data_block("own", own_shown() ? fmt::format("{:.9g} {:.9g}\n", *x_axis->own, *y_axis->own) : "");
}

std::string MapPanel::own_in_words() const {
  return "the scene: " + valued(*x_axis, *x_axis->own) + ", " + valued(*y_axis, *y_axis->own);
}

double MapPanel::mark_size() const {
  const double cell = std::min((right - left) / x_axis->count(), (top - bottom) / y_axis->count());
  return std::clamp(cell / 26, 0.15, 1.1);
}

}  // namespace topple::study
