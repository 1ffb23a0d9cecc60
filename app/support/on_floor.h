// Of which bodies a slide over the floor is told.
#pragma once

#include "solver/model/model.h"

namespace topple::app {

inline constexpr double k_on_floor = 0.05;  ///< m, highest base of what stands on the floor, on feet or a mat

/// What stands on another body goes along with it.
inline bool slides_on_floor(const Body& body) {
  return body.base_centre.z() < k_on_floor;
}

}  // namespace topple::app
