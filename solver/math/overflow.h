// One test of many numbers for NaN, infinity and more than k_largest_number (types.h): the sum of all
// x * k_overflow is finite only when no x is any of these.
#pragma once

#include <limits>

#include "solver/math/types.h"

namespace topple {

/// Factor that makes |x| > k_largest_number infinite.
inline constexpr double k_overflow = std::numeric_limits<double>::max() / k_largest_number;

}  // namespace topple
