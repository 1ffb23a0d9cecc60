#include <fmt/format.h>

#include "app/support/log.h"
#include "app/validate/validation.h"
#include "app/validate/validation_page.h"
#include "solver/study/validate/block_run.h"
#include "solver/study/validate/furniture_chart.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

struct Furniture {
  std::vector<study::FurnitureValue> values;
  std::vector<study::FurniturePoint> points;
  std::vector<study::FurnitureCurve> curves;

  /// The curve of a piece without slip at this frequency over its corner.
  const study::FurnitureCurve& at(std::size_t piece, double ratio) const {
    std::size_t k = 0;
    while (points[k].piece != piece || points[k].ratio != ratio || points[k].friction != study::k_rough) ++k;
    return curves[k];
  }
};

/// Median, gal, with its interval.
std::string shown(const study::FurnitureValue& value, const study::FurnitureCurve& curve) {
  if (!curve.half) return "beyond the levels";
  const double unit = value.median / k_gal;
  return fmt::format("{:.0f} ({:.0f} to {:.0f})", curve.half->median * unit, curve.half->low * unit,
                     curve.half->high * unit);
}

std::string in_words(const Furniture& of) {
  std::string text =
      "acceleration that half overturn at, gal, at half, at one and at twice the corner frequency\n";
  for (std::size_t p = 0; p < of.values.size(); ++p) {
    const study::FurnitureValue& value = of.values[p];
    text += fmt::format("{:<14} A_R50 {:.0f}; {}; {}; {} (formula {:.0f})\n", value.name,
                        value.median / k_gal, shown(value, of.at(p, 0.5)), shown(value, of.at(p, 1)),
                        shown(value, of.at(p, 2)), value.median_at(2 * value.corner()) / k_gal);
  }
  return text;
}

std::string page_of(const Furniture& of) {
  std::vector<std::vector<std::string>> rows, slips;
  for (std::size_t p = 0; p < of.values.size(); ++p) {
    const study::FurnitureValue& value = of.values[p];
    rows.push_back({fmt::format("{}, {:g} m", value.name, value.height),
                    fmt::format("{:.0f}", value.lift / k_gal), fmt::format("{:.0f}", value.median / k_gal),
                    fmt::format("{:.2f}", value.corner()), shown(value, of.at(p, 0.25)),
                    shown(value, of.at(p, 0.5)), shown(value, of.at(p, 1)), shown(value, of.at(p, 2)),
                    fmt::format("{:.0f}", value.median_at(2 * value.corner()) / k_gal)});
  }
  for (std::size_t k = 0; k < of.points.size(); ++k)
    if (of.points[k].friction != study::k_rough) {
      const study::FurnitureValue& value = of.values[of.points[k].piece];
      slips.push_back({value.name, fmt::format("{:.2f}", of.points[k].friction),
                       fmt::format("{:.2f}", of.points[k].friction / value.slenderness()),
                       shown(value, of.curves[k]), fmt::format("{:.0f}", value.median / k_gal)});
    }
  return html_section(
             "Result",
             html_paragraph(
                 "The acceleration at which half of the floors overturn a uniform planar block of that "
                 "shape, gal, with 95 %, beside A_R50 = A_0 (1 + A_0/g), which above the corner frequency "
                 "grows with the frequency.") +
                 html_table({"", "A_0", "A_R50", "F_b, Hz", "at 0.25 F_b", "at 0.5 F_b", "at F_b", "at 2 F_b",
                             "formula at 2 F_b"},
                            rows)) +
         k_chart_here +
         html_section("Where it slips",
                      html_table({"", "friction", "over B/H", "half overturn at, gal", "A_R50"}, slips)) +
         html_section("What this does not show",
                      html_paragraph(
                          "Heights are assumed; A_R50 does not depend on them, F_b does. Blocks are uniform, "
                          "their floors synthetic. Values of the method rest on tests that were not at hand: "
                          "this compares two computations, not a computation with a test."));
}

std::optional<Comparison> compare_furniture(const ValidationOptions& options, const std::string& stem) {
  const auto all = std::make_shared<Furniture>();
  if (!options.data.empty()) {
    all->values = study::read_furniture(options.data);
    if (all->values.empty())
      log_message(options.data + ": has no furniture.csv; the five values that are quoted are used");
  }
  if (all->values.empty()) all->values = study::furniture_values();
  all->points = study::furniture_points(all->values);
  ordered_json settings{{"validate", "furniture"}};
  for (const study::FurnitureValue& value : all->values)
    settings["values"].push_back({value.name, value.lift, value.median, value.height});
  const auto rows =
      run_cases(options, "furniture", stem, settings, static_cast<int>(all->points.size()), [&] {
        return [&](int k, const std::function<bool()>& give_up) {
          return study::run_furniture_case(all->values, all->points[static_cast<std::size_t>(k)], give_up);
        };
      });
  if (!rows) return std::nullopt;
  all->curves = study::gather_furniture(*rows);
  return Comparison{.title = "Furniture values of the Japanese evaluation",
                    .entries = study::furniture_json(all->values, all->curves),
                    .rows = study::furniture_rows(all->values, all->curves),
                    .chart =
                        [all](const std::string& origin, study::ChartFormat format) {
                          return study::furniture_chart(all->values, all->curves, origin, format);
                        },
                    .page = page_of(*all),
                    .text = in_words(*all)};
}

}  // namespace

const Validation k_furniture_validation = {
    .name = "furniture",
    .about =
        "accelerations at which the Japanese evaluation method has furniture overturn (DATA may be left out)",
    .source =
        "National Institute for Land and Infrastructure Management (NILIM), evaluation of overturning "
        "furniture; "
        "M. Kaneko and Y. Hayashi, J. Struct. Constr. Eng. AIJ 536, 2000, 55-62",
    .needs_data = false,
    .takes_fit = false,
    .compare = compare_furniture};

}  // namespace topple::app
