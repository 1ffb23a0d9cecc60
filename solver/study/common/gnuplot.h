// Charts by gnuplot, which is needed when a chart is drawn and not before.
#pragma once

#include <stdexcept>
#include <string>

namespace topple::study {

/// gnuplot is missing or failed. what() is one line.
struct ChartError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What gnuplot writes to its standard output for `script`, which sets the terminal and no output file.
/// Settings of the user (~/.gnuplot) are left out. Throws ChartError.
std::string run_gnuplot(const std::string& script);

/// `text` as a string literal of gnuplot. Line breaks become blanks. Where gnuplot would read marks of its
/// enhanced mode in it, say `noenhanced` beside it.
std::string gnuplot_quoted(const std::string& text);

}  // namespace topple::study
