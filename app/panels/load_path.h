// The path of a static run: its load factor over the displacement of one place.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <imgui.h>

#include "app/live/live_report.h"
#include "solver/run/run.h"

namespace topple::app {

/// What a path is drawn over.
struct PathMeasure {
  int body;
  int node;       ///< index into the model; -1: the body's centre of gravity
  int direction;  ///< as PathControl::direction
};

/// The controlled node and direction; without one the first probe, or the node that has moved most from
/// `first` to `last`, along the axis on which it has gone furthest.
PathMeasure path_measure(const Setup& setup, const io::FrameRow& first, const io::FrameRow& last);

/// "corner, x": the name of a probe that is there, or body and node.
std::string name_of(const Setup& setup, const PathMeasure& measure);

/// m or rad, from the reference pose; more than half a turn is told from less by what it was `before`.
double travel(const Model& model, const PathMeasure& measure, const io::FrameRow& row, double before);

/// Of each row of a way.
std::vector<double> travels(const Model& model, const PathMeasure& measure, const std::vector<RowPtr>& way);

/// What the axis of a path covers: 0 and the values, with room beside them. What is not greater than
/// `rounding` counts as 0.
struct PathAxis {
  PathAxis(const std::vector<double>& values, double rounding);
  float part(double value) const { return static_cast<float>((value - low) / (high - low)); }
  double low, high;
};

/// Index of the point that is nearest to `place`. There must be one.
std::size_t nearest_point(const std::vector<ImVec2>& points, ImVec2 place);

}  // namespace topple::app
