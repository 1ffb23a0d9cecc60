// Vector operations with the unit normal n of a plane: for any n (PackVector), and for n = (0, 0, 1)
// (Upwards) without the products with 0 and 1. A template over the type of the normal gives the same bits
// with both.
#pragma once

#include "solver/math/pack.h"

namespace topple {

/// (0, 0, 1)
struct Upwards {};

/// A vector (x, y, 0).
template <class P>
struct PackPlanar {
  P x, y;

  [[gnu::always_inline]] friend PackPlanar operator+(const PackPlanar& a, const PackPlanar& b) {
    return {a.x + b.x, a.y + b.y};
  }
  [[gnu::always_inline]] friend PackPlanar operator*(P f, const PackPlanar& a) { return {f * a.x, f * a.y}; }
};

template <class P>
[[gnu::always_inline]] inline P dot(const PackPlanar<P>& a, const PackPlanar<P>& b) {
  return mul_add(a.y, b.y, a.x * b.x);
}
template <class P>
[[gnu::always_inline]] inline P dot(const PackPlanar<P>& a, const PackVector<P>& b) {
  return mul_add(a.y, b.y, a.x * b.x);
}
template <class P>
[[gnu::always_inline]] inline P dot(Upwards, const PackVector<P>& a) {
  return a.z;
}
template <class P>
[[gnu::always_inline]] inline PackPlanar<P> cross(const PackVector<P>& a, Upwards) {
  return {a.y, -a.x};
}
/// f a + b
template <class P>
[[gnu::always_inline]] inline PackPlanar<P> mul_add(P f, const PackPlanar<P>& a, const PackPlanar<P>& b) {
  return {mul_add(f, a.x, b.x), mul_add(f, a.y, b.y)};
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> mul_add(P f, const PackPlanar<P>& a, const PackVector<P>& b) {
  return {mul_add(f, a.x, b.x), mul_add(f, a.y, b.y), b.z};
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> mul_add(P f, Upwards, const PackPlanar<P>& b) {
  return {b.x, b.y, f};
}
/// f a + g n
template <class P>
[[gnu::always_inline]] inline PackVector<P> sum_of(P f, const PackPlanar<P>& a, P g, Upwards) {
  return {f * a.x, f * a.y, g};
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> sum_of(P f, const PackVector<P>& a, P g, const PackVector<P>& n) {
  return mul_add(f, a, g * n);
}

/// v - (n . v) n
template <class P>
[[gnu::always_inline]] inline PackPlanar<P> tangential(Upwards, const PackVector<P>& v) {
  return {v.x, v.y};
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> tangential(const PackVector<P>& n, const PackVector<P>& v) {
  return mul_add(-dot(n, v), n, v);
}
/// v itself, given that n . v = 0; tangential() without the arithmetic.
template <class P>
[[gnu::always_inline]] inline PackPlanar<P> lying(Upwards, const PackVector<P>& v) {
  return {v.x, v.y};
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> lying(const PackVector<P>&, const PackVector<P>& v) {
  return v;
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> in_space(const PackPlanar<P>& v) {
  return {v.x, v.y, P(0)};
}
template <class P>
[[gnu::always_inline]] inline PackVector<P> in_space(const PackVector<P>& v) {
  return v;
}

}  // namespace topple
