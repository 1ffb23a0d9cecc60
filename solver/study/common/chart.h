// What the scripts of all charts have in common (gnuplot.h runs them).
#pragma once

#include <string>

namespace topple::study {

enum class ChartFormat { png, svg };

/// The sheet that a chart is drawn on, in pixels; the origin is the lower left corner, as in gnuplot.
struct Sheet {
  int width, height;

  /// Begins a script: terminal, fonts, several plots on one sheet.
  std::string begin(ChartFormat format) const;
  /// Text in gnuplot's enhanced mode; `how` as after `set label`.
  std::string label(const std::string& text, double x, double y, const std::string& how) const;
  /// A box filled with a colour, or hatched where `fill` is empty, with a mark in it where `mark` ("pt 7") is
  /// not, and words beside it; x: its left edge, y: its middle.
  std::string swatch(double x, double y, const std::string& fill, const std::string& mark,
                     const std::string& words) const;
  /// Places the axes of the next plot.
  std::string place(double left, double right, double bottom, double top) const;
};

/// Bold text in gnuplot's enhanced mode, `scale` over the size of other text.
std::string bold(const std::string& text, double scale);

/// `text` with gnuplot's enhanced mode seeing no marks in it.
std::string plain(const std::string& text);

}  // namespace topple::study
