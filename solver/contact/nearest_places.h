// Where two segments are nearest, of one pair or of four at a time.
#pragma once

#include "solver/math/pack.h"

namespace topple {

/// s and t of one pair of segments (P: double) or of four (Four), with u = a1 - a0, v = b1 - b0, r = a0 - b0.
template <class P>
struct NearestPlaces {
  P s, t;
};
template <class P>
[[gnu::always_inline]] inline P within_segment(P x) {
  return choose(x < P(0), P(0), choose(P(1) < x, P(1), x));
}
template <class P>
[[gnu::always_inline]] inline NearestPlaces<P> nearest_places(const PackVector<P>& u, const PackVector<P>& v,
                                                              const PackVector<P>& r) {
  const P uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
  const P square = uu * vv, det = square - uv * uv;
  // of parallel lines any pair of points opposite each other is nearest
  P s = choose(P(1e-14) * square < det, within_segment((uv * vr - vv * ur) / det), P(0.5));
  P t = within_segment((uv * s + vr) / vv);
  s = within_segment((uv * t - ur) / uu);
  t = within_segment((uv * s + vr) / vv);
  return {s, t};
}

}  // namespace topple
