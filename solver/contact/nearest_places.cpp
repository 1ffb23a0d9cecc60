#include "solver/contact/nearest_places.h"

#include <algorithm>

namespace topple {

NearestPoints nearest_points(const Vec3& p, const Vec3& b0, const Vec3& b1) {
  const Vec3 along = b1 - b0;
  const double t = std::clamp((p - b0).dot(along) / along.squaredNorm(), 0., 1.);
  return {0, t, false, t > 0 && t < 1, p - b0 - t * along};
}

NearestPoints nearest_points(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const PackVector<double> u = packed(Vec3(a1 - a0)), v = packed(Vec3(b1 - b0)), r = packed(Vec3(a0 - b0));
  const auto [s, t] = nearest_places(u, v, r);
  return {s, t, s > 0 && s<1, t> 0 && t < 1, unpacked(r + s * u - t * v)};
}

}  // namespace topple
