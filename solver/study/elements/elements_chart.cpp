#include "solver/study/elements/elements_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/study/common/gnuplot.h"

namespace topple::study {
namespace {

constexpr int k_width = 1680, k_height = 1846;
constexpr Sheet k_sheet{k_width, k_height};
constexpr int k_columns = 4, k_header = 232;
constexpr int k_left = 96, k_right = 24, k_gap = 78;     // beside and between panels
constexpr int k_above = 66, k_below = 76, k_under = 20;  // titles, tics with their label, blocks

// Colours of Okabe and Ito, told apart with colour-blind eyes and in grey. Without hinges asi and midpoint
// are the same: the thin dashes of asi lie on the broad line of midpoint.
constexpr const char* k_style[] = {
    "lc rgb '#0072b2' lw 2.4 dt 1 pt 7 ps 1.25", "lc rgb '#111111' lw 1.6 dt (6,5) pt 8 ps 1.7",
    "lc rgb '#e69f00' lw 4.2 dt 1 pt 4 ps 2.1", "lc rgb '#009e73' lw 5.4 dt 1 pt 9 ps 2.1",
    "lc rgb '#cc79a7' lw 6.6 dt 1 pt 11 ps 2.1"};
const char* style(std::size_t scheme) {
  return k_style[scheme % std::size(k_style)];
}

constexpr const char* k_guide = "lc rgb '#444444' lw 2 dt (2,5)";
double floored(double error) {
  return std::max(error, k_error_floor);
}

/// Rows of one quantity that have an error.
std::vector<ElementsRow> solved_rows(const ElementsStudy& study, const std::string& quantity) {
  std::vector<ElementsRow> rows;
  for (const ElementsRow& row : study.rows)
    if (row.quantity == quantity && row.error) rows.push_back(row);
  return rows;
}

/// Whole decades around what is drawn.
struct Decades {
  int from, to;
};

template <typename Value>
Decades decades(const std::vector<ElementsRow>& rows, double margin, Value value) {
  double least = 1e300, most = 0;
  for (const ElementsRow& row : rows) {
    least = std::min(least, value(row));
    most = std::max(most, value(row));
  }
  return {static_cast<int>(std::floor(std::log10(least) - margin)),
          static_cast<int>(std::ceil(std::log10(most) + margin))};
}

/// Title, origin and legend, as a plot without axes.
std::string header(const std::string& origin) {
  const double top = k_height;
  Plot keys;
  for (std::size_t s = 0; s < std::size(k_schemes); ++s)
    keys.layers.push_back(fmt::format("NaN with linespoints {} title {} noenhanced", style(s),
                                      gnuplot_quoted(k_schemes[s].about)));
  keys.layers.push_back(std::string("NaN with lines ") + k_guide +
                        " title 'order of convergence in theory, of midpoint elements'");
  const std::vector<std::string> lines{
      origin,
      "CPU time: of the solving thread for one solution (all load steps, or three modes), without reading "
      "the scene; mean of the fastest of repeated samples",
      fmt::format("Error: |computed − reference| / |reference|; below {:.0e} it is drawn there. Without "
                  "hinges ASI and midpoint elements are the same",
                  k_error_floor)};
  return k_sheet.label(
             bold("Error of three beam schemes against the number of elements and against CPU time", 1.5),
             k_left, top - 34) +
         k_sheet.lines(lines, k_left, top - 76, 26, k_grey_as_is) +
         k_sheet.legend(k_left, k_width - k_right, top - 226, top - 146,
                        "2 Left reverse samplen 4 spacing 1.25 width 2", keys) +
         k_open_border + "set tics out scale 0.7,0.4\n" + grid("#cccccc") + "set logscale xy\n";
}

/// Blocks $scheme0, 1, 2 with columns elements per member, CPU time in ms, error.
std::string data_blocks(const std::vector<ElementsRow>& rows) {
  std::string out;
  for (std::size_t s = 0; s < std::size(k_schemes); ++s) {
    std::string list;
    for (const ElementsRow& row : rows)
      if (row.scheme == k_schemes[s].kind)
        list += fmt::format("{} {} {}\n", row.elements_per_member, 1e3 * *row.cpu, floored(*row.error));
    out += data_block(fmt::format("scheme{}", s), list, 3);
  }
  return out;
}

/// Broad lines first: those under the thin ones stay visible where curves coincide.
std::string plot_curves(int column, const std::vector<std::string>& below) {
  Plot plot{.data = "", .layers = below};
  for (std::size_t s = std::size(k_schemes); s-- > 0;)
    plot.layers.push_back(
        fmt::format("$scheme{} using {}:3 with linespoints {} notitle", s, column, style(s)));
  return plot.command();
}

/// A line of the order of convergence, above the greatest of the errors with the fewest elements.
std::string guide(const std::vector<ElementsRow>& rows, int order) {
  double first = 0;
  for (const ElementsRow& row : rows)
    if (row.elements_per_member == k_elements_per_member[0]) first = std::max(first, floored(*row.error));
  const double scale = 1.7 * first * std::pow(k_elements_per_member[0], order);
  return fmt::format("{} * x**(-{}) with lines {} notitle", scale, order, k_guide);
}

std::string y_axis(const Decades& y) {
  const int step = std::max(1, (y.to - y.from + 5) / 6);
  std::string tics;
  for (int e = y.to - (y.to % step + step) % step; e >= y.from; e -= step)
    tics += fmt::format("{}1e{}", tics.empty() ? "" : ",", e);
  return fmt::format("set yrange [1e{}:1e{}]\nset format y '10^{{%T}}'\nset ytics nomirror ({})\n", y.from,
                     y.to, tics);
}

/// Both panels of one quantity; `top` of its title.
std::string column(const ElementsStudy& study, const Quantity& quantity, double left, double right,
                   double top, double panel) {
  const std::vector<ElementsRow> rows = solved_rows(study, quantity.name);
  if (rows.empty()) return "";
  const Decades y = decades(rows, 0.15, [](const ElementsRow& row) { return floored(*row.error); });
  const Decades x = decades(rows, 0.05, [](const ElementsRow& row) { return 1e3 * *row.cpu; });
  const double upper = top - k_above, lower = upper - panel - k_below;
  std::string source = quantity.source;
  if (quantity.uncertainty > 0) source += fmt::format(" ± {:.0e}", quantity.uncertainty);
  std::string out = data_blocks(rows) + y_axis(y);
  out += k_sheet.label(bold(quantity.title, 1.08), left, top - 12);
  out += k_sheet.label(scaled(source, 0.92), left, top - 40, k_grey);
  out += k_sheet.place(left, right, upper - panel, upper);
  out += "set xrange [1.6:80]\nset format x '%g'\nset xtics nomirror (2,4,8,16,32,64)\nset mxtics 1\n";
  out += "set xlabel 'elements per member' offset 0,0.4\n";
  out += left > k_left ? "unset ylabel\n" : "set ylabel 'relative error' offset 1,0\n";
  out += plot_curves(1, {guide(rows, quantity.order)}) + "unset label\n";
  out += k_sheet.place(left, right, lower - panel, lower);
  out += fmt::format("set xrange [1e{}:1e{}]\nset xtics nomirror 1e{},10,1e{}\nset mxtics 10\n", x.from, x.to,
                     x.from, x.to);
  return out + "set xlabel 'CPU time, ms' offset 0,0.4\n" + plot_curves(2, {});
}

}  // namespace

std::string elements_chart(const ElementsStudy& study, const std::string& origin, ChartFormat format) {
  std::vector<const Quantity*> charted;
  for (const Benchmark& benchmark : study.benchmarks)
    for (const Quantity& quantity : benchmark.quantities)
      if (quantity.charted) charted.push_back(&quantity);
  const int blocks = (static_cast<int>(charted.size()) + k_columns - 1) / k_columns;
  const double width = (k_width - k_left - k_right - (k_columns - 1) * k_gap) / double{k_columns};
  const double block = (k_height - k_header) / static_cast<double>(std::max(1, blocks));
  const double panel = (block - k_above - 2 * k_below - k_under) / 2;
  std::string content = header(origin);
  for (std::size_t k = 0; k < charted.size(); ++k) {
    const std::size_t row = k / k_columns, place = k % k_columns;
    const double left = k_left + static_cast<double>(place) * (width + k_gap);
    const double top = k_height - k_header - static_cast<double>(row) * block;
    content += column(study, *charted[k], left, left + width, top, panel);
  }
  return k_sheet.script(format, content);
}

}  // namespace topple::study
