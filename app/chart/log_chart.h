// Charts of Dear ImGui: two logarithmic axes, lines, and the key below a chart.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

namespace topple::app {

/// 0 < low < high, in the unit that is written at it.
struct LogAxis {
  double low, high;
  bool contains(double value) const { return value >= low && value <= high; }
  /// 0..1 from low to high; less or more beyond.
  float part(double value) const;
};

/// Rectangle of a chart, px.
struct ChartBox {
  float left, right, top, bottom;
};

/// With its axes.
struct LogChart : ChartBox {
  LogAxis x, y;
  ImVec2 at(double x_value, double y_value) const;
  ImVec2 clamped(double x_value, double y_value) const;
};

/// A chart of this height at the cursor, with its y axis's title above it.
LogChart chart_at_cursor(const LogAxis& x, const LogAxis& y, float height, const std::string& y_title);

/// Background, grid lines at 1, 2 and 5 of each decade (of many decades at 1 alone), and numbers where they
/// have room.
void draw_log_grid(ImDrawList& list, const LogChart& chart);

/// `dash`: px of a dash and of the gap after it; 0: an unbroken line. A wider line of the
/// background's colour keeps it apart from what is below.
void add_line(ImDrawList& list, const std::vector<ImVec2>& points, ImU32 colour, float dash);

/// Marks the present values.
void add_present(ImDrawList& list, ImVec2 at);

struct LogCurve {
  std::string name;
  ImU32 colour;
  float dash;  ///< as of add_line
  std::vector<ImVec2> points;
};

/// The key below a chart: the x axis's title, then signs with words, in lines as long as the chart.
class ChartKey {
 public:
  ChartKey(ImDrawList& list, const ChartBox& chart, const std::string& x_title);
  void begin_line();
  /// Writes words with room for a sign before them. Returns the centre of the sign, px.
  ImVec2 entry(const std::string& words);
  /// An entry for each curve.
  void lines(const std::vector<LogCurve>& curves);
  /// Takes the room of chart and key in the panel.
  void end();

 private:
  ImDrawList& list_;
  const ChartBox chart_;
  const float line_;
  float x_, y_;
};

}  // namespace topple::app
