// Physical values of scene files: a number in SI, or a string of a number and a unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace topple::io {

/// What a value measures. `none` is a plain number.
enum class Dimension {
  none,
  length,
  time,
  mass,
  force,
  stress,
  acceleration,
  velocity,
  frequency,
  angle,
  density,
  area,
  second_moment,
  section_modulus,
  angular_velocity,
  inertia,
  moment,
  stiffness,
};

/// A unit symbol. Symbols are unique within a dimension only: g is a gram where a mass is expected and the
/// standard gravity where an acceleration is.
struct Unit {
  std::string_view symbol;
  Dimension dimension;
  double si;  ///< value of one unit in SI
};

/// All units; the first of each dimension is the SI one.
const std::vector<Unit>& units();

/// Value of one `symbol` in SI; 1 for an empty symbol. The symbol must be one of `dimension`.
double unit_value(std::string_view symbol, Dimension dimension);
/// `number` times `unit`, as scenes are read: 190 gal are the same number wherever they are said.
double in_si(double number, double unit);

/// "m", "m/s^2"; empty for a plain number.
std::string_view si_unit(Dimension dimension);

/// "a length", "an acceleration", "a plain number".
std::string_view dimension_name(Dimension dimension);

/// "m, cm, mm, km".
std::string unit_list(Dimension dimension);

/// A physical value read, or one sentence on why it could not be ("is a length, expected a force (N, kN, kgf,
/// MN)").
struct Quantity {
  std::optional<double> si;
  std::string problem;
};

/// Reads "190 gal". Spaces around number and unit are optional; a string without a unit is refused, and so is
/// what is not finite.
Quantity parse_quantity(std::string_view text, Dimension expected);

/// Shortest text that reads back as `value` to six digits: "0.001", "1e+06".
std::string short_number(double value);

}  // namespace topple::io
