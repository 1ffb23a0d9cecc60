#include "solver/io/common/units.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "solver/io/common/digits.h"
#include "solver/math/types.h"

namespace topple::io {

const std::vector<Unit>& units() {
  using D = Dimension;
  static const std::vector<Unit> table{
      {"m", D::length, 1},
      {"cm", D::length, 1e-2},
      {"mm", D::length, 1e-3},
      {"km", D::length, 1e3},
      {"s", D::time, 1},
      {"ms", D::time, 1e-3},
      {"us", D::time, 1e-6},
      {"min", D::time, 60},
      {"kg", D::mass, 1},
      {"g", D::mass, 1e-3},
      {"t", D::mass, 1e3},
      {"N", D::force, 1},
      {"kN", D::force, 1e3},
      {"MN", D::force, 1e6},
      {"kgf", D::force, k_standard_gravity},
      {"Pa", D::stress, 1},
      {"kPa", D::stress, 1e3},
      {"MPa", D::stress, 1e6},
      {"GPa", D::stress, 1e9},
      {"N/mm^2", D::stress, 1e6},
      {"m/s^2", D::acceleration, 1},
      {"cm/s^2", D::acceleration, 1e-2},
      {"gal", D::acceleration, k_gal},
      {"g", D::acceleration, k_standard_gravity},
      {"m/s", D::velocity, 1},
      {"cm/s", D::velocity, 1e-2},
      {"mm/s", D::velocity, 1e-3},
      {"Hz", D::frequency, 1},
      {"rad", D::angle, 1},
      {"deg", D::angle, k_pi / 180},
      {"kg/m^3", D::density, 1},
      {"t/m^3", D::density, 1e3},
      {"m^2", D::area, 1},
      {"cm^2", D::area, 1e-4},
      {"mm^2", D::area, 1e-6},
      {"m^4", D::second_moment, 1},
      {"cm^4", D::second_moment, 1e-8},
      {"mm^4", D::second_moment, 1e-12},
      {"m^3", D::section_modulus, 1},
      {"cm^3", D::section_modulus, 1e-6},
      {"mm^3", D::section_modulus, 1e-9},
      {"rad/s", D::angular_velocity, 1},
      {"deg/s", D::angular_velocity, k_pi / 180},
      {"kg m^2", D::inertia, 1},
      {"N m", D::moment, 1},
      {"kN m", D::moment, 1e3},
      {"N/m", D::stiffness, 1},
      {"kN/m", D::stiffness, 1e3},
      {"MN/m", D::stiffness, 1e6},
      {"N/mm", D::stiffness, 1e3},
  };
  return table;
}

double unit_value(std::string_view symbol, Dimension dimension) {
  for (const Unit& unit : units()) {
    if (unit.symbol == symbol && unit.dimension == dimension) return unit.si;
  }
  return 1;
}

std::string_view dimension_name(Dimension dimension) {
  switch (dimension) {
    case Dimension::none:
      return "a plain number";
    case Dimension::length:
      return "a length";
    case Dimension::time:
      return "a time";
    case Dimension::mass:
      return "a mass";
    case Dimension::force:
      return "a force";
    case Dimension::stress:
      return "a stress";
    case Dimension::acceleration:
      return "an acceleration";
    case Dimension::velocity:
      return "a velocity";
    case Dimension::frequency:
      return "a frequency";
    case Dimension::angle:
      return "an angle";
    case Dimension::density:
      return "a density";
    case Dimension::area:
      return "an area";
    case Dimension::second_moment:
      return "a second moment of area";
    case Dimension::section_modulus:
      return "a section modulus";
    case Dimension::angular_velocity:
      return "an angular velocity";
    case Dimension::inertia:
      return "a moment of inertia";
    case Dimension::moment:
      return "a moment";
    case Dimension::stiffness:
      return "a stiffness";
  }
  return "";
}

std::string_view si_unit(Dimension dimension) {
  const auto first = std::find_if(units().begin(), units().end(),
                                  [&](const Unit& unit) { return unit.dimension == dimension; });
  return first == units().end() ? std::string_view() : first->symbol;
}

std::string unit_list(Dimension dimension) {
  std::string list;
  for (const Unit& unit : units()) {
    if (unit.dimension != dimension) continue;
    if (!list.empty()) list += ", ";
    list += unit.symbol;
  }
  return list;
}

namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::string expectation(Dimension expected) {
  std::string text = "expected " + std::string(dimension_name(expected));
  if (expected != Dimension::none) text += " (" + unit_list(expected) + ")";
  return text;
}

// "a mass or an acceleration" for g; empty for an unknown symbol.
std::string dimensions_of(std::string_view symbol) {
  std::string found;
  for (const Unit& unit : units()) {
    if (unit.symbol != symbol) continue;
    if (!found.empty()) found += " or ";
    found += dimension_name(unit.dimension);
  }
  return found;
}

}  // namespace

double in_si(double number, double unit) {
  // 70 cm is 70 / 100, correctly rounded; 70 * 0.01 is not
  return unit < 1 ? number / (1 / unit) : number * unit;
}

Quantity parse_quantity(std::string_view text, Dimension expected) {
  std::string_view rest = trimmed(text);
  if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
  double number = 0;
  const auto [end, status] = read_digits(rest.data(), rest.data() + rest.size(), number);
  if (status == std::errc::invalid_argument)
    return {{}, "is not a number with a unit, " + expectation(expected)};
  if (status != std::errc() || !std::isfinite(number)) return {{}, "is not a finite number"};

  const std::string_view symbol = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (symbol.empty()) {
    if (expected == Dimension::none) return {{}, "is text, expected a plain number: write it without quotes"};
    return {{}, "has no unit, " + expectation(expected) + ", or a number in SI without quotes"};
  }
  for (const Unit& unit : units()) {
    if (unit.symbol != symbol || unit.dimension != expected) continue;
    const double si = in_si(number, unit.si);
    if (!std::isfinite(si)) return {{}, "is not a finite number"};
    return {si, {}};
  }
  const std::string found = dimensions_of(symbol);
  if (!found.empty()) return {{}, "is " + found + ", " + expectation(expected)};
  if (symbol.front() == ',') return {{}, "has a comma: write a decimal point"};
  return {{}, "has an unknown unit \"" + std::string(symbol) + "\", " + expectation(expected)};
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value == 0 ? 0.0 : value);
  return text;
}

}  // namespace topple::io
