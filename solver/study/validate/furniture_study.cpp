#include "solver/study/validate/furniture_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "solver/io/common/errors.h"
#include "solver/study/common/axis.h"
#include "solver/study/overturn/criteria.h"
#include "solver/study/validate/block_run.h"
#include "solver/study/validate/data_table.h"

namespace topple::study {

using nlohmann::ordered_json;

namespace {

constexpr double k_method_gravity = 9.8;  // m/s^2, that the values are made with
constexpr std::array k_ratios{0.25, 0.35, 0.5, 0.7, 1., 1.4, 2., 2.8, 4.};
constexpr std::array k_frictions{0.15, 0.2, 0.3, 0.4, 0.6, 0.8};
constexpr int k_levels = 32;
constexpr double k_after = 3;          // s, behind the motion
constexpr double k_most_slip = 0.999;  // slips before it lifts: friction over B/H

/// Levels of a point: around where the formula has half of them, and above the corner far beyond that.
std::vector<double> levels_of(const FurniturePoint& point) {
  const double first = 0.6, last = point.ratio < 0.8 && point.friction == k_rough ? 1.8
                                   : point.ratio > 1                              ? 30
                                                                                  : 8;
  std::vector<double> levels;
  for (int n = 0; n < k_levels; ++n) levels.push_back(first * std::pow(last / first, n / (k_levels - 1.)));
  return levels;
}

planar::Block block_of(const FurnitureValue& value, double friction) {
  const double base = value.slenderness() * value.height;
  planar::Block block;
  block.inertia = (base * base + value.height * value.height) / 12;
  block.left = block.right = base / 2, block.height = value.height / 2;
  block.static_friction = block.kinetic_friction = friction;
  block.gravity = k_method_gravity;
  return block;
}

FurnitureValue quoted_value(const char* name, double lift_gal, double median_gal, double height) {
  return {name, lift_gal * k_gal, median_gal * k_gal, height};
}

ordered_json rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

std::optional<FurnitureCurve::Half> half_of(const FurnitureCurve& curve) {
  const std::vector<Level>& levels = curve.levels;
  const auto share = [&](std::size_t n) { return static_cast<double>(levels[n].hits) / levels[n].runs; };
  for (std::size_t n = 1; n < levels.size(); ++n) {
    if (share(n) < 0.5 || share(n - 1) >= 0.5) continue;
    const double low = levels[n - 1].intensity, high = levels[n].intensity;
    if (curve.fit.fit) {
      const Interval interval = curve.fit.fit->median_interval();
      return FurnitureCurve::Half{curve.fit.fit->median, interval.low, interval.high};
    }
    return FurnitureCurve::Half{low * std::pow(high / low, (0.5 - share(n - 1)) / (share(n) - share(n - 1))),
                                low, high};
  }
  return std::nullopt;
}

ordered_json row_of(const FurnitureValue& value, const FurniturePoint& point, const FurnitureCurve& curve) {
  const double frequency = point.ratio * value.corner(), unit = value.median / k_gal;
  const bool rough = point.friction == k_rough;
  ordered_json row{{"piece", value.name},
                   {"height_m", value.height},
                   {"frequency_Hz", rounded(frequency)},
                   {"over_corner", point.ratio},
                   {"friction", rough ? ordered_json(nullptr) : ordered_json(point.friction)}};
  for (const auto& [key, number] :
       {std::pair{"a50_gal", &FurnitureCurve::Half::median}, std::pair{"low_gal", &FurnitureCurve::Half::low},
        std::pair{"high_gal", &FurnitureCurve::Half::high}})
    row[key] = curve.half ? rounded((*curve.half).*number * unit) : ordered_json(nullptr);
  row["beta"] = curve.fit.fit ? rounded(curve.fit.fit->beta) : ordered_json(nullptr);
  row["formula_gal"] = rounded(value.median_at(frequency) / k_gal);
  row["over_formula"] = curve.half ? rounded(curve.half->median * value.median / value.median_at(frequency))
                                   : ordered_json(nullptr);
  return row;
}

}  // namespace

double FurnitureValue::slenderness() const {
  return lift / k_method_gravity;
}

double FurnitureValue::corner() const {
  Standing body{};
  body.base = slenderness() * height / 2, body.height = height / 2;
  return evaluation_frequency(body);
}

double FurnitureValue::median_at(double frequency) const {
  return median * std::max(1., frequency / corner());
}

const std::vector<FurnitureValue>& furniture_values() {
  static const std::vector<FurnitureValue> values{
      quoted_value("bookshelf", 174, 205, 1.8), quoted_value("cupboard", 232, 287, 1.8),
      quoted_value("tall wardrobe", 327, 436, 1.8), quoted_value("chest", 315, 416, 1.2),
      quoted_value("desk", 535, 826, 0.7)};
  return values;
}

std::vector<FurnitureValue> read_furniture(const std::filesystem::path& folder) {
  files_in(folder);
  const std::filesystem::path file = folder / "furniture.csv";
  if (!std::filesystem::is_regular_file(file)) return {};
  const std::string text = unpacked(file);
  const DataTable table(text, file.string(), {"a0_gal", "ar50_gal", "height_m"});
  std::vector<FurnitureValue> values;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!(table.at(row, 0) >= 20 && table.at(row, 0) < 980)) table.fail(row, 0, "is outside 20..980 gal");
    if (!(table.at(row, 1) >= table.at(row, 0))) table.fail(row, 1, "is below a0_gal");
    if (!(table.at(row, 2) >= 0.1 && table.at(row, 2) <= 10)) table.fail(row, 2, "is outside 0.1..10 m");
    values.push_back(quoted_value("", table.at(row, 0), table.at(row, 1), table.at(row, 2)));
  }
  if (values.empty()) throw io::InputError(file.string() + ": has no piece");
  const std::vector<std::string> names = text_column(text, "name");
  std::map<std::string, int> lines;
  for (std::size_t row = 0; row < values.size(); ++row) {
    values[row].name = row < names.size() ? names[row] : fmt::format("piece {}", row + 1);
    if (const auto [other, is_new] = lines.emplace(values[row].name, table.line(row)); !is_new)
      throw io::InputError(fmt::format("{}:{}: name: \"{}\" is in line {} already", file.string(),
                                       table.line(row), values[row].name, other->second));
  }
  return values;
}

std::vector<FurniturePoint> furniture_points(const std::vector<FurnitureValue>& values) {
  std::vector<FurniturePoint> points;
  for (std::size_t p = 0; p < values.size(); ++p)
    for (const double ratio : k_ratios) points.push_back({p, ratio, k_rough});
  for (std::size_t p = 0; p < values.size(); ++p)
    for (const double friction : k_frictions)
      if (friction > k_most_slip * values[p].slenderness() / 2) points.push_back({p, k_slip_ratio, friction});
  return points;
}

std::shared_ptr<const Accelerogram> floor_noise(double frequency, int n) {
  constexpr double k_duration = 20, k_rise = 2, k_fall = 12, k_decay = 0.35;  // s, s, s, 1/s
  constexpr double k_half_band = 0.33;                                        // octaves
  constexpr int k_waves = 40;
  AccelerogramComponent x;
  x.interval = std::min(0.01, 1 / (40 * frequency));
  const auto count = static_cast<std::size_t>(k_duration / x.interval) + 1;
  x.samples.assign(count, 0);
  for (int wave = 0; wave < k_waves; ++wave) {
    const double low = frequency * std::exp2(-k_half_band), high = frequency * std::exp2(k_half_band);
    const auto seed = static_cast<std::uint64_t>(n);
    const auto of = static_cast<std::uint64_t>(wave);
    const double turn = 2 * k_pi * std::lerp(low, high, (wave + scattered(seed, 2 * of)) / k_waves),
                 phase = 2 * k_pi * scattered(seed, 2 * of + 1);
    for (std::size_t i = 0; i < count; ++i)
      x.samples[i] += std::sin(turn * static_cast<double>(i) * x.interval + phase);
  }
  double peak = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) * x.interval;
    x.samples[i] *= t < k_rise   ? (t / k_rise) * (t / k_rise)
                    : t < k_fall ? 1
                                 : std::exp(-k_decay * (t - k_fall));
    peak = std::max(peak, std::abs(x.samples[i]));
  }
  for (double& sample : x.samples) sample /= peak;
  return make_accelerogram({std::move(x)});
}

std::string run_furniture_case(const std::vector<FurnitureValue>& values, const FurniturePoint& point,
                               const std::function<bool()>& give_up) {
  const FurnitureValue& value = values[point.piece];
  const planar::Block block = block_of(value, point.friction);
  const std::vector<double> levels = levels_of(point);
  std::vector<int> hits(levels.size());
  for (int n = 0; n < k_motions; ++n) {
    const auto motion = floor_noise(point.ratio * value.corner(), n);
    std::vector<BlockRun> runs;
    for (const double level : levels) runs.push_back({block, motion, level * value.median, k_after});
    const std::vector<bool> fell = overturns(runs, give_up);
    if (fell.empty()) return "";
    for (std::size_t level = 0; level < levels.size(); ++level) hits[level] += fell[level];
  }
  return ordered_json{{"levels", levels}, {"hits", hits}}.dump();
}

std::vector<FurnitureCurve> gather_furniture(const std::vector<std::string>& rows) {
  std::vector<FurnitureCurve> curves;
  for (const std::string& text : rows) {
    const ordered_json row = ordered_json::parse(text);
    FurnitureCurve curve;
    for (std::size_t n = 0; n < row["levels"].size(); ++n)
      curve.levels.push_back({row["levels"][n].get<double>(), k_motions, row["hits"][n].get<int>()});
    curve.fit = fit_fragility(curve.levels, "overturns");
    curve.half = half_of(curve);
    curves.push_back(std::move(curve));
  }
  return curves;
}

ordered_json furniture_rows(const std::vector<FurnitureValue>& values,
                            const std::vector<FurnitureCurve>& curves) {
  ordered_json rows = ordered_json::array();
  const std::vector<FurniturePoint> points = furniture_points(values);
  for (std::size_t k = 0; k < points.size(); ++k)
    rows.push_back(row_of(values[points[k].piece], points[k], curves[k]));
  return rows;
}

ordered_json furniture_json(const std::vector<FurnitureValue>& values,
                            const std::vector<FurnitureCurve>& curves) {
  const std::vector<FurniturePoint> points = furniture_points(values);
  ordered_json pieces = ordered_json::array();
  for (std::size_t p = 0; p < values.size(); ++p) {
    const FurnitureValue& value = values[p];
    ordered_json piece{{"name", value.name},
                       {"height_m", value.height},
                       {"a0_gal", value.lift / k_gal},
                       {"ar50_gal", value.median / k_gal},
                       {"formula_gal", std::round(value.lift * (1 + value.slenderness()) / k_gal * 10) / 10},
                       {"corner_Hz", std::round(value.corner() * 1e4) / 1e4},
                       {"points", ordered_json::array()}};
    for (std::size_t k = 0; k < points.size(); ++k)
      if (points[k].piece == p) piece["points"].push_back(row_of(value, points[k], curves[k]));
    pieces.push_back(std::move(piece));
  }
  return {{"motions", k_motions}, {"pieces", pieces}};
}

}  // namespace topple::study
