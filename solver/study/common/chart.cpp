#include "solver/study/common/chart.h"

#include <fmt/format.h>

#include <utility>

#include "solver/study/common/gnuplot.h"

namespace topple::study {

void Plot::add(const std::string& name, const std::string& rows, const std::string& how) {
  data += data_block(name, rows);
  layers.push_back("$" + name + " " + how);
}

std::string Plot::command() const {
  return fmt::format("plot {}\n", fmt::join(layers, ", "));
}

std::string Sheet::begin(ChartFormat format) const {
  const bool svg = format == ChartFormat::svg;
  return fmt::format(
      "set terminal {} enhanced size {},{} font '{}' background '#ffffff' dashlength 1\n"
      "set encoding utf8\nset multiplot\n",
      svg ? "svg" : "pngcairo", width, height, svg ? "sans-serif,17" : "DejaVu Sans,13");
}

std::string Sheet::script(ChartFormat format, const std::string& content) const {
  return begin(format) + content + "unset multiplot\n";
}

std::string Sheet::label(const std::string& text, double x, double y, const std::string& how) const {
  return fmt::format("set label {} at screen {:.5f},{:.5f} {}\n", gnuplot_quoted(text), x / width, y / height,
                     how);
}

std::string Sheet::lines(const std::vector<std::string>& texts, double x, double y, double pitch,
                         const std::string& how) const {
  std::string out;
  for (const std::string& text : texts) out += label(text, x, std::exchange(y, y - pitch), how);
  return out;
}

std::string Sheet::stroke(double from, double to, double y, const std::string& style) const {
  return fmt::format("set arrow from screen {0:.5f},{2:.5f} to screen {1:.5f},{2:.5f} nohead {3}\n",
                     from / width, to / width, y / height, style);
}

std::string Sheet::swatch(double x, double y, const CellStyle& look) const {
  std::string out = fmt::format(
      "set object rectangle from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} {} fc rgb '{}' lw 0.6\n",
      x / width, (y - 10) / height, (x + 24) / width, (y + 10) / height,
      *look.fill ? "fs solid border lc rgb '#888888'" : "fs pattern 4 border lc rgb '#888888'",
      *look.fill ? look.fill : "#888888");
  if (*look.mark) out += label("", x + 12, y, fmt::format("point {} ps 0.9", look.mark));
  return out + label(look.meaning, x + 34, y);
}

std::string Sheet::place(double left, double right, double bottom, double top) const {
  return fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n"
      "set tmargin at screen {:.5f}\n",
      left / width, right / width, bottom / height, top / height);
}

std::string Sheet::legend(double left, double right, double bottom, double top, const std::string& key,
                          const Plot& plot) const {
  return place(left, right, bottom, top) + no_axes() + "set key at graph 0,1 left top vertical maxrows " +
         key + "\n" + plot.command() + "unset label\nunset key\n";
}

std::string bold(const std::string& text, double scale) {
  return fmt::format("{{/:Bold*{} {}}}", scale, text);
}

std::string scaled(const std::string& text, double scale) {
  return fmt::format("{{/*{} {}}}", scale, text);
}

std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string("_^{}@&~\\").find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string runs_in_words(int run, int of) {
  return run == of ? fmt::format("{} runs", of) : fmt::format("{} of {} runs", run, of);
}

std::string data_block(const std::string& name, const std::string& rows, int columns) {
  std::string out = "$" + name + " << END\n" + rows;
  if (rows.empty())
    for (int k = 1; k <= columns; ++k) out += k < columns ? "NaN " : "NaN\n";
  return out + "END\n";
}

std::string point_row(double x, double y) {
  return fmt::format("{:.6g} {:.6g}\n", x, y);
}

std::string no_axes(const std::string& also) {
  return "unset border\nunset tics\n" + also + "set xrange [0:1]\nset yrange [0:1]\n";
}

std::string grid(const char* colour) {
  return fmt::format("set grid xtics ytics lc rgb '{}' lw 0.8 dt 1\n", colour);
}

}  // namespace topple::study
