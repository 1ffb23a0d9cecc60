// Fused multiply-add, a b + c rounded once, for processors without the instruction: the same bits from sums
// and products. The lower part of the exact sum is rounded to odd before the last addition (Boldo and
// Melquiond 2008).
#pragma once

#include <cmath>

namespace topple {

/// Two doubles as a GNU vector.
using Two = double __attribute__((vector_size(16)));

namespace fused {

using Mask = long long __attribute__((vector_size(16)));

/// A number of twice the digits: high + low.
struct TwoSum {
  Two high, low;
};

/// a + b, exact, for any a and b (Knuth).
[[gnu::always_inline]] inline TwoSum exact_sum(Two a, Two b) {
  const Two high = a + b, of_b = high - a;
  return {high, (a - (high - of_b)) + (b - of_b)};
}

/// a as the sum of two numbers of 26 digits each, whose products are exact (Veltkamp).
[[gnu::always_inline]] inline TwoSum halves(Two a) {
  const Two scaled = (0x1p27 + 1) * a, high = scaled - (scaled - a);
  return {high, a - high};
}

[[gnu::always_inline]] inline Two magnitude(Two a) {
  return Two(Mask(a) & 0x7fffffffffffffff);
}

}  // namespace fused

/// a b + c, rounded once, for any numbers; std::fma where intermediate results could leave the range of
/// doubles.
inline Two fused_multiply_add(Two a, Two b, Two c) {
  using namespace fused;
  const Two product = a * b, size = magnitude(product), zero{}, largest = zero + 0x1p990;
  const Mask no_product = (a == zero) | (b == zero);
  const Mask in_range = (magnitude(a) < largest) & (magnitude(b) < largest) & (magnitude(c) < largest) &
                        (size < largest) & ((size > 0x1p-960) | no_product);
  if ((in_range[0] & in_range[1]) == 0) return Two{std::fma(a[0], b[0], c[0]), std::fma(a[1], b[1], c[1])};

  const TwoSum of_a = halves(a), of_b = halves(b);
  const Two product_low =
      ((of_a.high * of_b.high - product) + of_a.high * of_b.low + of_a.low * of_b.high) + of_a.low * of_b.low;
  const TwoSum with_c = exact_sum(c, product_low);
  const TwoSum sum = exact_sum(product, with_c.high);
  const TwoSum rest = exact_sum(with_c.low, sum.low);

  // to odd: where something was left and the last digit is even, the neighbour on the side of what was left
  const Mask digits = Mask(rest.high), even = (digits & 1) - 1;
  const Mask away_from_zero = (rest.low > zero) == (rest.high > zero);
  const Mask to_odd = even & (rest.low != zero) & ((away_from_zero & 2) - 1);
  const Two rounded = sum.high + Two(digits + to_odd);
  return Two((no_product & Mask(product + c)) | (~no_product & Mask(rounded)));
}

}  // namespace topple
