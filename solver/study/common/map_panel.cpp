#include "solver/study/common/map_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

std::string axis_title(const Axis& axis) {
  return plain(axis.key) + (axis.unit.empty() ? "" : ", " + axis.unit);
}

std::string valued(const Axis& axis, double value) {
  return fmt::format("{:.4g}{}{}", value, axis.unit.empty() ? "" : " ", axis.unit);
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
  std::string out = "$" + block + " << END\n";
  bool any = false;
  for (int j = 0; j < y_axis->count(); ++j)
    for (int i = 0; i < x_axis->count(); ++i)
      if (const std::optional<double> value = wanted(i, j)) {
        any = true;
        out += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.6g}\n", x_axis->values[i],
                           y_axis->values[j], x[i], x[i + 1], y[j], y[j + 1], *value);
      }
  return any ? out + "END\n" : out + "NaN NaN NaN NaN NaN NaN NaN\nEND\n";
}

double MapPanel::mark_size() const {
  const double cell = std::min((right - left) / x_axis->count(), (top - bottom) / y_axis->count());
  return std::clamp(cell / 26, 0.15, 1.1);
}

}  // namespace topple::study
