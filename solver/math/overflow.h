// One test for both numbers above k_largest_number (types.h) and NaN or infinity: multiplied by k_overflow,
// the former become infinite too, and an infinite or undefined term makes a whole sum so.
#pragma once

#include <limits>

#include "solver/math/types.h"

namespace topple {

/// x * k_overflow is infinite for |x| > k_largest_number.
inline constexpr double k_overflow = std::numeric_limits<double>::max() / k_largest_number;

}  // namespace topple
