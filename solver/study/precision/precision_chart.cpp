#include "solver/study/precision/precision_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/contact/contact_law.h"
#include "solver/study/common/gnuplot.h"

namespace topple::study {
namespace {

// px
constexpr Sheet k_sheet{1800, 1510};
constexpr int k_left = 116, k_right = 24, k_gap = 122, k_columns = 3;  // numbers like 0.0001 before panels
constexpr int k_first = 1126, k_pitch = 486,
              k_panel = 340;   // top of the first row of panels, row to row, height
constexpr int k_tables = 196;  // top of the tables
constexpr double k_width = (k_sheet.width - k_left - k_right - (k_columns - 1) * k_gap) / double{k_columns};

// Colours of Okabe and Ito; fixed steps are filled marks on lines, steps by tolerance open ones on dashes.
struct MethodStyle {
  Method kind;
  const char* style;
};
constexpr MethodStyle k_styles[] = {
    {Method::rigid, "lc rgb '#d55e00' lw 2 dt 1 pt 7 ps 1.3"},
    {Method::rigid_auto, "lc rgb '#d55e00' lw 2 dt (5,5) pt 6 ps 1.4"},
    {Method::elastic, "lc rgb '#009e73' lw 2 dt 1 pt 5 ps 1.3"},
    {Method::elastic_auto, "lc rgb '#009e73' lw 2 dt (5,5) pt 4 ps 1.4"},
    {Method::generalized_alpha, "lc rgb '#0072b2' lw 2 dt 1 pt 9 ps 1.5"},
    {Method::generalized_alpha_auto, "lc rgb '#0072b2' lw 2 dt (5,5) pt 8 ps 1.6"},
    {Method::newmark, "lc rgb '#cc79a7' lw 2 dt 1 pt 13 ps 1.6"},
    {Method::newmark_damped, "lc rgb '#8c6d00' lw 2 dt 1 pt 11 ps 1.5"},
    {Method::central_difference, "lc rgb '#111111' lw 2 dt 1 pt 2 ps 1.4"},
};
constexpr const char* k_front_style = "lc rgb '#f5d76e' lw 9 dt 1";
constexpr const char* k_own_style = "pt 6 ps 2.6 lw 3 lc rgb '#000000'";
constexpr const char* k_law_colour[] = {"#0072b2", "#d55e00", "#555555"};                // by law
constexpr const char* k_alpha_look[] = {"dt 1 pt 7", "dt (8,4) pt 5", "dt (2,4) pt 9"};  // by factor

struct MeasureTitle {
  Measure kind;
  const char *title, *subtitle;
};
constexpr MeasureTitle k_titles[] = {
    {Measure::tilt, "Tilt", "root mean square difference, over the critical angle"},
    {Measure::overturn_time, "Time of overturning", "difference, over the time"},
    {Measure::peak_stress, "Peak stress", "difference, over the stress; rigid bodies have none"},
    {Measure::energy, "Energy balance", "energy that nothing explains, over the largest exchanged"},
};

struct Place {
  double left, top;  // px, of the panel
  std::string axes() const { return k_sheet.place(left, left + k_width, top - k_panel, top); }
};
Place place(int n) {
  const int row = n / k_columns;
  return {k_left + (n % k_columns) * (k_width + k_gap), static_cast<double>(k_first - row * k_pitch)};
}

std::string axis_labels(const char* x = "CPU time per simulated second, ms") {
  return fmt::format("set xlabel '{}' offset 0,0.3\nset ylabel 'error, %' offset 0.6,0\n", x);
}
constexpr double k_small = 0.9, k_tiny = 0.84;  // of text, over the size of other text

std::string percent(double share) {
  return fmt::format("{:.2g} %", 100 * share);
}

/// What is drawn in a panel.
struct Box {
  double left = 1e300, right = 0, low = 1e300, high = 0;

  void add(double x, double y) {
    left = std::min(left, x);
    right = std::max(right, x);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  std::string ranges() const {
    return fmt::format("set xrange [{:.4g}:{:.4g}]\nset yrange [{:.4g}:{:.4g}]\n", left / 1.4, right * 1.4,
                       low / 2, high * 2.5);
  }
};

class Chart {
 public:
  Chart(const PrecisionPlan& plan, const PrecisionStudy& study) : plan_(plan), study_(study) {}

  std::string script(const std::string& origin, ChartFormat format) {
    std::string out = header(origin) + cheapest_table() + law_table() + legend();
    if (reference(0).run < 0) return k_sheet.script(format, out);
    out += std::string(k_open_border) +
           "set tics out scale 0.7,0.4 nomirror\nset xtics nomirror\nset ytics nomirror\nset logscale xy\n" +
           grid("#d8d8d8") + "set mxtics 10\nset format x '%g'\nset format y '%g'\n";
    for (int m = 0; m < k_measures; ++m) out += cost_panel(static_cast<Measure>(m));
    return k_sheet.script(format, out + step_panel() + laws_panel());
  }

 private:
  const Reference& reference(int law) const { return study_.references[static_cast<std::size_t>(law)]; }
  const PrecisionRow& row(int k) const { return study_.rows[static_cast<std::size_t>(k)]; }

  /// As drawn, %.
  std::optional<double> error(int k, Measure measure) const {
    const std::optional<double>& e = row(k).errors[index(measure)];
    if (!e) return std::nullopt;
    const double shown = std::max(*e, reference(plan_.law_of(k)).uncertainty[index(measure)].value_or(0));
    return shown > 0 ? std::optional(100 * shown) : std::nullopt;
  }

  std::string header(const std::string& origin) const {
    return k_sheet.label(bold(plain("Error against cost of " + plan_.scene.name), 1.5), k_left,
                         k_sheet.height - 36) +
           k_sheet.lines(conditions(origin), k_left, k_sheet.height - 76, 26, k_grey_as_is);
  }

  /// What errors and times are of.
  std::vector<std::string> conditions(const std::string& origin) const {
    std::vector<std::string> lines{plan_.scene.title + ". Contact: " + in_words(plan_.laws.front()),
                                   origin + ", " + runs_in_words(study_.run, study_.of)};
    const Reference& r = reference(0);
    if (r.run < 0) {
      lines.push_back("No errors are known: " + r.why_not);
      return lines;
    }
    std::string line =
        fmt::format("Reference: {}; {} is off by", in_words(plan_, r.run), in_words(plan_, r.check));
    for (int m = 0; m < k_measures; ++m)
      if (const auto& off = r.uncertainty[static_cast<std::size_t>(m)])
        line += fmt::format("{} {} ({})", m > 0 ? "," : "", percent(*off), name(static_cast<Measure>(m)));
    lines.push_back(line);
    line = fmt::format("Compared over {:.4g} s", r.window);
    line += r.window < r.end - plan_.interval
                ? fmt::format(" of {:.4g} s: then the tilts of these two part by {} of the critical angle",
                              r.end, percent(k_parted))
                : std::string(", the whole run");
    if (plan_.scene.setup.run.stop_when == StopWhen::all_overturned)
      line += "; runs end when all bodies have overturned";
    lines.push_back(line);
    lines.push_back("Grey: the reference itself is not more certain, smaller errors are drawn there");
    lines.push_back(
        "CPU time: of the solving thread for the whole run, settling included, over the time simulated; "
        "of repeated runs the fastest");
    return lines;
  }

  bool has(Method method) const {
    return std::ranges::any_of(plan_.settings, [=](const Setting& s) { return s.method == method; });
  }

  std::string legend() const {
    Plot keys;
    for (const auto& [method, style] : k_styles)
      if (has(method))
        keys.layers.push_back(fmt::format("NaN with linespoints {} title {} noenhanced", style,
                                          gnuplot_quoted(meaning(method).about)));
    keys.layers.push_back(std::string("NaN with lines ") + k_front_style + " title 'Pareto front'");
    keys.layers.push_back(std::string("NaN with points ") + k_own_style + " title 'the scene as it is'");
    return k_sheet.legend(k_left, k_sheet.width - k_right, k_sheet.height - 306, k_sheet.height - 222,
                          "3 Left reverse samplen 3 spacing 1.15 width -3 font ',12'", keys) +
           "unset object\n";
  }

  /// Adds the methods, but those of no point.
  template <typename X>
  void add_curves(Plot& plot, Measure measure, X x_of) const {
    for (const auto& [method, style] : k_styles) {
      std::string rows;
      for (int k = 0; k < plan_.cases() && plan_.law_of(k) == 0; ++k)
        if (const Setting& setting = plan_.setting_of(k); setting.method == method)
          if (const auto x = x_of(k), e = error(k, measure); x && e) rows += point_row(*x, *e);
      if (!rows.empty())
        plot.add(fmt::format("method{}", plot.layers.size()), rows,
                 fmt::format("with linespoints {} notitle", style));
    }
  }

  /// Ranges around what is drawn of the scene's own law, and where the reference is not certain.
  template <typename X>
  std::string ranges(Measure measure, X x_of) const {
    Box box;
    for (int k = 0; k < plan_.cases() && plan_.law_of(k) == 0; ++k)
      if (const auto x = x_of(k), e = error(k, measure); x && e) box.add(*x, *e);
    if (box.right == 0) return "";
    std::string out = box.ranges();
    if (const auto& off = reference(0).uncertainty[index(measure)]; off && *off > 0)
      out += fmt::format(
          "set object 1 rectangle from graph 0,graph 0 to graph 1,first {:.6g} fs solid noborder fc rgb "
          "'#ececec' behind\n",
          100 * *off);
    return out;
  }

  std::string titles(const Place& at, const std::string& title, const std::string& subtitle) const {
    return k_sheet.label(bold(title, 1.08), at.left, at.top + 50) +
           k_sheet.label(scaled(subtitle, k_small), at.left, at.top + 24, k_grey);
  }

  std::string cost_panel(Measure measure) const {
    const Place at = place(static_cast<int>(measure));
    const auto cost = [&](int k) { return row(k).cost ? std::optional(1e3 * *row(k).cost) : std::nullopt; };
    std::string out = titles(at, row_of(k_titles, measure).title, row_of(k_titles, measure).subtitle);
    const std::string range = ranges(measure, cost);
    if (range.empty())
      return out + at.axes() + "unset tics\nset xrange [1:2]\nset yrange [1:2]\n" +
             k_sheet.label("none within what is compared", at.left + 30, at.top - 60, k_grey) +
             "plot NaN notitle\nunset label\nset xtics\nset ytics\n";
    Plot plot;
    plot.layers = {std::string("$front with lines ") + k_front_style + " notitle"};
    add_curves(plot, measure, cost);
    std::string steps;
    double before = 0;
    for (const int k : front(plan_, study_, 0, measure)) {
      const auto e = error(k, measure);
      if (!e) continue;
      if (before > 0) steps += point_row(*cost(k), before);
      steps += point_row(*cost(k), *e);
      before = *e;
    }
    const auto own = error(0, measure);
    plot.data += data_block("front", steps);
    plot.add("own", own && cost(0) ? point_row(*cost(0), *own) : "",
             std::string("with points ") + k_own_style + " notitle");
    return plot.data + out + range + at.axes() + axis_labels() + plot.command() +
           "unset label\nunset object 1\n";
  }

  std::string step_panel() const {
    const Place at = place(k_measures);
    const auto step = [&](int k) {
      const double h = plan_.setting_of(k).step;
      return h > 0 ? std::optional(1e3 * h) : std::nullopt;
    };
    const std::string range = ranges(Measure::tilt, step);
    Plot plot;
    add_curves(plot, Measure::tilt, step);
    if (plot.layers.empty()) return "";
    return plot.data +
           titles(at, "How the error goes with the step", "tilt; level ends are the error of the model") +
           range + at.axes() + axis_labels("time step, ms") + plot.command() +
           "unset label\nunset object 1\n";
  }

  /// 0, 1, 2: the factor that a law's alpha has.
  int factor_of(const ContactLaw& law) const {
    const double factor = law.alpha / plan_.laws.front().alpha;
    int nearest = 0;
    for (int f = 1; f < static_cast<int>(std::size(k_alpha_factors)); ++f)
      if (std::abs(std::log(factor / k_alpha_factors[f])) <
          std::abs(std::log(factor / k_alpha_factors[nearest])))
        nearest = f;
    return nearest;
  }

  std::string laws_panel() const {
    const Place at = place(k_measures + 1);
    Plot plot;
    Box box;
    for (int law = 0; law < static_cast<int>(plan_.laws.size()); ++law) {
      std::string rows;
      for (const int k : front(plan_, study_, law, Measure::tilt))
        if (const auto e = error(k, Measure::tilt)) {
          rows += point_row(1e3 * *row(k).cost, *e);
          box.add(1e3 * *row(k).cost, *e);
        }
      if (rows.empty()) continue;
      const ContactLaw& of = plan_.laws[static_cast<std::size_t>(law)];
      plot.add(fmt::format("law{}", law), rows,
               fmt::format("with linespoints lc rgb '{}' lw 2 {} ps 1 title {}",
                           k_law_colour[static_cast<std::size_t>(place_of(contact_laws(), of.kind)) %
                                        std::size(k_law_colour)],
                           k_alpha_look[factor_of(of)], gnuplot_quoted(in_words(of))));
    }
    if (plot.layers.empty()) return "";
    box.high *= std::pow(box.high / box.low, 0.25);  // for the key
    return plot.data +
           titles(at, "Fronts under other laws and alpha",
                  "tilt, each against a reference of its own physics") +
           box.ranges() + at.axes() +
           "set key at graph 1.03,1.03 right top Left reverse noenhanced samplen 2 width -1 spacing 1 font "
           "',10'\n" +
           axis_labels() + plot.command() + "unset label\nunset key\n";
  }

  std::string cheapest_table() const {
    if (reference(0).run < 0) return "";
    constexpr double k_head = 80, k_column = 268;
    std::string out = k_sheet.label(bold("Cheapest setting within an error", 1.08), k_left, k_tables);
    for (int m = 0; m < k_measures; ++m) {
      const auto measure = static_cast<Measure>(m);
      const double x = k_left + k_head + m * k_column;
      out += k_sheet.label(name(measure), x, k_tables - 30, k_grey);
      for (std::size_t l = 0; l < std::size(k_levels); ++l) {
        const double y = k_tables - 58 - 48 * static_cast<double>(l);
        if (m == 0) out += k_sheet.label(percent(k_levels[l]), k_left, y);
        const std::optional<int> k = cheapest(plan_, study_, 0, measure, k_levels[l]);
        if (!k) {
          out += k_sheet.label(scaled("none tried, or not certain", k_small), x, y, k_grey);
          continue;
        }
        const std::string setting = in_words(plan_, *k);
        const std::size_t comma = setting.find(", ");
        out += k_sheet.label(scaled(plain(setting.substr(0, comma)), k_small), x, y);
        out += k_sheet.label(
            scaled(plain(setting.substr(comma + 2)) + fmt::format("; {:.3g} ms/s", 1e3 * *row(*k).cost),
                   k_small),
            x, y - 20, k_grey);
      }
    }
    return out;
  }

  /// What a law and alpha change, by their references.
  std::string law_table() const {
    constexpr double k_x = 1268, k_line = 17;
    std::string out =
        k_sheet.label(bold("What law and alpha change", 1.08), k_x, k_tables) +
        k_sheet.label(scaled(plain(bodies_in_words()), k_tiny), k_x + 164, k_tables - 25, k_grey);
    for (int law = 0; law < static_cast<int>(plan_.laws.size()); ++law) {
      const Reference& r = reference(law);
      std::string words;
      for (std::size_t b = 0; b < std::min<std::size_t>(r.fell.size(), k_told_bodies); ++b)
        words += (b ? ", " : "") + (r.fell[b] ? fmt::format("{:.4f} s", *r.fell[b]) : std::string("stands"));
      const double y = k_tables - 43 - k_line * law;
      out += k_sheet.label(scaled(in_words(plan_.laws[static_cast<std::size_t>(law)]), k_tiny), k_x, y);
      out += k_sheet.label(scaled(r.run < 0 ? "no reference" : words, k_tiny), k_x + 164, y);
      if (r.run >= 0)
        out +=
            k_sheet.label(scaled(fmt::format("{:.4g} s", r.window), k_tiny), k_sheet.width - k_right - 40, y);
    }
    return out + k_sheet.label(scaled("window", k_tiny), k_sheet.width - k_right - 40, k_tables - 25, k_grey);
  }

  std::string bodies_in_words() const {
    std::string words = "overturning of ";
    const Model& model = plan_.scene.setup.model;
    for (int b = 0; b < std::min(model.furniture_total(), static_cast<int>(k_told_bodies)); ++b)
      words += (b > 0 ? ", " : "") + model.bodies[static_cast<std::size_t>(b)].name;
    return words;
  }

  static constexpr std::size_t k_told_bodies = 3;

  const PrecisionPlan& plan_;
  const PrecisionStudy& study_;
};

}  // namespace

std::string precision_chart(const PrecisionPlan& plan, const PrecisionStudy& study, const std::string& origin,
                            ChartFormat format) {
  return Chart(plan, study).script(origin, format);
}

}  // namespace topple::study
