// Where two segments are nearest, of one pair or of four at a time, and a point and a segment.
#pragma once

#include "solver/math/pack.h"
#include "solver/math/types.h"

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

/// Where two segments a0-a1 and b0-b1 are nearest: at a0 + s (a1 - a0) and b0 + t (b1 - b0), 0 <= s, t <= 1.
struct NearestPoints {
  double s, t;
  bool s_free, t_free;  ///< strictly between the ends: it slides along as the lines move
  Vec3 between;         ///< m, from the point on b to the point on a
};
NearestPoints nearest_points(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

/// The same for a point p in place of a; s = 0, not free.
NearestPoints nearest_points(const Vec3& p, const Vec3& b0, const Vec3& b1);

}  // namespace topple
