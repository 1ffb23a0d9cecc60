// Eq. 2 of the paper over alpha, at one contact (template argument P: double) or four (Four), for
// depth = 1 - l/L > 0.
#pragma once

#include "solver/math/elementary.h"
#include "solver/math/pack.h"

namespace topple {

inline Four pow_lanes(Four x, double q) {
  for (int i = 0; i < 4; ++i) x.set(i, elementary::pow(x[i], q));
  return x;
}
inline double pow_lanes(double x, double q) {
  return elementary::pow(x, q);
}

/// depth^q: P over alpha.
template <class P>
[[gnu::always_inline]] inline P penalty_power(P depth, double q) {
  if (q == 1) return depth;
  if (q == 2) return depth * depth;
  return pow_lanes(depth, q);
}

/// Its slope by depth, q depth^(q - 1).
template <class P>
[[gnu::always_inline]] inline P penalty_slope(P depth, double q) {
  return q == 1 ? P(1) : q * penalty_power(depth, q - 1);
}

}  // namespace topple
