#include "solver/study/common/chart.h"

#include <fmt/format.h>

#include "solver/study/common/gnuplot.h"

namespace topple::study {

std::string Sheet::begin(ChartFormat format) const {
  const bool svg = format == ChartFormat::svg;
  return fmt::format(
      "set terminal {} enhanced size {},{} font '{}' background '#ffffff' dashlength 1\n"
      "set encoding utf8\nset multiplot\n",
      svg ? "svg" : "pngcairo", width, height, svg ? "sans-serif,17" : "DejaVu Sans,13");
}

std::string Sheet::label(const std::string& text, double x, double y, const std::string& how) const {
  return fmt::format("set label {} at screen {:.5f},{:.5f} {}\n", gnuplot_quoted(text), x / width, y / height,
                     how);
}

std::string Sheet::swatch(double x, double y, const std::string& fill, const std::string& mark,
                          const std::string& words) const {
  std::string out = fmt::format(
      "set object rectangle from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} {} fc rgb '{}' lw 0.6\n",
      x / width, (y - 10) / height, (x + 24) / width, (y + 10) / height,
      fill.empty() ? "fs pattern 4 border lc rgb '#888888'" : "fs solid border lc rgb '#888888'",
      fill.empty() ? "#888888" : fill);
  if (!mark.empty()) out += label("", x + 12, y, "point " + mark + " ps 0.9");
  return out + label(words, x + 34, y, "");
}

std::string Sheet::place(double left, double right, double bottom, double top) const {
  return fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n"
      "set tmargin at screen {:.5f}\n",
      left / width, right / width, bottom / height, top / height);
}

std::string bold(const std::string& text, double scale) {
  return fmt::format("{{/:Bold*{} {}}}", scale, text);
}

std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string("_^{}@&~\\").find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

}  // namespace topple::study
