// Axes of a sweep: keys of a scene and the values that they take.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"
#include "solver/io/scene/scene_key.h"

namespace topple::study {

/// From this ratio of its ends on an axis with positive ends is logarithmic unless it says otherwise.
inline constexpr double k_wide = 5;
inline constexpr int k_most_values = 200;  ///< of an axis

/// Values of one key, ascending, in `unit`, rounded to six digits so that they can be repeated by --set.
struct Axis {
  std::string key;    ///< as of --set: "shake.1.frequency"
  std::string table;  ///< of the table of keys: "shake"
  std::string name;   ///< "frequency"
  std::string unit;   ///< "Hz"; empty: a plain number
  double si = 1;      ///< value of one unit
  int entry = -1;     ///< index in the array that holds it; -1: none does
  bool logarithmic = false;
  std::vector<double> values;
  std::optional<double> own;  ///< the scene's value, in `unit`

  int count() const { return static_cast<int>(values.size()); }
  double in_si(int i) const { return si * values[static_cast<std::size_t>(i)]; }
  /// Ends of the cells around the values, one more than these.
  std::vector<double> edges() const;
  /// "shake.1.frequency=0.5 Hz", as of --set.
  std::string change(int i) const { return change_to(values[static_cast<std::size_t>(i)]); }
  std::string change_to(double value) const;
};

/// Reads "KEY=FROM..TO:N", N = 2..k_most_values values from FROM to TO, each a number in SI or with a unit;
/// "log" or "lin" after N names the spacing, else it goes by k_wide. Throws io::InputError, which does not
/// say where the text stood.
Axis parse_axis(const std::string& text, const io::Scene& scene);

/// The same of a key that is none of a scene.
Axis parse_axis(const std::string& text, const io::Key& key);
/// KEY of such a text.
std::string axis_key(const std::string& text);

/// What `option`, "--x" or "--y", says; the error begins with it.
Axis axis_of(const std::string& option, const std::string& text, const io::Scene& scene);

/// Refuses axes of the same key, and ends that no scene can have: the key of a choice that was not made, for
/// instance. Throws io::InputError.
void check_axes(const io::Scene& scene, const Axis& x, const Axis& y);

nlohmann::ordered_json as_json(const Axis& axis);

/// What rows of a study over two axes depend on, for KeptRows.
nlohmann::ordered_json settings_of(const std::string& study, const io::Scene& scene, const Axis& x,
                                   const Axis& y);

/// Order of the points y nx + x of a grid: every s-th of both axes first, with s a power of two that halves
/// until it is 1, and the last of an axis always; in a shuffled order, always the same, within each s.
std::vector<int> coarse_to_fine(int nx, int ny);

/// A number that looks random, 0 <= u < 1, for each pair: the splitmix64 mix of both. The same everywhere.
double scattered(std::uint64_t a, std::uint64_t b);

}  // namespace topple::study
