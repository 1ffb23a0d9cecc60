// Eq. 2 of the paper over alpha, at one contact (template argument P: double) or four (Four), for
// depth = 1 - l/L > 0.
#pragma once

#include <type_traits>

#include "solver/math/elementary.h"
#include "solver/math/pack.h"

namespace topple {

/// depth^q: P over alpha.
template <class P>
[[gnu::always_inline]] inline P penalty_power(P depth, double q) {
  if (q == 1) return depth;
  if (q == 2) return depth * depth;
  if constexpr (std::is_same_v<P, double>) {
    return elementary::pow(depth, q);
  } else {
    for (int i = 0; i < 4; ++i) depth.set(i, elementary::pow(depth[i], q));
    return depth;
  }
}

/// Its slope by depth, q depth^(q - 1).
template <class P>
[[gnu::always_inline]] inline P penalty_slope(P depth, double q) {
  return q == 1 ? P(1) : q * penalty_power(depth, q - 1);
}

}  // namespace topple
