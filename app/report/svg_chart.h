// Charts as SVG text that stands in a page: no files, no scripts, readable without colour.
#pragma once

#include <string>
#include <vector>

namespace topple::app {

/// A curve. Where it runs close to others it is told apart by its number in a ring and its dashes.
struct ChartCurve {
  std::string name;
  std::vector<double> x, y;  ///< same length, x increasing
};

/// A place on a curve that is marked.
struct ChartMark {
  std::size_t curve = 0;
  double x = 0, y = 0;
};

/// Curves over one axis.
struct LineChart {
  std::string x_label, y_label;  ///< with units
  double x_from = 0, x_to = 1, y_from = 0, y_to = 1;
  std::vector<ChartCurve> curves;
  bool numbered = false;         ///< curves carry their numbers, from 1
  std::vector<ChartMark> marks;  ///< drawn as diamonds
  std::vector<double> levels;    ///< horizontal dashed lines
  std::string level_label;       ///< of the first of them
  int height = 200;              ///< px, of 720 wide
};

/// An <svg> element, 720 px wide unless the page scales it. The same chart gives the same text. Curves of
/// very many points keep the least and the greatest value of each pixel.
std::string svg_chart(const LineChart& chart);

/// Line style of curve `index` as attributes of an SVG element, for keys beside a chart.
std::string svg_stroke(std::size_t index);

/// Rows of filled and open dots over one axis: what became of runs.
struct DotChart {
  std::string x_label;
  double x_from = 0, x_to = 1;
  struct Row {
    std::string name;
    std::vector<double> x;
    std::vector<bool> filled;  ///< same length
  };
  std::vector<Row> rows;
};
std::string svg_dots(const DotChart& chart);

/// Text with &, <, > and quotation marks written so that HTML and SVG show them. What is not UTF-8 becomes
/// U+FFFD; other control characters than line breaks and tabs go.
std::string escaped(const std::string& text);

}  // namespace topple::app
