// What the scripts of all charts have in common (gnuplot.h runs them).
#pragma once

#include <string>
#include <vector>

namespace topple::study {

enum class ChartFormat { png, svg };

/// Of labels; of labels in which gnuplot's enhanced mode sees no marks.
inline constexpr const char* k_grey = "textcolor rgb '#444444'";
inline constexpr const char* k_grey_as_is = "noenhanced textcolor rgb '#444444'";
/// Lines at the left and below.
inline constexpr const char* k_open_border = "set border 3 lc rgb '#444444' lw 1\n";

/// What is plotted, each layer on those before, and the data blocks that it needs.
struct Plot {
  std::string data;
  std::vector<std::string> layers;

  /// Block and layer in one; `how`: "with lines".
  void add(const std::string& name, const std::string& rows, const std::string& how);
  /// "plot", the layers, and the end of the line.
  std::string command() const;
};

/// How cells of a map are drawn: told apart in grey by luminance, and by marks.
struct CellStyle {
  const char *fill, *mark;  ///< "#a9cbe4", "pt 7"; "": hatched, no mark
  const char* meaning;
};

/// The sheet that a chart is drawn on, in pixels; the origin is the lower left corner, as in gnuplot.
struct Sheet {
  int width, height;

  /// Begins a script: terminal, fonts, several plots on one sheet.
  std::string begin(ChartFormat format) const;
  /// The whole script that draws `content`.
  std::string script(ChartFormat format, const std::string& content) const;
  /// Text in gnuplot's enhanced mode; `how` as after `set label`.
  std::string label(const std::string& text, double x, double y, const std::string& how = "") const;
  /// A label for each line, the first at y, the next `pitch` below.
  std::string lines(const std::vector<std::string>& texts, double x, double y, double pitch,
                    const std::string& how) const;
  /// A level line; `style` as after `nohead`.
  std::string stroke(double from, double to, double y, const std::string& style) const;
  /// A box as cells look and what it means beside it; x: its left edge, y: its middle.
  std::string swatch(double x, double y, const CellStyle& look) const;
  /// Places the axes of the next plot.
  std::string place(double left, double right, double bottom, double top) const;
  /// A plot that shows only its key; `key` as after `maxrows`. Clears labels and key.
  std::string legend(double left, double right, double bottom, double top, const std::string& key,
                     const Plot& plot) const;
};

/// Bold text in gnuplot's enhanced mode, `scale` over the size of other text.
std::string bold(const std::string& text, double scale);
/// Likewise, not bold.
std::string scaled(const std::string& text, double scale);
/// `text` with gnuplot's enhanced mode seeing no marks in it.
std::string plain(const std::string& text);
/// "12 runs", "3 of 12 runs".
std::string runs_in_words(int run, int of);

/// The block $name of these rows, which end their lines; of one row of NaN where there is none.
std::string data_block(const std::string& name, const std::string& rows, int columns = 2);
/// A row of a block, to six digits.
std::string point_row(double x, double y);

/// Settings of a plot without axes, over 0 to 1 both ways; `also`: more of them.
std::string no_axes(const std::string& also = "");
/// Lines of this colour at the tics of both axes.
std::string grid(const char* colour);

}  // namespace topple::study
