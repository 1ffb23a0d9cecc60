// What all parts of the program say of a scene in the same way.
#pragma once

#include "solver/run/run.h"

namespace topple::app {

inline constexpr double k_degrees = 180 / k_pi;  ///< in a radian

/// "strap", "bracket" or "pole", as files name it.
inline const char* anchor_type(const Anchor& anchor) {
  static const char* const k_types[] = {"strap", "bracket", "pole"};
  return k_types[static_cast<std::size_t>(anchor.type)];
}

/// Its rows go by load step and load factor, not by time.
inline bool is_static(const Setup& setup) {
  return setup.run.analysis == Analysis::statics;
}

}  // namespace topple::app
