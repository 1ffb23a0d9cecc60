// A map over two axes on the sheet of a chart.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "solver/study/common/axis.h"
#include "solver/study/common/chart.h"

namespace topple::study {

inline constexpr const char* k_grey = "textcolor rgb '#444444'";

/// `which` axis of the next plot ("x", "y"): range over the cells, scale, and tics, at 1, 2 and 5 of each
/// decade where it is logarithmic, at 1 alone from `decades` of them on.
std::string axis_scale(const char* which, const Axis& axis, double decades = 10);
/// "run.time_step, ms".
std::string axis_title(const Axis& axis);
/// "1 ms".
std::string valued(const Axis& axis, double value);

/// Where a map is on its sheet, px, and what it is over.
struct MapPanel {
  Sheet sheet;
  double left, right, bottom, top;
  const Axis *x_axis, *y_axis;

  double x(double value) const;  ///< px
  double y(double value) const;
  /// Data block of the cells for which wanted(i, j) gives a value: x, y, ends in x, ends in y, value.
  std::string cells(const std::string& block,
                    const std::function<std::optional<double>(int i, int j)>& wanted) const;
  /// px, of marks: smaller than the cells.
  double mark_size() const;
};

}  // namespace topple::study
