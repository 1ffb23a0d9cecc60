// How numbers that are too large are found together with those that are none.
#pragma once

#include <limits>

#include "solver/math/types.h"

namespace topple {

/// Times it, what is above k_largest_number is infinite.
inline constexpr double k_overflow = std::numeric_limits<double>::max() / k_largest_number;

}  // namespace topple
