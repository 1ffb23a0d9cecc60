#include "solver/study/common/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/io/document/scene_document.h"
#include "solver/io/edit/scene_number.h"
#include "solver/io/scene/scene_check.h"
#include "solver/math/elementary.h"
#include "solver/study/common/kept_rows.h"

namespace topple::study {
namespace {

using io::InputError;
using nlohmann::ordered_json;

constexpr const char* k_form = "expected KEY=FROM..TO:N, such as shake.1.frequency=\"0.2 Hz..5 Hz:24\"";

std::string trimmed(std::string text) {
  text.erase(0, std::min(text.find_first_not_of(" \t"), text.size()));
  text.erase(text.find_last_not_of(" \t") + 1);
  return text;
}

std::optional<double> plain_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// SI.
double end_of(const std::string& text, const io::Key& key) {
  const std::optional<double> number = plain_number(text);
  const io::Quantity read = number ? io::Quantity{number, ""} : io::parse_quantity(text, key.dimension);
  if (!read.si) throw InputError('"' + text + "\" " + read.problem);
  if (*read.si < key.least || *read.si > key.most)
    throw InputError(io::value_text(key, *read.si) + " is outside " + io::range_text(key));
  return *read.si;
}

double six_digits(double value) {
  return *plain_number(fmt::format("{:.6g}", value));
}

/// N and what follows it.
void read_count(const std::string& text, int& count, std::string& spacing) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  spacing = trimmed(std::string(end, text.data() + text.size()));
  if (error != std::errc() || count < 2 || count > k_most_values ||
      (!spacing.empty() && spacing != "log" && spacing != "lin"))
    throw InputError(fmt::format("\"{}\" is not a whole number in 2..{}, or one with log or lin behind it",
                                 text, k_most_values));
}

void check_end(const io::Scene& scene, const Axis& axis, int i, const char* option) {
  io::Node root = io::parse_toml(scene.text, scene.name);
  io::apply_override(root, axis.change(i));
  try {
    io::check_scene(root, scene.name);
  } catch (const InputError& error) {
    std::string line = error.what();
    if (line.starts_with("--set ")) line = option + line.substr(5);
    throw InputError(line);
  }
}

}  // namespace

std::vector<double> Axis::edges() const {
  const auto middle = [this](double a, double b) { return logarithmic ? std::sqrt(a * b) : (a + b) / 2; };
  const auto mirrored = [this](double edge, double value) {
    return logarithmic ? value * value / edge : 2 * value - edge;
  };
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < values.size(); ++i) out.push_back(middle(values[i], values[i + 1]));
  const double first = mirrored(out.front(), values.front()), last = mirrored(out.back(), values.back());
  out.insert(out.begin(), first);
  out.push_back(last);
  return out;
}

std::string Axis::change_to(double value) const {
  return fmt::format("{}={:.6g}{}{}", key, value, unit.empty() ? "" : " ", unit);
}

Axis parse_axis(const std::string& text, const io::Key& key) {
  const std::size_t equals = text.find('='), dots = text.find("..", std::min(equals, text.size())),
                    colon = text.rfind(':');
  if (dots == std::string::npos || colon == std::string::npos || colon < dots)
    throw InputError('"' + text + "\": " + k_form);
  Axis axis;
  axis.key = axis_key(text);
  const auto of_key = [&](const InputError& error) { return InputError(axis.key + ": " + error.what()); };
  double from = 0, to = 0;
  int count = 0;
  std::string spacing;
  try {
    from = end_of(trimmed(text.substr(equals + 1, dots - equals - 1)), key);
    to = end_of(trimmed(text.substr(dots + 2, colon - dots - 2)), key);
    read_count(trimmed(text.substr(colon + 1)), count, spacing);
    if (!(from < to)) throw InputError("FROM must be less than TO");
    if (spacing == "log" && !(from > 0)) throw InputError("a logarithmic axis begins above 0");
  } catch (const InputError& error) {
    throw of_key(error);
  }
  axis.table = key.table;
  axis.name = key.name;
  axis.unit = key.unit.empty() ? io::si_unit(key.dimension) : key.unit;
  axis.si = key.dimension == io::Dimension::none ? 1 : io::unit_value(axis.unit, key.dimension);
  axis.logarithmic = spacing.empty() ? from > 0 && to >= k_wide * from : spacing == "log";
  for (int i = 0; i < count; ++i) {
    const double part = i / (count - 1.);
    const double si = axis.logarithmic ? from * elementary::pow(to / from, part) : from + part * (to - from);
    axis.values.push_back(six_digits(si / axis.si));
  }
  if (std::adjacent_find(axis.values.begin(), axis.values.end(), std::greater_equal<>()) != axis.values.end())
    throw of_key(InputError("the values are too near each other for six digits"));
  return axis;
}

std::string axis_key(const std::string& text) {
  return trimmed(text.substr(0, text.find('=')));
}

Axis parse_axis(const std::string& text, const io::Scene& scene) {
  if (text.find("..") == std::string::npos || text.rfind(':') == std::string::npos)
    throw InputError('"' + text + "\": " + k_form);
  const io::SceneNumber number = io::number_in(scene, axis_key(text));
  Axis axis = parse_axis(text, *number.key);
  axis.entry = number.entry;
  if (number.value) axis.own = *number.value / axis.si;
  return axis;
}

Axis axis_of(const std::string& option, const std::string& text, const io::Scene& scene) {
  try {
    return parse_axis(text, scene);
  } catch (const InputError& error) {
    std::string line = error.what();
    if (line.starts_with("--set ")) line.erase(0, 6);
    throw InputError(option + " " + line);
  }
}

void check_axes(const io::Scene& scene, const Axis& x, const Axis& y) {
  if (x.table == y.table && x.name == y.name && x.entry == y.entry)
    throw InputError("--y " + y.key + ": is the key of the x axis");
  for (const int i : {0, x.count() - 1}) check_end(scene, x, i, "--x");
  for (const int i : {0, y.count() - 1}) check_end(scene, y, i, "--y");
}

ordered_json as_json(const Axis& axis) {
  return {{"key", axis.key},
          {"unit", axis.unit},
          {"spacing", axis.logarithmic ? "logarithmic" : "linear"},
          {"scene", axis.own ? ordered_json(*axis.own) : ordered_json(nullptr)},
          {"values", axis.values}};
}

ordered_json settings_of(const std::string& study, const io::Scene& scene, const Axis& x, const Axis& y) {
  return {{"study", study},
          {"scene", scene.name},
          {"x", x.key},
          {"x values", x.values},
          {"y", y.key},
          {"y values", y.values},
          {"scene text", scene.text},
          {"files", fingerprints(scene.files)}};
}

std::vector<int> coarse_to_fine(int nx, int ny) {
  struct Place {
    int stride;
    double shuffle;
    int point;
  };
  std::vector<Place> places;
  const int coarsest =
      std::max(1, static_cast<int>(std::bit_floor(static_cast<unsigned>(std::max(nx, ny)))) / 2);
  const auto stride_of = [&](int i, int n) {
    if (i == 0 || i == n - 1) return coarsest;
    return std::min(coarsest, i & -i);  // the greatest power of two that divides it
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      places.push_back({std::min(stride_of(i, nx), stride_of(j, ny)),
                        scattered(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)), j * nx + i});
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    if (a.stride != b.stride) return a.stride > b.stride;
    return a.shuffle != b.shuffle ? a.shuffle < b.shuffle : a.point < b.point;
  });
  std::vector<int> order;
  order.reserve(places.size());
  for (const Place& place : places) order.push_back(place.point);
  return order;
}

double scattered(std::uint64_t a, std::uint64_t b) {
  const auto mixed = [](std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  };
  return static_cast<double>(mixed(mixed(a) ^ b) >> 11) * 0x1p-53;
}

}  // namespace topple::study
