// A map over two axes on the sheet of a chart.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solver/study/common/axis.h"
#include "solver/study/common/chart.h"

namespace topple::study {

/// `which` axis of the next plot ("x", "y"): range over the cells, scale, and tics, at 1, 2 and 5 of each
/// decade where it is logarithmic, at 1 alone from `decades` of them on.
std::string axis_scale(const char* which, const Axis& axis, double decades = 10);
/// Key and unit beside the `which` axis, "run.time_step, ms"; `offset` of gnuplot.
std::string axis_label(const char* which, const Axis& axis, const char* offset);
/// "1 ms".
std::string valued(const Axis& axis, double value);

/// Plots a dark line on a broader light one, which keeps it apart from any ground.
void outline(Plot& plot, const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
             double light_width, double dark_width, const char* dash);

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
  /// Plots the cells that are wanted; marks have this part of mark_size().
  void fill_cells(Plot& plot, const std::string& block, const std::function<bool(int i, int j)>& wanted,
                  const CellStyle& look, double part) const;
  /// Place, frame, scales and the label in x.
  std::string axes(double decades = 10) const;
  /// Whether the scene itself is on the map.
  bool own_shown() const;
  /// Data block $own of the scene itself.
  std::string own_block() const;
  /// "the scene: 1 ms, 50 kgf".
  std::string own_in_words() const;
  /// px, of marks: smaller than the cells.
  double mark_size() const;
};

}  // namespace topple::study
