// Four doubles at once. GNU vectors: the same operations in every build type.
#pragma once

#include "solver/types.h"

namespace topple {

using Pack = double __attribute__((vector_size(32)));
using PackMask = long long __attribute__((vector_size(32)));
inline constexpr int k_lanes = 4;

inline Pack pack(double x) {
  return Pack{x, x, x, x};
}
inline double sum(Pack p) {
  return (p[0] + p[1]) + (p[2] + p[3]);
}
inline Pack square_root(Pack p) {
  return __builtin_ia32_sqrtpd256(p);
}
/// Bit i: lane i is set.
inline unsigned bits(PackMask m) {
  return static_cast<unsigned>(__builtin_ia32_movmskpd256(reinterpret_cast<Pack>(m)));
}
inline constexpr unsigned k_all_lanes = (1u << k_lanes) - 1;

/// Four vectors.
struct Pack3 {
  Pack x, y, z;
  Vec3 lane(int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, const Vec3& v) {
    x[i] = v.x();
    y[i] = v.y();
    z[i] = v.z();
  }
};

inline Pack3 pack3(const Vec3& v) {
  return {pack(v.x()), pack(v.y()), pack(v.z())};
}
inline Pack3 operator+(const Pack3& a, const Pack3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Pack3 operator-(const Pack3& a, const Pack3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Pack3 operator*(Pack s, const Pack3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Pack3 operator*(double s, const Pack3& a) {
  return pack(s) * a;
}
inline Pack dot(const Pack3& a, const Pack3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Pack3 cross(const Pack3& a, const Pack3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Pack3 operator*(const Mat3& m, const Pack3& a) {
  return {m(0, 0) * a.x + m(0, 1) * a.y + m(0, 2) * a.z, m(1, 0) * a.x + m(1, 1) * a.y + m(1, 2) * a.z,
          m(2, 0) * a.x + m(2, 1) * a.y + m(2, 2) * a.z};
}
inline Vec3 sum(const Pack3& a) {
  return {sum(a.x), sum(a.y), sum(a.z)};
}

}  // namespace topple
