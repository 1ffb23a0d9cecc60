#include <fmt/format.h>

#include <cmath>

#include "bench/engines/results.h"
#include "solver/study/common/gnuplot.h"
#include "solver/study/common/measure.h"

namespace topple::bench {
namespace {

using study::gnuplot_quoted;

constexpr int k_width = 1180, k_height = 800;
constexpr study::Sheet k_sheet{k_width, k_height};
constexpr int k_left = 112, k_right = 24, k_gap = 124, k_bottom = 76, k_header = 252;

// Colours of Okabe and Ito with a mark each; the faint ones are theirs at a third on white.
struct Style {
  const char *line, *faint;
  int mark, dash;
};
constexpr Style k_style[] = {{"#cc79a7", "#eecbdd", 11, 1},
                             {"#d55e00", "#f1c6a8", 7, 1},
                             {"#0072b2", "#a8cfe4", 5, 2},
                             {"#009e73", "#a8dccd", 9, 3},
                             {"#333333", "#bdbdbd", 13, 4}};
constexpr const char* k_dashes[] = {"1", "(14,4)", "(4,4)", "(14,4,3,4)"};

std::string line_style(int e) {
  const Style& style = k_style[e];
  return fmt::format("lc rgb '{}' lw 2.6 dt {} pt {} ps 1.4", style.line, k_dashes[style.dash - 1],
                     style.mark);
}

std::string header(const Results& results) {
  const double top = k_height;
  std::string versions;
  study::Plot keys;
  for (int e = 0; e < static_cast<int>(results.engines.size()); ++e) {
    const Engine& engine = results.engines[e];
    versions += (versions.empty() ? "" : ", ") + engine.name + " " + engine.version;
    keys.layers.push_back(fmt::format("NaN with linespoints {} title {} noenhanced", line_style(e),
                                      gnuplot_quoted(engine.name)));
  }
  return k_sheet.label(study::bold("A rigid block that rocks: error against time, by engine", 1.35), k_left,
                       top - 32) +
         k_sheet.lines(
             {fmt::format(
                  "Uniform, {:g} × {:g} × {:g} m, {:g} kg, friction {:g}. Reference: Housner's block, "
                  "which does not slide or bounce.",
                  k_size[0], k_size[1], k_size[2], k_mass, k_friction),
              versions + fmt::format(" on {}, one core.", study::processor_name()),
              "Faint: every setting of the grid. Lines: Pareto fronts, what no other setting of the engine "
              "beats in time and error."},
             k_left, top - 70, 25, study::k_grey_as_is) +
         k_sheet.place(k_left, k_width - k_right, top - 182, top - 146) + study::no_axes() +
         "set key at graph 0,1 left top horizontal Left reverse samplen 4 width 4\n" + keys.command() +
         "unset label\nunset key\n" + study::k_open_border + "set tics out scale 0.7,0.4\n" +
         study::grid("#cccccc") + "set logscale xy\n";
}

/// A panel over columns `from`..`to` of the sheet. `least`, `most`: ends of the axis of errors; what has none
/// is drawn at `absent`, above, when that is not 0.
template <typename Part>
std::string panel(const Results& results, Part Trial::*part, double unit, double from, double to,
                  const std::string& name, const std::string& title, const std::string& axis, double least,
                  double most, double absent) {
  study::Plot plot;
  for (int e = 0; e < static_cast<int>(results.engines.size()); ++e) {
    std::string points;
    for (const Trial& trial : results.trials) {
      if (trial.engine != e || !(trial.*part).cpu) continue;
      const auto& error = (trial.*part).error;
      if (error || absent > 0)
        points += study::point_row(1e3 * *(trial.*part).cpu, error ? *error / unit : absent);
    }
    plot.add(fmt::format("{}{}", name, e), points,
             fmt::format("with points lc rgb '{}' pt {} ps 0.6 notitle", k_style[e].faint, k_style[e].mark));
  }
  // ours last: on top
  for (int e = static_cast<int>(results.engines.size()) - 1; e >= 0; --e) {
    std::string points;
    for (const Trial* trial : front(results.trials, e, part))
      points += study::point_row(1e3 * *(trial->*part).cpu, *(trial->*part).error / unit);
    plot.add(fmt::format("front_{}{}", name, e), points,
             fmt::format("with linespoints {} notitle", line_style(e)));
  }
  std::string out = plot.data + k_sheet.label(study::bold(title, 1.05), from, k_height - k_header + 26) +
                    k_sheet.place(from, to, k_bottom, k_height - k_header);
  if (absent > 0)
    out +=
        fmt::format("set label 'does not fall, or gave up' at graph 0.99, first {} right offset 0,0.75 {}\n",
                    absent, study::k_grey);
  return out +
         fmt::format(
             "set xrange [0.001:300]\nset format x '%g'\nset xtics nomirror (0.001,0.01,0.1,1,10,100)\nset "
             "mxtics 10\n"
             "set yrange [{}:{}]\nset format y '10^{{%T}}'\nset ytics nomirror 1e-10,100\nset mytics 1\n"
             "set xlabel 'CPU time per simulated second, ms' offset 0,0.2\nset ylabel {} offset 0.4,0\n",
             least, most, gnuplot_quoted(axis)) +
         plot.command() + "unset label\n";
}

}  // namespace

std::string chart(const Results& results, study::ChartFormat format) {
  const double width = (k_width - k_left - k_right - k_gap) / 2.;
  return k_sheet.script(
      format, header(results) +
                  panel(results, &Trial::rocking, k_degree, k_left, k_left + width, "rocking",
                        fmt::format("Let go at half of the critical angle, {:g} s", k_window),
                        "error of the tilt, root mean square, deg", 1e-10, 200, 0) +
                  panel(results, &Trial::falling, 1., k_left + width + k_gap, k_width - k_right, "falling",
                        "Shaken at 2 Hz: worst of 690, 695, 700 gal", "error of the time of passing 45°, s",
                        1e-10, 10, 6));
}

}  // namespace topple::bench
