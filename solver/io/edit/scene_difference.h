// What two scenes say differently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::io {

/// A key that differs, or an entry of an array that one of the scenes has alone.
struct SceneDifference {
  std::string key;  ///< "shake.table.amplitude"; an entry: "cabinet.free"
  /// The value with its unit, a default included; "present" for an entry. Absent: there is none.
  std::optional<std::string> a, b;
};

/// In the order of `a`, then what `b` has alone. Values are compared in SI: "0.19 g" and "186.3 gal" differ,
/// "190 gal" and "1.9 m/s^2" do not.
std::vector<SceneDifference> differences(const Scene& a, const Scene& b);

}  // namespace topple::io
