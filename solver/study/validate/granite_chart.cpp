#include "solver/study/validate/granite_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace topple::study {
namespace {

constexpr int k_sheet_width = 1240, k_sheet_height = 1500;
constexpr double k_left = 92, k_right = 30, k_column = k_sheet_width / 2.;  // px
constexpr const char *k_measured = "#a3203a", *k_computed = "#0072b2", *k_baseline = "#9aa5b1";
constexpr std::size_t k_groups = 9;        // of tests with similar velocity
constexpr double k_least_velocity = 0.02;  // m/s, of the axis

struct Box {
  double left, right, bottom, top;
};

/// Tests by velocity in groups of about the same size, from the first that could fall.
std::vector<std::vector<std::size_t>> groups_of(const std::vector<GraniteTest>& tests) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < tests.size(); ++i)
    if (tests[i].peak_velocity >= k_least_velocity) order.push_back(i);
  std::ranges::sort(order, {}, [&](std::size_t i) { return tests[i].peak_velocity; });
  std::vector<std::vector<std::size_t>> groups(std::min(k_groups, order.size()));
  for (std::size_t n = 0; n < order.size(); ++n) groups[n * groups.size() / order.size()].push_back(order[n]);
  return groups;
}

class GraniteChart {
 public:
  GraniteChart(const std::vector<GraniteTest>& tests, const GraniteFit& fit, const GraniteResults& results)
      : tests_(tests), fit_(fit), results_(results), sheet_{k_sheet_width, k_sheet_height} {}

  std::string script(const std::string& origin, ChartFormat format) const {
    const double top = sheet_.height;
    const std::string how =
        results_.fitted_here
            ? fmt::format("{} tests; each is predicted by what was fitted on the other nine tenths",
                          tests_.size())
            : fmt::format("{} tests, predicted by what was fitted on {} others", tests_.size(), fit_.tests);
    std::string out =
        sheet_.label(bold("Two rocks of granite on a shaking table: which fall", 1.5), k_left, top - 34) +
        sheet_.lines(
            {how, "Tests of 2021: Z. Chen and others, virtual_shake_robot_pybullet (GPL-3.0)", origin},
            k_left, top - 74, 24, k_grey_as_is);
    for (std::size_t rock = 0; rock < k_rocks; ++rock) out += column(rock);
    return sheet_.script(format, out);
  }

 private:
  std::string column(std::size_t k) const {
    const double left = static_cast<double>(k) * k_column + k_left,
                 right = left - k_left + k_column - k_right;
    const RockResults& rock = results_.rocks[k];
    const RockDistribution& at = fit_.rocks[k].fitted;
    const double top = sheet_.height;
    std::string out =
        sheet_.label(bold(rocks()[k].name, 1.2), left, top - 170) +
        sheet_.lines({fmt::format("edges {:.0f}, {:.0f} mm ± {:.0f} %, factor of impacts {:.2f} ± {:.2f}",
                                  1e3 * at.median.left, 1e3 * at.median.right, 100 * at.edge_scatter,
                                  at.median.restitution, at.restitution_scatter),
                      fmt::format("Brier score {:.3f}; {} missed, {:.0f} to be expected", rock.scores.brier,
                                  rock.scores.count - rock.scores.right, rock.expected_missed)},
                     left, top - 198, 22, k_grey_as_is);
    out += shares(rock, {left + 120, right - 50, top - 430, top - 262});
    out += fragility(k, {left, right, top - 930, top - 530});
    out += reliability(rock, {left, right, top - 1420, top - 1040});
    return out;
  }

  std::string shares(const RockResults& rock, const Box& box) const {
    struct Bar {
      const char* name;
      const Scores& of;
      const char* colour;
    };
    const Bar bars[] = {{"scattered block", rock.scores, k_computed},
                        {"plain Housner block", rock.plain.scores, k_baseline},
                        {"threshold of velocity", rock.threshold.scores, k_baseline},
                        {"never falls", rock.never.scores, k_baseline}};
    constexpr double k_from = 0.5;
    std::string out =
        sheet_.place(box.left, box.right, box.bottom, box.top) +
        fmt::format(
            "unset logscale\nset xrange [{}:1]\nset yrange [-0.6:3.6]\nset xtics 0.1 nomirror "
            "format '%.1f'\nunset ytics\nset border 1 lc rgb '#444444' lw 1\nset xlabel 'share "
            "of tests predicted rightly, 95 %' offset 0,0.3\nunset ylabel\nset grid xtics lc rgb "
            "'#dddddd' lw 0.8\nunset key\n",
            k_from);
    Plot plot;
    double y = 3;
    for (const Bar& bar : bars) {
      const std::string block = fmt::format("bar{:.0f}", y);
      plot.data += data_block(block,
                              fmt::format("{:.5f} {:.1f} {:.5f} {:.5f}\n", bar.of.share(), y,
                                          std::max(bar.of.interval.low, k_from), bar.of.interval.high),
                              4);
      plot.layers.push_back(fmt::format(
          "${} using ({}):2:({}):1:($2-0.32):($2+0.32) with boxxyerror fs solid 1 noborder lc rgb '{}' "
          "notitle",
          block, k_from, k_from, bar.colour));
      plot.layers.push_back(
          fmt::format("${} using 1:2:3:4 with xerrorbars pt 0 lw 2 lc rgb '#1c1f23' notitle", block));
      const double height = box.bottom + (y + 0.6) / 4.2 * (box.top - box.bottom);
      out += sheet_.label(bar.name, box.left - 8, height, "right");
      out += sheet_.label(fmt::format("{:.1f} %", 100 * bar.of.share()), box.right + 8, height, "left");
      y -= 1;
    }
    return out + plot.data + plot.command() + "unset label\n";
  }

  static void add_curve(Plot& plot, const char* name, const Fragility& curve, const char* colour,
                        const char* title, const char* dash) {
    if (!curve.fit) return;
    std::string rows;
    for (int n = 0; n <= 120; ++n) {
      const double at = k_least_velocity * std::pow(50., n / 120.);
      rows += point_row(at, curve.fit->probability(at));
    }
    plot.add(name, rows, fmt::format("with lines lw 3 dt {} lc rgb '{}' title '{}'", dash, colour, title));
  }

  std::string fragility(std::size_t k, const Box& box) const {
    const RockResults& rock = results_.rocks[k];
    std::string out =
        sheet_.label(bold("Share that fell over the table's greatest velocity", 1), box.left, box.top + 24) +
        sheet_.place(box.left, box.right, box.bottom, box.top) +
        "set logscale x\nset xrange [0.02:1]\nset yrange [-0.02:1.02]\nset xtics (0.02,0.05,0.1,0.2,0.5,1) "
        "nomirror "
        "format '%g'\nset ytics 0.2 nomirror\nset xlabel 'greatest velocity of the table, m/s' offset 0,0.3\n"
        "set ylabel 'share that fell' offset 1.2,0\nset border 3 lc rgb '#444444' lw 1\nset grid ytics lc "
        "rgb "
        "'#dddddd' lw 0.8\nset key right bottom Right noreverse samplen 2 spacing 1.2\n";
    Plot plot;
    add_curve(plot, "measured_curve", rock.measured, k_measured, "measured", "1");
    add_curve(plot, "computed_curve", rock.computed, k_computed, "computed", "(12,6)");
    std::string measured, computed;
    for (const auto& group : groups_of(tests_)) {
      double log_velocity = 0, sum = 0;
      int fell = 0;
      for (const std::size_t i : group) {
        log_velocity += std::log(tests_[i].peak_velocity);
        sum += rock.forecasts[i].probability;
        fell += rock.forecasts[i].measured;
      }
      const auto count = static_cast<double>(group.size());
      const double at = std::exp(log_velocity / count);
      const Interval share = wilson(fell, static_cast<int>(group.size()));
      measured += fmt::format("{:.5g} {:.5f} {:.5f} {:.5f}\n", at, fell / count, share.low, share.high);
      computed += point_row(at * 1.03, sum / count);
    }
    plot.data += data_block("measured", measured, 4);
    plot.layers.push_back(fmt::format(
        "$measured with yerrorbars pt 5 ps 1 lw 1.6 lc rgb '{}' title 'like velocities, 95 %'", k_measured));
    plot.add("computed", computed,
             fmt::format("with points pt 7 ps 1.2 lc rgb '{}' title 'the same, computed'", k_computed));
    return out + plot.data + plot.command() + "unset label\nunset logscale\n";
  }

  std::string reliability(const RockResults& rock, const Box& box) const {
    std::string out =
        sheet_.label(bold("Reliability: share that fell at a probability", 1), box.left, box.top + 24) +
        sheet_.place(box.left, box.right, box.bottom, box.top) +
        "set xrange [0:1]\nset yrange [-0.02:1.02]\nset xtics 0.2 nomirror format '%.1f'\nset ytics 0.2 "
        "nomirror\n"
        "set xlabel 'computed probability' offset 0,0.3\nset ylabel 'share that fell' offset 1.2,0\n"
        "set key right bottom Right noreverse samplen 2 spacing 1.2\n";
    Plot plot;
    plot.add("even", "0 0\n1 1\n", "with lines lw 1.5 dt (4,4) lc rgb '#444444' title 'as told'");
    std::string rows;
    for (const ReliabilityBin& bin : rock.scores.reliability) {
      if (bin.count == 0) continue;
      const Interval share = wilson(bin.yes, bin.count);
      const double height = static_cast<double>(bin.yes) / bin.count;
      rows += fmt::format("{:.5f} {:.5f} {:.5f} {:.5f}\n", bin.mean, height, share.low, share.high);
      const bool far_right = bin.mean > 0.85;
      out += sheet_.label(fmt::format("{}", bin.count),
                          box.left + bin.mean * (box.right - box.left) + (far_right ? -12 : 12),
                          box.bottom + (height + 0.02) / 1.04 * (box.top - box.bottom),
                          far_right ? "right front" : "left front");
    }
    plot.data += data_block("bins", rows, 4);
    plot.layers.push_back(
        fmt::format("$bins with yerrorbars pt 7 ps 1.3 lw 1.8 lc rgb '{}' title 'tests (their number), 95 %'",
                    k_computed));
    return out + plot.data + plot.command() + "unset label\n";
  }

  const std::vector<GraniteTest>& tests_;
  const GraniteFit& fit_;
  const GraniteResults& results_;
  Sheet sheet_;
};

}  // namespace

std::string granite_chart(const std::vector<GraniteTest>& tests, const GraniteFit& fit,
                          const GraniteResults& results, const std::string& origin, ChartFormat format) {
  return GraniteChart(tests, fit, results).script(origin, format);
}

}  // namespace topple::study
