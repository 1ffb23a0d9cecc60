// Four doubles that are worked on together, and vectors, matrices and rotations of such packs.
#pragma once

#include <immintrin.h>

namespace topple {

/// GNU vectors: the same operations in every build type.
struct Four {
  using Vector = double __attribute__((vector_size(32)));
  Vector v;

  Four() = default;
  Four(Vector of) : v(of) {}
  Four(double all) : v{all, all, all, all} {}
  double operator[](int lane) const { return v[lane]; }
  void set(int lane, double value) { v[lane] = value; }

  friend Four operator+(Four a, Four b) { return a.v + b.v; }
  friend Four operator-(Four a, Four b) { return a.v - b.v; }
  friend Four operator*(Four a, Four b) { return a.v * b.v; }
  friend Four operator/(Four a, Four b) { return a.v / b.v; }
  friend Four operator-(Four a) { return -a.v; }
  friend Four sqrt(Four a) { return Vector(_mm256_sqrt_pd(a.v)); }
  /// Some lane of a is above b, or is not a number.
  friend bool any_above(Four a, double b) {
    return _mm256_movemask_pd(_mm256_cmp_pd(a.v, Four(b).v, _CMP_NLE_UQ)) != 0;
  }
  /// a with the sign that b has.
  friend Four with_sign_of(Four a, Four b) {
    const __m256d sign = _mm256_set1_pd(-0.);
    return Vector(_mm256_or_pd(_mm256_andnot_pd(sign, a.v), _mm256_and_pd(sign, b.v)));
  }
};

inline Four load(const double* from) {
  return Four::Vector(_mm256_loadu_pd(from));
}
inline void store(double* to, Four value) {
  _mm256_storeu_pd(to, value.v);
}
/// In the order of the lanes.
inline double sum(Four a) {
  return a[0] + a[1] + a[2] + a[3];
}
/// Rows become columns.
inline void transpose(Four& a, Four& b, Four& c, Four& d) {
  const __m256d ab0 = _mm256_unpacklo_pd(a.v, b.v), ab1 = _mm256_unpackhi_pd(a.v, b.v);
  const __m256d cd0 = _mm256_unpacklo_pd(c.v, d.v), cd1 = _mm256_unpackhi_pd(c.v, d.v);
  a = Four::Vector(_mm256_permute2f128_pd(ab0, cd0, 0x20));
  b = Four::Vector(_mm256_permute2f128_pd(ab1, cd1, 0x20));
  c = Four::Vector(_mm256_permute2f128_pd(ab0, cd0, 0x31));
  d = Four::Vector(_mm256_permute2f128_pd(ab1, cd1, 0x31));
}

template <class P>
struct PackVector {
  P x, y, z;

  friend PackVector operator+(const PackVector& a, const PackVector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend PackVector operator-(const PackVector& a, const PackVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend PackVector operator-(const PackVector& a) { return {-a.x, -a.y, -a.z}; }
  friend PackVector operator*(P f, const PackVector& a) { return {f * a.x, f * a.y, f * a.z}; }
};

template <class P>
P dot(const PackVector<P>& a, const PackVector<P>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class P>
PackVector<P> cross(const PackVector<P>& a, const PackVector<P>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class P>
PackVector<P> times(const PackVector<P>& a, const PackVector<P>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Rows.
template <class P>
struct PackMatrix {
  PackVector<P> row[3];

  friend PackMatrix operator+(const PackMatrix& a, const PackMatrix& b) {
    return {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}};
  }
  friend PackMatrix operator-(const PackMatrix& a, const PackMatrix& b) {
    return {{a.row[0] - b.row[0], a.row[1] - b.row[1], a.row[2] - b.row[2]}};
  }
  friend PackMatrix operator-(const PackMatrix& a) { return {{-a.row[0], -a.row[1], -a.row[2]}}; }
  friend PackVector<P> operator*(const PackMatrix& a, const PackVector<P>& v) {
    return {dot(a.row[0], v), dot(a.row[1], v), dot(a.row[2], v)};
  }
  friend PackMatrix operator*(const PackMatrix& a, const PackMatrix& b) {
    const auto row = [&](const PackVector<P>& r) { return r.x * b.row[0] + r.y * b.row[1] + r.z * b.row[2]; };
    return {{row(a.row[0]), row(a.row[1]), row(a.row[2])}};
  }
};

template <class P>
PackMatrix<P> transposed(const PackMatrix<P>& a) {
  return {{{a.row[0].x, a.row[1].x, a.row[2].x},
           {a.row[0].y, a.row[1].y, a.row[2].y},
           {a.row[0].z, a.row[1].z, a.row[2].z}}};
}
/// a^T v
template <class P>
PackVector<P> transposed_times(const PackMatrix<P>& a, const PackVector<P>& v) {
  return v.x * a.row[0] + v.y * a.row[1] + v.z * a.row[2];
}

/// A rotation: w + x i + y j + z k, of length 1.
template <class P>
struct PackQuaternion {
  PackVector<P> v;
  P w;

  friend PackQuaternion operator*(const PackQuaternion& a, const PackQuaternion& b) {
    return {a.w * b.v + b.w * a.v + cross(a.v, b.v), a.w * b.w - dot(a.v, b.v)};
  }
};

template <class P>
PackQuaternion<P> conjugate(const PackQuaternion<P>& q) {
  return {-q.v, q.w};
}
template <class P>
PackVector<P> rotate(const PackQuaternion<P>& q, const PackVector<P>& a) {
  const PackVector<P> once = cross(q.v, a), twice = once + once;
  return a + q.w * twice + cross(q.v, twice);
}
template <class P>
PackMatrix<P> rotation_matrix(const PackQuaternion<P>& q) {
  const PackVector<P> two = q.v + q.v, wv = q.w * two;
  const P xx = q.v.x * two.x, yy = q.v.y * two.y, zz = q.v.z * two.z;
  const P xy = q.v.x * two.y, yz = q.v.y * two.z, xz = q.v.z * two.x;
  const P one(1);
  return {{{one - (yy + zz), xy - wv.z, xz + wv.y},
           {xy + wv.z, one - (xx + zz), yz - wv.x},
           {xz - wv.y, yz + wv.x, one - (xx + yy)}}};
}

}  // namespace topple
