#include "solver/study/validate/toss_chart.h"

#include <fmt/format.h>

#include <algorithm>

namespace topple::study {
namespace {

constexpr int k_sheet_width = 1240, k_sheet_height = 640;
constexpr double k_left = 84, k_right = 20, k_column = k_sheet_width / 3.;  // px
struct Look {
  const char *name, *colour;
};
constexpr Look k_fitted{"fitted", "#0072b2"}, k_as_published{"as published", "#d98a00"};

/// Median and 90 % over time of one quantity, in a unit.
void add_errors(Plot& plot, const TossScores& scores, const Look& look, const char* block,
                Quantiles TossScores::Instant::*which, double unit) {
  std::string middle, ninety;
  for (const TossScores::Instant& at : scores.over_time) {
    middle += point_row(at.time, (at.*which).median * unit);
    ninety += point_row(at.time, (at.*which).ninetieth * unit);
  }
  plot.add(std::string(block) + "m", middle,
           fmt::format("with linespoints pt 7 lw 3 lc rgb '{}' notitle", look.colour));
  plot.add(std::string(block) + "n", ninety,
           fmt::format("with linespoints pt 6 lw 1.6 dt (8,5) lc rgb '{}' notitle", look.colour));
}

void add_ends(Plot& plot, const TossOutcomes& outcomes, const Look& look, const char* block) {
  std::vector<double> places;
  for (const std::optional<TossErrors>& one : outcomes)
    if (one) places.push_back(one->place);
  std::ranges::sort(places);
  std::string rows;
  for (std::size_t n = 0; n < places.size(); ++n)
    rows += point_row(1e3 * places[n], static_cast<double>(n + 1) / static_cast<double>(outcomes.size()));
  plot.add(block, rows, fmt::format("with steps lw 3 lc rgb '{}' title '{}'", look.colour, look.name));
}

}  // namespace

std::string toss_chart(const TossFit& fit, const TossResults& results, const std::string& origin,
                       ChartFormat format) {
  const Sheet sheet{k_sheet_width, k_sheet_height};
  const double top = sheet.height, plot_top = top - 190, bottom = 76;
  const auto panel = [&](int column, const char* heading, const char* x, const char* y) {
    const double left = k_left + column * k_column;
    return sheet.label(bold(heading, 1), left, plot_top + 24) +
           sheet.place(left, left - k_left + k_column - k_right, bottom, plot_top) + k_open_border +
           fmt::format(
               "set xlabel '{}' offset 0,0.3\nset ylabel '{}' offset 1.5,0\nset xtics nomirror\nset ytics "
               "nomirror\n{}",
               x, y, grid("#dddddd"));
  };
  std::string out =
      sheet.label(bold("A tossed cube: computed from its first row against measured", 1.5), k_left,
                  top - 34) +
      sheet.lines(
          {fmt::format(
               "{} tosses; friction and restitution fitted{}: {:g}, {:g}; as published: {:g}, {:g}",
               results.of_fitted.tosses,
               results.fitted_here ? ", each toss by nine tenths" : fmt::format(" on {} others", fit.tosses),
               fit.contact.friction, fit.contact.restitution, k_published.friction, k_published.restitution),
           fmt::format("Data: Pfrommer, Halm, Posa, ContactNets, CoRL 2020 (BSD-3-Clause); their offset of "
                       "{:.1f} mm is taken out",
                       1e3 * fit.offset),
           origin},
          k_left, top - 74, 24, k_grey_as_is);
  out += panel(0, "Position: median, dashed 90 %", "time since the first row, s", "error, mm");
  out += "set xrange [0:1.05]\nset yrange [0:*]\nunset key\n";
  Plot position;
  add_errors(position, results.of_fitted, k_fitted, "pf", &TossScores::Instant::position, 1e3);
  add_errors(position, results.of_published, k_as_published, "pp", &TossScores::Instant::position, 1e3);
  out += position.data + position.command() + "unset label\n";
  out += panel(1, "Angle: median, dashed 90 %", "time since the first row, s", "error, deg") +
         "set yrange [0:*]\n";
  Plot angle;
  add_errors(angle, results.of_fitted, k_fitted, "af", &TossScores::Instant::angle, 1);
  add_errors(angle, results.of_published, k_as_published, "ap", &TossScores::Instant::angle, 1);
  out += angle.data + angle.command() + "unset label\n";
  out += panel(2, "Last place", "error, mm", "share of tosses that end within") +
         "set xrange [0:150]\nset yrange [0:1.02]\nset key right bottom Right noreverse\n";
  Plot ends;
  add_ends(ends, results.fitted, k_fitted, "ef");
  add_ends(ends, results.published, k_as_published, "ep");
  out += ends.data + ends.command() + "unset label\n";
  return sheet.script(format, out);
}

}  // namespace topple::study
