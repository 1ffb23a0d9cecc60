// What all parts of the program say of a scene in the same way.
#pragma once

#include "solver/io/scene/scene_words.h"
#include "solver/model/table.h"
#include "solver/run/run.h"

namespace topple::app {

inline constexpr double k_degrees = 180 / k_pi;  ///< in a radian

/// "strap", "bracket" or "pole", as files name it.
inline const char* anchor_type(const Anchor& anchor) {
  return row_of(io::k_anchor_types, anchor.type).word;
}

/// Its rows go by load step and load factor, not by time.
inline bool is_static(const Setup& setup) {
  return setup.run.analysis == Analysis::statics;
}

}  // namespace topple::app
