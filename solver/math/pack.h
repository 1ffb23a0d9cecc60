// Packs of four doubles that the processor works on at once (SIMD), and vectors, matrices and rotations of
// packs. P: Four, or double for one.
#pragma once

#include <array>
#include <cmath>
#include <cstring>

#include "solver/math/fused.h"
#include "solver/math/types.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace topple {

/// a b + c, rounded once; twice by WebAssembly, which has no such instruction, and where the same bits would
/// cost 20 times a product: a live page has hashes of its own.
[[gnu::always_inline]] inline double mul_add(double a, double b, double c) {
#if defined(__wasm__)
  return a * b + c;
#elif defined(__FMA__) || defined(__aarch64__)
  return std::fma(a, b, c);
#else
  return fused_multiply_add(Two{a, a}, Two{b, b}, Two{c, c})[0];
#endif
}
/// c - a b, rounded as mul_add.
[[gnu::always_inline]] inline double less_product(double c, double a, double b) {
  return mul_add(-a, b, c);
}

/// a > b, or one of them is NaN. This and the next three do for one number what those of Four do per lane.
[[gnu::always_inline]] inline bool any_above(double a, double b) {
  return !(a <= b);
}
[[gnu::always_inline]] inline double with_sign_of(double a, double b) {
  return std::copysign(a, b);
}
[[gnu::always_inline]] inline double choose(bool mask, double a, double b) {
  return mask ? a : b;
}
[[gnu::always_inline]] inline bool holds_where(bool mask, bool where) {
  return mask || !where;
}

using FourMask = long long __attribute__((vector_size(32)));  ///< per lane all bits or none

/// Bit k is set where lane k is.
[[gnu::always_inline]] inline unsigned bits(FourMask mask) {
#ifdef __AVX2__
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#else
  return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
#endif
}
inline constexpr unsigned k_all_lanes = 15;
/// `mask` is set in all lanes in which `where` is.
[[gnu::always_inline]] inline bool holds_where(FourMask mask, FourMask where) {
  return bits(mask | ~where) == k_all_lanes;
}

/// Four doubles as a GNU vector: the same operations and bits in every build type and on every processor. The
/// AVX2 and FMA instructions that compilers do not find by themselves are named.
struct Four {
  using Vector = double __attribute__((vector_size(32)));
  using Mask = FourMask;
  Vector v;

  Four() = default;
  [[gnu::always_inline]] Four(Vector of) : v(of) {}
  [[gnu::always_inline]] Four(double all) : v{all, all, all, all} {}
  double operator[](int lane) const { return v[lane]; }
  void set(int lane, double value) { v[lane] = value; }

  [[gnu::always_inline]] friend Four operator+(Four a, Four b) { return a.v + b.v; }
  [[gnu::always_inline]] friend Four operator-(Four a, Four b) { return a.v - b.v; }
  [[gnu::always_inline]] friend Four operator*(Four a, Four b) { return a.v * b.v; }
  [[gnu::always_inline]] friend Four operator/(Four a, Four b) { return a.v / b.v; }
  [[gnu::always_inline]] friend Four operator-(Four a) { return -a.v; }
  [[gnu::always_inline]] Four& operator+=(Four b) { return v += b.v, *this; }
  [[gnu::always_inline]] Four& operator-=(Four b) { return v -= b.v, *this; }
  [[gnu::always_inline]] friend Four operator|(Four a, Four b) { return Vector(Mask(a.v) | Mask(b.v)); }
  [[gnu::always_inline]] friend Mask operator<(Four a, Four b) { return a.v < b.v; }
  [[gnu::always_inline]] friend Mask operator<=(Four a, Four b) { return a.v <= b.v; }
  [[gnu::always_inline]] friend Mask operator==(Four a, Four b) { return a.v == b.v; }
#ifdef __AVX2__
  [[gnu::always_inline]] friend Four sqrt(Four a) {
    return Vector(_mm256_sqrt_pd(a.v));
  }
#else
  [[gnu::always_inline]] friend Four sqrt(Four a) {
    return Vector{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
  }
#endif
#ifdef __FMA__
  [[gnu::always_inline]] friend Four mul_add(Four a, Four b, Four c) {
    return Vector(_mm256_fmadd_pd(a.v, b.v, c.v));
  }
  [[gnu::always_inline]] friend Four less_product(Four c, Four a, Four b) {
    return Vector(_mm256_fnmadd_pd(a.v, b.v, c.v));
  }
#else
#if defined(__wasm__)
  [[gnu::always_inline]] friend Four mul_add(Four a, Four b, Four c) {
    return a.v * b.v + c.v;
  }
#elif defined(__aarch64__)
  [[gnu::always_inline]] friend Four mul_add(Four a, Four b, Four c) {
    return Vector{std::fma(a[0], b[0], c[0]), std::fma(a[1], b[1], c[1]), std::fma(a[2], b[2], c[2]),
                  std::fma(a[3], b[3], c[3])};
  }
#else
  [[gnu::always_inline]] friend Four mul_add(Four a, Four b, Four c) {
    const Two low = fused_multiply_add(Two{a[0], a[1]}, Two{b[0], b[1]}, Two{c[0], c[1]});
    const Two high = fused_multiply_add(Two{a[2], a[3]}, Two{b[2], b[3]}, Two{c[2], c[3]});
    return Vector{low[0], low[1], high[0], high[1]};
  }
#endif
  [[gnu::always_inline]] friend Four less_product(Four c, Four a, Four b) {
    return mul_add(-a, b, c);
  }
#endif
  /// a where the mask is set, else b.
  [[gnu::always_inline]] friend Four choose(Mask mask, Four a, Four b) {
    return mask ? a.v : b.v;
  }
  /// Bit k: lane k of a is above b, or is not a number.
  [[gnu::always_inline]] friend int lanes_above(Four a, double b) {
    return static_cast<int>(bits(~(a <= Four(b))));
  }
  /// Some lane of a is above b, or is not a number.
  [[gnu::always_inline]] friend bool any_above(Four a, double b) {
    return lanes_above(a, b) != 0;
  }
  /// a with the sign that b has.
  [[gnu::always_inline]] friend Four with_sign_of(Four a, Four b) {
    const Mask sign = Mask(Four(-0.).v);
    return Vector((Mask(a.v) & ~sign) | (Mask(b.v) & sign));
  }
};

/// Four numbers in a row, of any alignment.
[[gnu::always_inline]] inline Four load(const double* from) {
  Four to;
  std::memcpy(&to.v, from, sizeof to.v);
  return to;
}
[[gnu::always_inline]] inline void store(double* to, Four value) {
  std::memcpy(to, &value.v, sizeof value.v);
}
/// Sum of the lanes, in their order.
[[gnu::always_inline]] inline double sum(Four a) {
  return a[0] + a[1] + a[2] + a[3];
}
/// Transposes the 4 x 4 matrix of the rows a, b, c, d.
[[gnu::always_inline]] inline void transpose(Four& a, Four& b, Four& c, Four& d) {
  const Four::Vector ab0 = __builtin_shufflevector(a.v, b.v, 0, 4, 2, 6),
                     ab1 = __builtin_shufflevector(a.v, b.v, 1, 5, 3, 7);
  const Four::Vector cd0 = __builtin_shufflevector(c.v, d.v, 0, 4, 2, 6),
                     cd1 = __builtin_shufflevector(c.v, d.v, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

/// A vector in space per lane.
template <class P>
struct PackVector {
  P x, y, z;

  [[gnu::always_inline]] friend PackVector operator+(const PackVector& a, const PackVector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[gnu::always_inline]] friend PackVector operator-(const PackVector& a, const PackVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[gnu::always_inline]] friend PackVector operator-(const PackVector& a) { return {-a.x, -a.y, -a.z}; }
  [[gnu::always_inline]] friend PackVector operator*(P f, const PackVector& a) {
    return {f * a.x, f * a.y, f * a.z};
  }
};

template <class P>
[[gnu::always_inline]] inline P dot(const PackVector<P>& a, const PackVector<P>& b) {
  return mul_add(a.z, b.z, mul_add(a.y, b.y, a.x * b.x));
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> cross(const PackVector<P>& a, const PackVector<P>& b) {
  return {less_product(a.y * b.z, a.z, b.y), less_product(a.z * b.x, a.x, b.z),
          less_product(a.x * b.y, a.y, b.x)};
}
/// Component by component.
template <class P>
[[gnu::always_inline]] inline PackVector<P> times(const PackVector<P>& a, const PackVector<P>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// f a + b
template <class P>
[[gnu::always_inline]] inline PackVector<P> mul_add(P f, const PackVector<P>& a, const PackVector<P>& b) {
  return {mul_add(f, a.x, b.x), mul_add(f, a.y, b.y), mul_add(f, a.z, b.z)};
}

/// A 3 x 3 matrix per lane, by rows.
template <class P>
struct PackMatrix {
  PackVector<P> row[3];

  [[gnu::always_inline]] friend PackMatrix operator+(const PackMatrix& a, const PackMatrix& b) {
    return {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}};
  }
  [[gnu::always_inline]] friend PackMatrix operator-(const PackMatrix& a, const PackMatrix& b) {
    return {{a.row[0] - b.row[0], a.row[1] - b.row[1], a.row[2] - b.row[2]}};
  }
  [[gnu::always_inline]] friend PackMatrix operator-(const PackMatrix& a) {
    return {{-a.row[0], -a.row[1], -a.row[2]}};
  }
  [[gnu::always_inline]] friend PackVector<P> operator*(const PackMatrix& a, const PackVector<P>& v) {
    return {dot(a.row[0], v), dot(a.row[1], v), dot(a.row[2], v)};
  }
  [[gnu::always_inline]] friend PackMatrix operator*(const PackMatrix& a, const PackMatrix& b) {
    const auto times_b = [&](const PackVector<P>& r) {
      return mul_add(r.z, b.row[2], mul_add(r.y, b.row[1], r.x * b.row[0]));
    };
    return {{times_b(a.row[0]), times_b(a.row[1]), times_b(a.row[2])}};
  }
};

template <class P>
[[gnu::always_inline]] inline PackMatrix<P> transposed(const PackMatrix<P>& a) {
  return {{{a.row[0].x, a.row[1].x, a.row[2].x},
           {a.row[0].y, a.row[1].y, a.row[2].y},
           {a.row[0].z, a.row[1].z, a.row[2].z}}};
}
/// a^T v
template <class P>
[[gnu::always_inline]] inline PackVector<P> transposed_times(const PackMatrix<P>& a, const PackVector<P>& v) {
  return mul_add(v.z, a.row[2], mul_add(v.y, a.row[1], v.x * a.row[0]));
}

template <class P>
[[gnu::always_inline]] inline PackMatrix<P> operator*(P f, const PackMatrix<P>& a) {
  return {{f * a.row[0], f * a.row[1], f * a.row[2]}};
}
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> diagonal(const PackVector<P>& d) {
  const P o(0);
  return {{{d.x, o, o}, {o, d.y, o}, {o, o, d.z}}};
}
/// [v]
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> skew(const PackVector<P>& v) {
  const P o(0);
  return {{{o, -v.z, v.y}, {v.z, o, -v.x}, {-v.y, v.x, o}}};
}
/// a [v]
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> times_skew(const PackMatrix<P>& a, const PackVector<P>& v) {
  return {{cross(a.row[0], v), cross(a.row[1], v), cross(a.row[2], v)}};
}
/// [v] a
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> skew_times(const PackVector<P>& v, const PackMatrix<P>& a) {
  return {
      {v.y * a.row[2] - v.z * a.row[1], v.z * a.row[0] - v.x * a.row[2], v.x * a.row[1] - v.y * a.row[0]}};
}
/// Adjugate and determinant of m: m^-1 = matrix / determinant.
template <class P>
struct PackAdjugate {
  PackMatrix<P> matrix;
  P determinant;
  [[gnu::always_inline]] explicit PackAdjugate(const PackMatrix<P>& m) {
    const PackVector<P> a = cross(m.row[1], m.row[2]), b = cross(m.row[2], m.row[0]),
                        c = cross(m.row[0], m.row[1]);
    matrix = transposed(PackMatrix<P>{{a, b, c}});
    determinant = dot(m.row[0], a);
  }
};
/// a b^T
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> outer(const PackVector<P>& a, const PackVector<P>& b) {
  return {{a.x * b, a.y * b, a.z * b}};
}
/// r diag(d) r^T
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> spread(const PackMatrix<P>& r, const PackVector<P>& d) {
  const PackVector<P> x = times(d, r.row[0]), y = times(d, r.row[1]), z = times(d, r.row[2]);
  const P xy = dot(x, r.row[1]), xz = dot(x, r.row[2]), yz = dot(y, r.row[2]);
  return {{{dot(x, r.row[0]), xy, xz}, {xy, dot(y, r.row[1]), yz}, {xz, yz, dot(z, r.row[2])}}};
}
/// r m r^T
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> spread(const PackMatrix<P>& r, const PackMatrix<P>& m) {
  return r * m * transposed(r);
}
/// [v]^2
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> double_cross(const PackVector<P>& v) {
  const P xx = v.x * v.x, yy = v.y * v.y, zz = v.z * v.z;
  const P xy = v.x * v.y, xz = v.x * v.z, yz = v.y * v.z;
  return {{{-(yy + zz), xy, xz}, {xy, -(xx + zz), yz}, {xz, yz, -(xx + yy)}}};
}
/// a I + b [v] + c [v]^2; `square`: [v]^2, double_cross(v).
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> polynomial_of(const PackVector<P>& v, const PackMatrix<P>& square,
                                                          P a, P b, P c) {
  return diagonal(PackVector<P>{a, a, a}) + b * skew(v) + c * square;
}
/// d/dv of [v]^2 w with w held
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> derivative_of_double_cross(const PackVector<P>& v,
                                                                       const PackVector<P>& w) {
  const P along = dot(v, w);
  return diagonal(PackVector<P>{along, along, along}) + outer(v, w) - P(2) * outer(w, v);
}

/// A rotation: w + x i + y j + z k, of length 1.
template <class P>
struct PackQuaternion {
  PackVector<P> v;
  P w;

  [[gnu::always_inline]] friend PackQuaternion operator*(const PackQuaternion& a, const PackQuaternion& b) {
    return {mul_add(a.w, b.v, mul_add(b.w, a.v, cross(a.v, b.v))),
            less_product(less_product(less_product(a.w * b.w, a.v.x, b.v.x), a.v.y, b.v.y), a.v.z, b.v.z)};
  }
};

template <class P>
[[gnu::always_inline]] inline PackQuaternion<P> conjugate(const PackQuaternion<P>& q) {
  return {-q.v, q.w};
}
/// q of length 1, given one that is off by rounding only: 1/|q| by one Newton step, (3 - |q|^2)/2.
template <class P>
[[gnu::always_inline]] inline PackQuaternion<P> normalized(const PackQuaternion<P>& q) {
  const P inverse = less_product(P(1.5), P(0.5), mul_add(q.w, q.w, dot(q.v, q.v)));
  return {inverse * q.v, inverse * q.w};
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> rotate(const PackQuaternion<P>& q, const PackVector<P>& a) {
  const PackVector<P> once = cross(q.v, a), twice = once + once;
  return mul_add(q.w, twice, a) + cross(q.v, twice);
}
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> rotation_matrix(const PackQuaternion<P>& q) {
  const PackVector<P> two = q.v + q.v, wv = q.w * two;
  const P xx = q.v.x * two.x, yy = q.v.y * two.y, zz = q.v.z * two.z;
  const P xy = q.v.x * two.y, yz = q.v.y * two.z, xz = q.v.z * two.x;
  const P one(1);
  return {{{one - (yy + zz), xy - wv.z, xz + wv.y},
           {xy + wv.z, one - (xx + zz), yz - wv.x},
           {xz - wv.y, yz + wv.x, one - (xx + yy)}}};
}

/// Polynomial in x, the lowest coefficient first.
template <class P, class... Rest>
[[gnu::always_inline]] inline P polynomial(P x, double first, Rest... rest) {
  if constexpr (sizeof...(rest) == 0)
    return P(first);
  else
    return mul_add(x, polynomial(x, rest...), P(first));
}

/// The values of four nodes, one per lane.
[[gnu::always_inline]] inline PackVector<Four> gather(const Vec3* x, const std::array<int, 4>& node) {
  const auto two = [x](int a, int b) {
    Two of_a, of_b;  // the first two numbers of each
    std::memcpy(&of_a, x[a].data(), sizeof of_a);
    std::memcpy(&of_b, x[b].data(), sizeof of_b);
    return __builtin_shufflevector(of_a, of_b, 0, 1, 2, 3);
  };
  const Four::Vector ac = two(node[0], node[2]), bd = two(node[1], node[3]);
  return {Four(__builtin_shufflevector(ac, bd, 0, 4, 2, 6)),
          Four(__builtin_shufflevector(ac, bd, 1, 5, 3, 7)),
          Four::Vector{x[node[0]].z(), x[node[1]].z(), x[node[2]].z(), x[node[3]].z()}};
}

[[gnu::always_inline]] inline PackQuaternion<Four> gather(const Quat* q, const std::array<int, 4>& node) {
  PackQuaternion<Four> out{
      {load(q[node[0]].coeffs().data()), load(q[node[1]].coeffs().data()), load(q[node[2]].coeffs().data())},
      load(q[node[3]].coeffs().data())};
  transpose(out.v.x, out.v.y, out.v.z, out.w);
  return out;
}

/// The vector (x, y, z, 0) of each lane.
[[gnu::always_inline]] inline std::array<Four, 4> lanes(const PackVector<Four>& v) {
  std::array<Four, 4> rows{v.x, v.y, v.z, Four(0)};
  transpose(rows[0], rows[1], rows[2], rows[3]);
  return rows;
}

/// The first three numbers of `lane`.
[[gnu::always_inline]] inline void store_three(double* to, Four lane) {
  const auto first = __builtin_shufflevector(lane.v, lane.v, 0, 1);
  std::memcpy(to, &first, sizeof first);
  to[2] = lane[2];
}

/// Writes lane k to x[node[k]], in the order of the lanes.
[[gnu::always_inline]] inline void scatter(const PackVector<Four>& v, Vec3* x,
                                           const std::array<int, 4>& node) {
  const std::array<Four, 4> rows = lanes(v);
  for (int k = 0; k < 4; ++k) store_three(x[node[k]].data(), rows[k]);
}

[[gnu::always_inline]] inline void scatter(PackQuaternion<Four> q, Quat* x, const std::array<int, 4>& node) {
  transpose(q.v.x, q.v.y, q.v.z, q.w);
  store(x[node[0]].coeffs().data(), q.v.x);
  store(x[node[1]].coeffs().data(), q.v.y);
  store(x[node[2]].coeffs().data(), q.v.z);
  store(x[node[3]].coeffs().data(), q.w);
}

/// The same in all lanes.
[[gnu::always_inline]] inline PackVector<Four> in_all_lanes(const Vec3& v) {
  return {Four(v.x()), Four(v.y()), Four(v.z())};
}
[[gnu::always_inline]] inline PackVector<Four> in_all_lanes(const PackVector<double>& v) {
  return {Four(v.x), Four(v.y), Four(v.z)};
}
[[gnu::always_inline]] inline PackMatrix<Four> in_all_lanes(const PackMatrix<double>& m) {
  return {{in_all_lanes(m.row[0]), in_all_lanes(m.row[1]), in_all_lanes(m.row[2])}};
}
[[gnu::always_inline]] inline PackVector<double> packed(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
[[gnu::always_inline]] inline PackMatrix<double> packed(const Mat3& m) {
  return {{{m(0, 0), m(0, 1), m(0, 2)}, {m(1, 0), m(1, 1), m(1, 2)}, {m(2, 0), m(2, 1), m(2, 2)}}};
}
[[gnu::always_inline]] inline PackQuaternion<double> packed(const Quat& q) {
  return {{q.x(), q.y(), q.z()}, q.w()};
}
[[gnu::always_inline]] inline Vec3 unpacked(const PackVector<double>& v) {
  return {v.x, v.y, v.z};
}
inline Mat3 unpacked(const PackMatrix<double>& m) {
  Mat3 out;
  for (int row = 0; row < 3; ++row) out.row(row) = unpacked(m.row[row]);
  return out;
}
[[gnu::always_inline]] inline PackVector<Four> operator*(const Mat3& m, const PackVector<Four>& a) {
  const auto row = [&](int i) { return Four(m(i, 0)) * a.x + Four(m(i, 1)) * a.y + Four(m(i, 2)) * a.z; };
  return {row(0), row(1), row(2)};
}
/// The sums over the lanes of a, b, c and d, each as (0 + 1) + (2 + 3).
[[gnu::always_inline]] inline Four sums(Four a, Four b, Four c, Four d) {
  transpose(a, b, c, d);
  return (a + b) + (c + d);
}
/// Sum over the lanes.
[[gnu::always_inline]] inline PackMatrix<double> sum(const PackMatrix<Four>& m) {
  const auto& [a, b, c] = m.row;
  const Four first = sums(a.x, a.y, a.z, b.x), second = sums(b.y, b.z, c.x, c.y);
  return {
      {{first[0], first[1], first[2]}, {first[3], second[0], second[1]}, {second[2], second[3], sum(c.z)}}};
}

[[gnu::always_inline]] inline Vec3 lane(const PackVector<Four>& v, int k) {
  return {v.x[k], v.y[k], v.z[k]};
}

[[gnu::always_inline]] inline void set_lane(PackVector<Four>& v, int k, const Vec3& value) {
  v.x.set(k, value.x());
  v.y.set(k, value.y());
  v.z.set(k, value.z());
}

[[gnu::always_inline]] inline void set_lane(PackMatrix<Four>& m, int k, const Mat3& value) {
  for (int row = 0; row < 3; ++row) set_lane(m.row[row], k, value.row(row));
}

}  // namespace topple
