// The lanes of a pack one by one. P: Four, or double, a pack of one lane.
#pragma once

#include <array>
#include <type_traits>

#include "solver/math/pack.h"

namespace topple {

template <class P>
inline constexpr int k_lanes = static_cast<int>(sizeof(P) / sizeof(double));
template <class P>
inline constexpr bool k_is_pack = k_lanes<P> != 1;
template <class P>
using MaskOf = decltype(P(0) < P(0));
/// One T per lane.
template <class P, class T>
using PerLane = std::conditional_t<!k_is_pack<P>, T, std::array<T, k_lanes<P>>>;

template <class T>
T& of_lane(T& of, int) {
  return of;
}
template <class T, std::size_t n>
T& of_lane(std::array<T, n>& of, int k) {
  return of[static_cast<std::size_t>(k)];
}
template <class T, std::size_t n>
const T& of_lane(const std::array<T, n>& of, int k) {
  return of[static_cast<std::size_t>(k)];
}
[[gnu::always_inline]] inline double of_lane(double of, int) {
  return of;
}
[[gnu::always_inline]] inline double of_lane(Four of, int k) {
  return of[k];
}
[[gnu::always_inline]] inline void set_lane(double& of, int, double value) {
  of = value;
}
[[gnu::always_inline]] inline void set_lane(Four& of, int k, double value) {
  of.set(k, value);
}
/// What there is one of per lane: value(0), value(1), ...
template <class P, class Value>
[[gnu::always_inline]] inline auto per_lane(const Value& value) {
  if constexpr (!k_is_pack<P>)
    return value(0);
  else
    return std::array{value(0), value(1), value(2), value(3)};
}
/// The pack of value(0), value(1), ...
template <class P, class Value>
[[gnu::always_inline]] inline P pack_of(const Value& value) {
  if constexpr (!k_is_pack<P>)
    return value(0);
  else
    return Four::Vector{double(value(0)), double(value(1)), double(value(2)), double(value(3))};
}

/// Bit k is set where lane k is.
[[gnu::always_inline]] inline unsigned bits(bool mask) {
  return mask;
}
[[gnu::always_inline]] inline bool complement(bool mask) {
  return !mask;
}
[[gnu::always_inline]] inline FourMask complement(FourMask mask) {
  return ~mask;
}
/// a where it is below b, else b.
template <class P>
[[gnu::always_inline]] inline P lesser(P a, P b) {
  return choose(a < b, a, b);
}
template <class P>
[[gnu::always_inline]] inline P magnitude(P a) {
  return with_sign_of(a, P(1));
}
template <class P>
[[gnu::always_inline]] inline P clamp(P a, P low, P high) {
  return choose(a < low, low, choose(high < a, high, a));
}
/// Calls work(k) for each lane that is set.
template <class Mask, class Work>
[[gnu::always_inline]] inline void for_lanes(Mask mask, const Work& work) {
  for (unsigned left = bits(mask); left != 0; left &= left - 1) work(__builtin_ctz(left));
}

}  // namespace topple
