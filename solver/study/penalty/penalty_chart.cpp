#include "solver/study/penalty/penalty_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "solver/contact/contact_law.h"
#include "solver/study/common/gnuplot.h"
#include "solver/study/penalty/impact.h"

namespace topple::study {
namespace {

using Case = PenaltyRow::Case;

constexpr int k_width = 1680, k_height = 1466;
constexpr Sheet k_sheet{k_width, k_height};
constexpr int k_columns = 3, k_header = 276, k_left = 92, k_right = 30, k_gap = 104;
constexpr int k_above = 64, k_below = 92;  // titles; tics with their label
constexpr int k_most_groups = 4;           // drawn; the table has all

// Colours of Okabe and Ito, told apart with colour-blind eyes and, by marks and dashes, in grey.
constexpr const char* k_colour[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9"};
constexpr const char* k_dash[] = {"1", "(12,5)", "(4,4)", "(12,4,3,4)", "(8,3)"};
constexpr int k_mark[] = {7, 5, 9, 13, 11}, k_styles = std::size(k_mark);
constexpr const char* k_bound_line = "lc rgb '#111111' lw 1.6 dt (3,4)";

std::string line_style(int k, double width) {
  return fmt::format("lc rgb '{}' lw {} dt {}", k_colour[k % k_styles], width, k_dash[k % k_styles]);
}

std::string mark_style(int k) {
  return fmt::format("lc rgb '{}' pt {} ps 1.3 lw 1.8", k_colour[k % k_styles], k_mark[k % k_styles]);
}

std::string both_style(int k) {
  return fmt::format("{} pt {} ps 1.3", line_style(k, 1.4), k_mark[k]);
}

double in_kgf(double alpha) {
  return alpha / k_standard_gravity;
}

struct Point {
  double x, y;
};

/// Of a data block; what a logarithmic axis cannot show is left out by the caller.
std::string rows_of(const std::vector<Point>& points) {
  std::string rows;
  for (const Point& point : points) rows += fmt::format("{} {}\n", point.x, point.y);
  return rows;
}

/// As many names as there is room for.
std::string shown_names(const BodyGroup& group) {
  constexpr std::size_t k_most = 24;
  if (group.names.size() <= k_most) return plain(group.names);
  const std::string first = group.names.substr(0, group.names.find(", "));
  return plain(first) + (group.bodies.size() > 1 ? fmt::format(" and {} more", group.bodies.size() - 1) : "");
}

/// "3.6·10^{-8} µm" for gnuplot's enhanced mode.
std::string micrometres(double way) {
  const double value = 1e6 * way;
  if (!(value > 0)) return "0 µm";
  const int power = static_cast<int>(std::floor(std::log10(value)));
  if (power >= -2 && power <= 1) return fmt::format("{:.2g} µm", value);
  return fmt::format("{:.1f}·10^{{{}}} µm", value / std::pow(10., power), power);
}

/// Whole decades around positive numbers.
std::string decades(const std::string& axis, double least, double most) {
  return fmt::format("set {}range [{}:{}]\n", axis, std::pow(10., std::floor(std::log10(least))),
                     std::pow(10., std::ceil(std::log10(most))));
}

std::string log_axis(const char* which, const char* tic_format) {
  return fmt::format("set logscale {0}\nset format {0} '{1}'\nset m{0}tics 10\n", which, tic_format);
}

/// Sees the study, knows its place on the sheet.
class Chart {
 public:
  Chart(const PenaltyStudy& study, const Advice& advice) : study_(study), advice_(advice) {
    for (int g = 0; g < static_cast<int>(study.groups.size()); ++g)
      if (study.groups[g].obstacle.empty() && static_cast<int>(drawn_.size()) < k_most_groups)
        drawn_.push_back(g);
    decisive_ =
        *std::max_element(drawn_.begin(), drawn_.end(), [&](int a, int b) { return tips(a) < tips(b); });
  }

  std::string script(const std::string& origin, ChartFormat format) {
    return k_sheet.script(
        format, header(origin) + force() + depth() + creep() + restitution() + frequency() + errors());
  }

 private:
  const BodyGroup& group(int g) const { return study_.groups[g]; }
  /// alpha that steady tipping asks for, of bodies that tip before they slide.
  double tips(int g) const {
    const Standing& theory = group(g).theory;
    return theory.rigid_limit() <= theory.grip * study_.law.friction ? group(g).steady_alpha : 0;
  }

  template <typename Choose>
  std::string rows(Case kind, Choose choose) const {
    std::vector<Point> found;
    for (const PenaltyRow& row : study_.rows)
      if (row.kind == kind && row.computed) choose(row, found);
    return rows_of(found);
  }

  std::string header(const std::string& origin) const {
    std::string title = "Penalty contact of " + plain(study_.scene) + ": ";
    title += advice_.alpha       ? "recommended α = " + kgf_text(*advice_.alpha)
             : advice_.undecided ? "no α to recommend yet, runs are missing"
                                 : "no α to recommend";
    if (advice_.alpha && advice_.time_step && !advice_.resolved)
      title += fmt::format(", with {} = {:.2g} ms", plain("time_step"), 1e3 * *advice_.time_step);
    const std::string runs = study_.run == study_.of ? "" : ", " + runs_in_words(study_.run, study_.of);
    return k_sheet.label(bold(title, 1.5), k_left, k_height - 34) +
           k_sheet.lines({study_.title, settings(), origin + runs + ". Bodies stand alone on the floor"},
                         k_left, k_height - 76, 26, k_grey_as_is) +
           k_sheet.lines(in_short(), k_left, k_height - 160, 26, "noenhanced") +
           k_sheet.place(k_left, k_width - k_right, k_height - k_header, k_height - 1) +
           no_axes("unset key\n") + "plot NaN notitle\n";
  }

  std::string settings() const {
    const ContactLaw& law = study_.law;
    const std::string smoothing =
        traits(law).has_restitution
            ? fmt::format("restitution {:g}, normal_speed {:g} m/s", law.restitution, law.normal_speed)
            : fmt::format("slip_speed {:g} m/s", law.slip_speed);
    return fmt::format("Law {}, α = {}, q = {:g}, friction {:g}, {}, time_step {}", traits(law).word,
                       kgf_text(law.alpha), law.q, law.friction, smoothing,
                       study_.time_step > 0 ? fmt::format("{:.3g} ms", 1e3 * study_.time_step) : "auto");
  }

  /// What the recommended alpha and the scene's do, two lines each at most.
  std::vector<std::string> in_short() const {
    std::vector<std::string> lines;
    const auto add = [&lines](std::string line, const std::vector<std::string>& parts) {
      constexpr std::size_t k_most = 172;
      int begun = 1;
      for (const std::string& part : parts) {
        if (line.size() + part.size() > k_most) {
          if (++begun > 2) break;
          lines.push_back(std::exchange(line, "     "));
        }
        line += part + (&part == &parts.back() ? "" : "; ");
      }
      lines.push_back(begun > 2 ? line + "…" : line);
    };
    if (advice_.alpha) add(kgf_text(*advice_.alpha) + ": ", verdict(study_, *advice_.alpha).kept);
    const AlphaVerdict& scene = advice_.of_scene;
    const std::string begin = "The scene's " + kgf_text(scene.alpha) + ": ";
    if (!scene.missed.empty())
      add(begin + "not within bounds: ", scene.missed);
    else
      lines.push_back(begin + (scene.complete ? "within all bounds" : "runs are missing"));
    return lines;
  }

  /// Title, source and axes of panel k, 0..5; the axes come clean.
  std::string panel(int k, const std::string& title, const std::string& source) const {
    const double width = (k_width - k_left - k_right - (k_columns - 1) * k_gap) / double{k_columns};
    const double height = (k_height - k_header) / 2.;
    const int row = k / k_columns;
    const double left = k_left + (k % k_columns) * (width + k_gap);
    const double top = k_height - k_header - row * height;
    return std::string("unset label\nunset logscale\nunset arrow\n") + k_open_border +
           "set tics out nomirror scale 0.7,0.4\nset xtics nomirror autofreq\n"
           "set ytics nomirror autofreq\nset mxtics default\nset mytics default\nset format x '%g'\nset "
           "format y '%g'\n" +
           grid("#d4d4d4") + "set key Left reverse samplen 3 spacing 1.2 font ',11.5'\n" +
           k_sheet.label(bold(title, 1.08), left, top - 14) +
           k_sheet.label(scaled(source, 0.92), left, top - 40, k_grey) +
           k_sheet.place(left, left + width, top - height + k_below, top - k_above);
  }

  /// A line up the panel at x, between two heights of it, and what it is at a third one.
  static std::string upright(double x, double from, double to, const char* style, const char* text,
                             double text_at, const char* how) {
    return fmt::format(
        "set arrow from first {0},graph {1} to first {0},graph {2} nohead {3}\n"
        "set label '{4}' at first {0},graph {5} {6} font ',11'\n",
        x, from, to, style, text, text_at, how);
  }

  /// alpha across, with the scene's and the recommended one as lines between two heights of the panel.
  std::string alpha_axis(double from, double to, double labels) const {
    const double least = in_kgf(study_.alphas.front()) / 1.5, most = in_kgf(study_.alphas.back()) * 1.5;
    std::string out = fmt::format(
        "set logscale x\nset xrange [{}:{}]\nset format x '10^{{%T}}'\nset mxtics 10\n"
        "set xlabel 'penalty coefficient α, kgf' offset 0,0.3\n",
        least, most);
    const auto mark = [&](double alpha, const char* text, double above, const char* style) {
      const double x = in_kgf(alpha);
      const bool right = x > std::sqrt(least * most);
      return upright(x, from, to, style, text, labels + above,
                     right ? "right offset -0.5,0" : "left offset 0.5,0");
    };
    out += mark(study_.law.alpha, "scene", 0.03, "lc rgb '#111111' lw 1.6 dt (10,5)");
    if (advice_.alpha && std::abs(*advice_.alpha / study_.law.alpha - 1) > 1e-6)
      out += mark(*advice_.alpha, "recommended", 0.08, "lc rgb '#111111' lw 1.8 dt 1");
    return out;
  }

  std::string level(double y, const std::string& text) const {
    return fmt::format(
        "set arrow from graph 0,first {0} to graph 1,first {0} nohead {1}\n"
        "set label {2} at graph 0.015,first {0} left offset 0,0.6 font ',11'\n",
        y, k_bound_line, gnuplot_quoted(text));
  }

  /// 200 values of theory over the range of alpha.
  template <typename Value>
  std::vector<Point> over_alpha(Value value) const {
    std::vector<Point> line;
    const double from = std::log(study_.alphas.front() / 1.5), to = std::log(study_.alphas.back() * 1.5);
    ContactLaw law = study_.law;
    for (int k = 0; k <= 200; ++k) {
      law.alpha = std::exp(from + (to - from) * k / 200);
      if (const double y = value(law); y > 0) line.push_back({in_kgf(law.alpha), y});
    }
    return line;
  }

  std::string force() const {
    std::set<double> drawn;
    for (const PenaltyRow& row : study_.rows)
      if (row.kind == Case::force) drawn.insert(row.law.q);
    const bool kilo = study_.law.alpha >= 1e4;  // numbers of five digits have no room
    const double unit = kilo ? 1e3 : 1;
    Plot plot;
    int k = 0;
    for (const double q : drawn) {
      const bool own = q == study_.law.q;
      const std::string line = rows(Case::force, [q, unit](const PenaltyRow& row, auto& out) {
        if (row.law.q == q) out.push_back({*row.at, *row.computed / unit});
      });
      plot.add(fmt::format("force{}", k), line,
               fmt::format("with lines {} title 'q = {:g}{}'", line_style(k, own ? 4 : 2), q,
                           own ? " (scene)" : ""));
      ++k;
    }
    std::vector<Point> rest;
    for (const int g : drawn_) {
      const double depth = rest_depth(group(g).theory, study_.law);
      rest.push_back({1 - depth, study_.law.alpha / unit * std::pow(depth, study_.law.q)});
    }
    plot.add("rest", rows_of(rest), "with points lc rgb '#111111' pt 6 ps 1.9 lw 2 title 'at rest'");
    return plot.data +
           panel(0, "Force of a contact against its depth",
                 fmt::format("α (1 − l/L)^q of Eq. 2, α = {} = {:.4g} N", kgf_text(study_.law.alpha),
                             study_.law.alpha)) +
           fmt::format("set xrange [0:1]\nset yrange [0:{}]\nset key top right\n",
                       1.02 * study_.law.alpha / unit) +
           "set xlabel 'distance of the centre lines l / L' offset 0,0.3\n" +
           fmt::format("set ylabel 'force, {}' offset 1,0\n", kilo ? "kN" : "N") + plot.command();
  }

  std::string depth() const {
    Plot plot;
    double least = k_depth_bound, most = k_depth_bound;
    for (int k = 0; k < static_cast<int>(drawn_.size()); ++k) {
      const int g = drawn_[k];
      const std::vector<Point> line =
          over_alpha([&](const ContactLaw& law) { return rest_depth(group(g).theory, law); });
      least = std::min(least, line.back().y);
      most = std::max(most, line.front().y);
      const std::string settled = rows(Case::depth, [g](const PenaltyRow& row, auto& out) {
        if (row.group == g && *row.computed > 0) out.push_back({in_kgf(row.law.alpha), *row.computed});
      });
      const std::string names = shown_names(group(g));
      plot.add(
          fmt::format("theory{}", k), rows_of(line),
          fmt::format("with lines {} title {}", line_style(k, 2), gnuplot_quoted(names + ": rigid, theory")));
      plot.add(fmt::format("depth{}", k), settled,
               fmt::format("with points {} title {}", mark_style(k), gnuplot_quoted(names + ": settled")));
    }
    return plot.data +
           panel(1, "Depth at rest", "deepest contact; theory: (W / n α)^{1/q} where evenly loaded") +
           alpha_axis(0, 1, 0.12) + level(k_depth_bound, "bound 1 %") + decades("y", least, most) +
           log_axis("y", "10^{%T}") + "set key bottom left\nset ylabel 'depth 1 − l / L' offset 1,0\n" +
           plot.command();
  }

  std::string creep() const {
    constexpr double k_least = 1e-15;  // m; below is drawn there
    Plot plot;
    std::string names, values;
    double most = k_creep_bound;
    for (int k = 0; k < static_cast<int>(drawn_.size()); ++k) {
      std::vector<Point> list;
      for (const PenaltyRow& row : study_.rows) {
        if (row.kind != Case::creep || row.group != drawn_[k]) continue;
        const double y = place_of(row.law.kind, k);
        const double shown = row.computed ? std::max(*row.computed, k_least) : k_least;
        if (row.computed) list.push_back({1e6 * shown, y});
        most = std::max(most, shown);
        const std::string text = row.computed ? micrometres(*row.computed) : row.status;
        values += fmt::format("set label {} at first {},first {} {} offset 0,0.9 font ',11'\n",
                              gnuplot_quoted(text), 1e6 * shown, y, shown > k_creep_bound ? "right" : "left");
      }
      plot.add(fmt::format("creep{}", k), rows_of(list),
               fmt::format("with points {} title {}", mark_style(k),
                           gnuplot_quoted(shown_names(group(drawn_[k])))));
    }
    for (const ContactLawTraits& law : contact_laws())
      names += fmt::format("{}'{}' {}", names.empty() ? "" : ",", law.word,
                           -topple::place_of(contact_laws(), law.kind));
    return plot.data +
           panel(2, "Creep at rest", fmt::format("greatest way of a node in {:g} s at rest", k_creep_time)) +
           "set logscale x\nset format x '10^{%T}'\nset key top left\nset mxtics 10\nset ylabel ''\n" +
           fmt::format("set yrange [-2.6:{:g}]\n", 0.7 + 0.2 * static_cast<double>(drawn_.size())) +
           decades("x", 1e6 * k_least, 1e6 * most) + "set ytics (" + names + ")\n" + values +
           upright(1e6 * k_creep_bound, 0, 1, k_bound_line, "bound 1 µm", 0.03, "offset 0.5,0") +
           "set xlabel 'way, µm' offset 0,0.3\n" + plot.command();
  }

  /// Height of a law in the panel of creep; bodies side by side.
  double place_of(ContactLawKind kind, int k) const {
    return -static_cast<double>(topple::place_of(contact_laws(), kind)) -
           0.22 * (k - (static_cast<double>(drawn_.size()) - 1) / 2);
  }

  std::string restitution() const {
    constexpr double k_slowest = 8e-4, k_fastest = 2.5;  // m/s
    Plot plot;
    for (int k = 0; k < static_cast<int>(contact_laws().size()); ++k) {
      ContactLaw law = study_.law;
      law.kind = contact_laws()[k].kind;
      std::vector<Point> theory;
      for (int i = 0; i <= 100; ++i) {
        const double speed = k_slowest * std::pow(k_fastest / k_slowest, i / 100.);
        theory.push_back({speed, study::restitution(law, speed)});
      }
      const std::string impacts = rows(Case::restitution, [&](const PenaltyRow& row, auto& out) {
        if (row.law.kind == law.kind) out.push_back({*row.at, *row.computed});
      });
      // open marks around filled ones stay visible where two laws agree
      const std::string marks =
          k == 0 ? fmt::format("lc rgb '{}' pt 6 ps 2 lw 2", k_colour[0]) : mark_style(k);
      plot.add(fmt::format("quadrature{}", k), rows_of(theory),
               fmt::format("with lines {} notitle", line_style(k, 2)));
      plot.add(fmt::format("impact{}", k), impacts,
               fmt::format("with points {} title {}", marks, gnuplot_quoted(in_words(law))));
    }
    const ContactLaw& law = study_.law;
    return plot.data +
           panel(3, "Restitution of a normal impact",
                 "marks: solver; lines: quadrature of the law; no gravity") +
           log_axis("x", "10^{%T}") + fmt::format("set xrange [{}:{}]\n", k_slowest, k_fastest) +
           "set yrange [-0.02:1.02]\nset key top right\nset xlabel 'impact speed, m/s' offset 0,0.3\n"
           "set ylabel 'speed after / before' offset 1,0\n" +
           level(law.restitution, fmt::format("e = {:g} asked", law.restitution)) +
           upright(law.normal_speed, 0, 0.8, k_bound_line, "normal\\_speed ε_n", 0.1, "offset 0.5,0") +
           plot.command();
  }

  static std::string in_words(const ContactLaw& law) {
    const ContactLawTraits& of = traits(law);
    if (!of.stores_energy) return fmt::format("{}: stays on the floor", of.word);
    return of.has_restitution ? fmt::format("{}, e = {:g}", of.word, law.restitution)
                              : fmt::format("{}, µ = {:g}", of.word, law.friction);
  }

  std::string frequency() const {
    const BodyGroup& body = group(decisive_);
    const std::vector<Point> line =
        over_alpha([&](const ContactLaw& law) { return bounce_frequency(body.theory, law); });
    double most = std::max(line.back().y, body.first_mode);
    std::string levels;
    if (body.first_mode > 0)
      levels += level(body.first_mode, fmt::format("first elastic mode, {:.4g} Hz", body.first_mode));
    if (study_.time_step > 0) {
      const double limit = 1 / (k_period_steps * study_.time_step);
      most = std::max(most, limit);
      levels += level(
          limit, fmt::format("{:g} steps of {:.3g} ms a period", k_period_steps, 1e3 * study_.time_step));
    }
    const std::string bounce = rows(Case::frequency, [&](const PenaltyRow& row, auto& out) {
      if (row.group == decisive_) out.push_back({in_kgf(row.law.alpha), *row.computed});
    });
    Plot plot;
    plot.add("line", rows_of(line), "with lines " + line_style(0, 2) + " title 'rigid, theory'");
    plot.add("bounce", bounce, "with points " + mark_style(0) + " title 'solver'");
    return plot.data +
           panel(4, "Contact frequency", "vertical motion of " + shown_names(body) + " about rest") +
           alpha_axis(0, 0.86, 0) + decades("y", line.front().y, most) + levels + log_axis("y", "%g") +
           "set key top left\nset ylabel 'frequency, Hz' offset 1,0\n" + plot.command();
  }

  std::string errors() const {
    constexpr double k_least = 1e-4;
    const BodyGroup& body = group(decisive_);
    const double rigid = body.theory.rigid_limit();
    const auto of = [&](Case kind, double at) {
      return rows(kind, [&](const PenaltyRow& row, auto& out) {
        if (row.group == decisive_ && row.at.value_or(0) == at && !row.coarse)
          out.push_back({in_kgf(row.law.alpha), 100 * std::max(*row.error(), k_least)});
      });
      ;
    };
    const std::vector<Point> lean = over_alpha([&](const ContactLaw& law) {
      return 100 * std::max(1 - tipping_limit(body.theory, law) / rigid, k_least);
    });
    Plot plot;
    plot.add("lean", rows_of(lean), "with lines " + line_style(0, 2) + " title 'steady tipping: theory'");
    plot.add("tipping", of(Case::tipping, 0),
             "with points " + mark_style(0) + " title 'steady tipping: settled'");
    plot.add("fall", of(Case::fall_back, 0),
             "with linespoints " + both_style(2) + " title 'time to fall back'");
    for (int k = 0; k < static_cast<int>(std::size(k_pulse_ratios)); ++k)
      plot.add(fmt::format("pulse{}", k), of(Case::half_sine, k_pulse_ratios[k]),
               fmt::format("with linespoints {} title 'least half-sine, w/p = {:g}'",
                           both_style(k == 0 ? 1 : 3), k_pulse_ratios[k]));
    return plot.data +
           panel(5, "Error against rigid contact",
                 fmt::format("{}: b/h = {:.3g}, {:.4g} gal", shown_names(body), rigid,
                             rigid * body.theory.gravity / k_gal)) +
           alpha_axis(0.27, 1, 0.27) + level(100 * k_theory_bound, "bound 2 %") +
           "set logscale y\nset yrange [0.0005:100]\nset format y '%g'\nset mytics 10\nset key bottom left\n"
           "set ylabel '|error|, % (0.01 stands for less)' offset 1,0\n" +
           plot.command();
  }

  const PenaltyStudy& study_;
  const Advice& advice_;
  std::vector<int> drawn_;  // groups
  int decisive_;
};

}  // namespace

std::string penalty_chart(const PenaltyStudy& study, const Advice& advice, const std::string& origin,
                          ChartFormat format) {
  return Chart(study, advice).script(origin, format);
}

}  // namespace topple::study
