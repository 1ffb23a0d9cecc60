#include "solver/math/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "solver/math/lanes.h"

namespace topple::elementary {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

/// A number of twice the digits: high + low, |low| at most half an ulp of high (Dekker 1971). P: double, or a
/// pack of them (pack.h).
template <class P>
struct SumOf {
  P high, low{0};
};
using Sum = SumOf<double>;

/// a + b, exact, |a| >= |b| or a = 0.
template <class P>
SumOf<P> quick_sum(P a, P b) {
  const P high = a + b;
  return {high, b - (high - a)};
}

/// a + b, exact (Knuth).
Sum exact_sum(double a, double b) {
  const double high = a + b, of_b = high - a;
  return {high, (a - (high - of_b)) + (b - of_b)};
}

/// a b, exact; neither of them above 2^990 nor the product below 2^-960.
template <class P>
SumOf<P> exact_product(P a, P b) {
  const P high = a * b;
#if defined(__FMA__) || defined(__aarch64__)
  return {high, mul_add(a, b, -high)};
#else  // of halves of 26 digits (Veltkamp, Dekker): the same bits
  const P splitter(0x1p27 + 1);
  const P a_high = splitter * a - (splitter * a - a), a_low = a - a_high;
  const P b_high = splitter * b - (splitter * b - b), b_low = b - b_high;
  return {high, ((a_high * b_high - high) + a_high * b_low + a_low * b_high) + a_low * b_low};
#endif
}

Sum operator+(Sum a, double b) {
  const Sum s = exact_sum(a.high, b);
  return quick_sum(s.high, s.low + a.low);
}
Sum operator+(Sum a, Sum b) {
  const Sum s = exact_sum(a.high, b.high), t = exact_sum(a.low, b.low);
  const Sum u = quick_sum(s.high, s.low + t.high);
  return quick_sum(u.high, u.low + t.low);
}
Sum operator-(Sum a) {
  return {-a.high, -a.low};
}
Sum operator*(Sum a, double b) {
  const Sum p = exact_product(a.high, b);
  return quick_sum(p.high, p.low + a.low * b);
}
Sum operator*(Sum a, Sum b) {
  const Sum p = exact_product(a.high, b.high);
  return quick_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}
Sum operator/(Sum a, Sum b) {
  const double inverse = 1 / b.high, high = a.high * inverse;
  const Sum back = exact_product(high, b.high);
  return quick_sum(high, ((a.high - back.high) - back.low + a.low - high * b.low) * inverse);
}
/// Of a > 0, or 0.
Sum root(Sum a) {
  const double high = std::sqrt(a.high);
  if (high == 0) return {0};
  const Sum back = exact_product(high, high);
  return quick_sum(high, ((a.high - back.high) - back.low + a.low) / (2 * high));
}
template <class P>
P rounded(const SumOf<P>& a) {
  return a.high + a.low;
}

/// c0 + c1 x + ...: neighbours in pairs, pairs in pairs, so that a processor works on several at once.
template <class P, class C, std::size_t n>
P polynomial(P x, const std::array<C, n>& c) {
  if constexpr (n == 1) {
    return c[0];
  } else {
    std::array<P, (n + 1) / 2> pairs;
    for (std::size_t k = 0; k < n / 2; ++k) pairs[k] = P(c[2 * k]) + P(c[2 * k + 1]) * x;
    if constexpr (n % 2 == 1) pairs.back() = c[n - 1];
    return polynomial(x * x, pairs);
  }
}

double nearest_integer(double x) {  // |x| < 2^51
  constexpr double to_integers = 0x1.8p52;
  return (x + to_integers) - to_integers;
}

// ---- sine and cosine

constexpr Sum k_half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

struct Quadrant {
  unsigned number;  ///< mod 4
  Sum rest;         ///< |rest| <= pi/4
};

/// Payne and Hanek 1983: the digits of 2/pi that matter, as an integer of 192 bits, times those of x.
Quadrant quadrant_of_large(double x) {  // >= 2^20
  static constexpr std::array<std::uint32_t, 40> two_over_pi{
      // after 64 zeros, the bits behind the point
      0x00000000, 0x00000000, 0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041,
      0xfe5163ab, 0xdebbc561, 0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e,
      0xe88235f5, 0x2ebb4484, 0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b,
      0x1ff897ff, 0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d,
      0x7527bac7, 0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab};
  int exponent;
  const auto digits = static_cast<std::uint64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  const int first = exponent - 53 - 2 + 64;  // what stands before it gives multiples of 4
  std::array<std::uint64_t, 6> word;         // of 32 bits, the most significant first
  for (int k = 0; k < 6; ++k) {
    const std::uint64_t two =
        std::uint64_t{two_over_pi[first / 32 + k]} << 32 | two_over_pi[first / 32 + k + 1];
    word[k] = two >> (32 - first % 32) & 0xffffffff;
  }
  std::array<std::uint64_t, 6> product{};  // its lowest 192 bits: two before the point, 190 behind
  std::uint64_t carry = 0;
  for (int k = 5; k >= 0; --k) {
    const std::uint64_t low = word[k] * (digits & 0xffffffff), sum = (low & 0xffffffff) + carry;
    product[k] = sum & 0xffffffff;
    carry = (low >> 32) + (sum >> 32);
  }
  carry = 0;
  for (int k = 4; k >= 0; --k) {
    const std::uint64_t sum = word[k + 1] * (digits >> 32) + product[k] + carry;
    product[k] = sum & 0xffffffff;
    carry = sum >> 32;
  }
  auto number = static_cast<unsigned>(product[0] >> 30);
  Sum fraction{0};
  product[0] &= 0x3fffffff;
  for (int k = 0; k < 6; ++k)
    fraction = fraction + std::ldexp(static_cast<double>(product[k]), 2 - 32 * (k + 1));
  if (fraction.high >= 0.5) {
    ++number;
    fraction = fraction + -1.;
  }
  return {number & 3, fraction * k_half_pi};
}

Quadrant quadrant(double x) {
  if (std::abs(x) <= k_half_pi.high / 2) return {0, {x}};
  if (std::abs(x) >= 0x1p20) {
    const Quadrant q = quadrant_of_large(std::abs(x));
    return x > 0 ? q : Quadrant{-q.number & 3, -q.rest};
  }
  const double n = nearest_integer(x * 0x1.45f306dc9c883p-1);
  // pi/2 in parts of 33 digits: their products with n are exact
  Sum rest = exact_sum(x - n * 0x1.921fb544p+0, -n * 0x1.0b4611a6p-34);
  if (std::abs(rest.high) > 0x1p-40)
    rest = quick_sum(rest.high, rest.low - n * 0x1.3198a2e037073p-69);
  else
    rest = rest + -n * 0x1.3198a2e0p-69 + -n * 0x1.b839a252049c1p-104;
  return {static_cast<unsigned>(static_cast<int>(n)) & 3, rest};
}

template <class P>
SumOf<P> sine_near_0(const SumOf<P>& x) {  // |x| <= pi/4, as all below
  const P z = x.high * x.high;
  static constexpr std::array<double, 8> series{
      -1. / 6,        1. / 120,         -1. / 5040,           1. / 362880,
      -1. / 39916800, 1. / 6227020800., -1. / 1307674368000., 1. / 355687428096000.};
  return quick_sum(x.high, x.high * z * polynomial(z, series) + x.low * (P(1) - z / P(2)));
}

template <class P>
SumOf<P> cosine_near_0(const SumOf<P>& x) {
  const SumOf<P> z = exact_product(x.high, x.high), flat = quick_sum(P(1), -z.high / P(2));
  static constexpr std::array<double, 8> series{
      1. / 24,        -1. / 720,          1. / 40320,           -1. / 3628800,
      1. / 479001600, -1. / 87178291200., 1. / 20922789888000., -1. / 6402373705728000.};
  return quick_sum(flat.high,
                   flat.low + (z.high * z.high * polynomial(z.high, series) - x.high * x.low - z.low / P(2)));
}

/// Of the angle, `further` quadrants on.
double sine_of_quadrant(const Quadrant& q, unsigned further) {
  const unsigned number = q.number + further;
  const Sum size = number % 2 == 0 ? sine_near_0(q.rest) : cosine_near_0(q.rest);
  return number & 2 ? -rounded(size) : rounded(size);
}

struct ExactSinCos {
  Sum sine, cosine;
};

ExactSinCos exact_sin_cos(double x) {
  const Quadrant q = quadrant(x);
  const Sum s = sine_near_0(q.rest), c = cosine_near_0(q.rest);
  switch (q.number) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

// ---- arcs

/// The angle of (x, y), 0 <= y <= x.
Sum first_octant(Sum y, Sum x) {
  static constexpr std::array<Sum, 9> arc_of_eighths{{{0, 0},
                                                      {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                                      {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                                      {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                                      {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                                      {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                                      {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                                      {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                                      {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};
  const double eighths = nearest_integer(8 * (y.high / x.high)), c = eighths / 8;
  const Sum t = eighths == 0 ? y / x : (y + x * -c) / (x + y * c);  // |t| <= 1/16 or a little more
  const double z = t.high * t.high;
  static constexpr std::array<double, 7> series{-1. / 3,  1. / 5,  -1. / 7, 1. / 9,
                                                -1. / 11, 1. / 13, -1. / 15};
  return arc_of_eighths[static_cast<std::size_t>(eighths)] + (t + t.high * z * polynomial(z, series));
}

/// The angle of (x, y), neither of them negative, 0 or within 2^-470 and 2^400.
Sum first_quadrant(Sum y, Sum x) {
  const bool steep = y.high > x.high;
  return steep ? k_half_pi + -first_octant(x, y) : first_octant(y, x);
}

/// Of a right triangle with the hypotenuse 1 and the other leg x, 0 <= x <= 1.
Sum leg(double x) {
  return root(Sum{1} + -exact_product(x, x));
}

constexpr Sum k_pi_digits{2 * k_half_pi.high, 2 * k_half_pi.low};

// ---- powers

struct Power {
  Sum less_one;
  int exponent;
};

/// e^x = 2^exponent (1 + less_one), |less_one| < 0.42; |x| < 2^11.
Power power_of_e(Sum x) {
  const double n = nearest_integer(x.high * 0x1.71547652b82fep+0);
  // ln 2 in parts of 42 digits: their products with n are exact
  const Sum r =
      Sum{x.high - n * 0x1.62e42fefa38p-1} + -n * 0x1.ef35793c76p-45 + (x.low - n * 0x1.cc01f97b57a08p-87);
  static constexpr std::array<double, 13> series{
      1. / 2,         1. / 6,           1. / 24,          1. / 120,     1. / 720,
      1. / 5040,      1. / 40320,       1. / 362880,      1. / 3628800, 1. / 39916800,
      1. / 479001600, 1. / 6227020800., 1. / 87178291200.};
  const double curve = r.high * r.high * polynomial(r.high, series);
  return {quick_sum(r.high, curve + (r.low + r.low * r.high)), static_cast<int>(n)};
}

double times_power_of_2(const Power& e) {
  const Sum whole = quick_sum(1., e.less_one.high);
  return std::ldexp(whole.high + (whole.low + e.less_one.low), e.exponent);
}

/// Of x > 0, finite; to a relative 2^-64.
Sum logarithm(Sum x) {
  int k;
  double m = std::frexp(x.high, &k);
  if (m < 0x1.6a09e667f3bcdp-1) m *= 2, --k;  // sqrt(1/2) <= m < sqrt(2)
  const Sum f = exact_sum(m - 1, std::ldexp(x.low, -k));
  const Sum s = f / (f + 2.), z = s * s;  // ln m = 2 artanh s
  static constexpr std::array<double, 11> series{2. / 5,  2. / 7,  2. / 9,  2. / 11, 2. / 13, 2. / 15,
                                                 2. / 17, 2. / 19, 2. / 21, 2. / 23, 2. / 25};
  const Sum curve = Sum{0x1.5555555555555p-1, 0x1.5555555555555p-55} + z.high * polynomial(z.high, series);
  const Sum of_m = Sum{2 * s.high, 2 * s.low} + s * z * curve;
  return Sum{k * 0x1.62e42fefa38p-1} + (Sum{k * 0x1.ef35793c76p-45, k * 0x1.cc01f97b57a08p-87} + of_m);
}

bool is_odd(double y) {
  return std::abs(std::fmod(y, 2)) == 1;
}

constexpr double k_below_half_ulp = 0x1p-27;  ///< sin x = x for all smaller ones, and so on

}  // namespace

SinCos sin_cos(double x) {
  if (!std::isfinite(x)) return {k_nan, k_nan};
  if (std::abs(x) < k_below_half_ulp) return {x, 1};
  const Quadrant q = quadrant(x);
  return {sine_of_quadrant(q, 0), sine_of_quadrant(q, 1)};
}

template <>
SinCos sin_cos_of_lanes(const double& x) {
  return sin_cos(x);
}

template <>
SinCosOf<Four> sin_cos_of_lanes(const Four& x) {
  const Four size = magnitude(x);
  if (any_above(size, k_half_pi.high / 2)) {
    const auto of = per_lane<Four>([&](int k) { return sin_cos(x[k]); });
    return {pack_of<Four>([&](int k) { return of_lane(of, k).sine; }),
            pack_of<Four>([&](int k) { return of_lane(of, k).cosine; })};
  }
  const SumOf<Four> angle{x};
  const auto tiny = size < Four(k_below_half_ulp);
  return {choose(tiny, x, rounded(sine_near_0(angle))), choose(tiny, Four(1), rounded(cosine_near_0(angle)))};
}

double sin(double x) {
  if (!std::isfinite(x)) return k_nan;
  if (std::abs(x) < k_below_half_ulp) return x;
  return sine_of_quadrant(quadrant(x), 0);
}

double cos(double x) {
  if (!std::isfinite(x)) return k_nan;
  return sine_of_quadrant(quadrant(x), 1);
}

double tan(double x) {
  if (!std::isfinite(x)) return k_nan;
  if (std::abs(x) < k_below_half_ulp) return x;
  const ExactSinCos of = exact_sin_cos(x);
  return rounded(of.sine / of.cosine);
}

double asin(double x) {
  if (!(std::abs(x) <= 1)) return k_nan;
  if (std::abs(x) < k_below_half_ulp) return x;
  return std::copysign(rounded(first_quadrant({std::abs(x)}, leg(x))), x);
}

double acos(double x) {
  if (!(std::abs(x) <= 1)) return k_nan;
  const Sum arc = first_quadrant(leg(x), {std::abs(x)});
  return rounded(x < 0 ? k_pi_digits + -arc : arc);
}

double atan(double x) {
  return atan2(x, 1);
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return k_nan;
  const bool left = std::signbit(x);
  if (std::isinf(x) && std::isinf(y)) x = std::copysign(1, x), y = std::copysign(1, y);
  if (y == 0 || std::isinf(x)) return std::copysign(left ? k_pi_digits.high : 0, y);
  if (x == 0 || std::isinf(y)) return std::copysign(k_half_pi.high, y);
  double across = std::abs(x), up = std::abs(y);
  if (across < up * 0x1p-70) return std::copysign(k_half_pi.high, y);
  if (up < across * 0x1p-70) return left ? std::copysign(k_pi_digits.high, y) : y / x;
  if (const double larger = std::max(across, up); !(larger > 0x1p-400 && larger < 0x1p400)) {
    const int scale = -std::ilogb(larger);
    across = std::ldexp(across, scale), up = std::ldexp(up, scale);
  }
  const Sum arc = first_quadrant({up}, {across});
  return std::copysign(rounded(left ? k_pi_digits + -arc : arc), y);
}

double exp(double x) {
  if (std::isnan(x)) return x;
  if (std::abs(x) > 746) return x > 0 ? k_infinity : 0;
  return times_power_of_2(power_of_e({x}));
}

double expm1(double x) {
  if (std::isnan(x) || std::abs(x) < 0x1p-54) return x;
  if (x < -40) return -1;
  if (x > 40) return exp(x);
  const Power e = power_of_e({x});
  if (e.exponent == 0) return rounded(e.less_one);
  const double whole = std::ldexp(1, e.exponent);
  return rounded(Sum{whole} + -1. + Sum{whole * e.less_one.high, whole * e.less_one.low});
}

double log(double x) {
  if (!(x >= 0)) return k_nan;
  if (x == 0 || std::isinf(x)) return x == 0 ? -k_infinity : x;
  return rounded(logarithm({x}));
}

double log1p(double x) {
  if (!(x >= -1)) return k_nan;
  if (x == -1 || std::isinf(x)) return x == -1 ? -k_infinity : x;
  if (std::abs(x) < 0x1p-54) return x;
  return rounded(logarithm(exact_sum(1, x)));
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (std::isnan(x) || std::isnan(y)) return k_nan;
  const double size = std::abs(x), sign = std::signbit(x) && is_odd(y) ? -1 : 1;
  if (size == 0 || std::isinf(size)) return sign * ((size == 0) == (y < 0) ? k_infinity : 0);
  if (std::isinf(y) && size != 1) return (size > 1) == (y > 0) ? k_infinity : 0;
  if (x < 0 && std::trunc(y) != y) return k_nan;
  if (size == 1) return sign;
  const Sum of_size = logarithm({size});
  const double exponent = of_size.high * y;
  if (std::abs(exponent) > 746) return sign * (exponent > 0 ? k_infinity : 0);
  return sign * times_power_of_2(power_of_e(of_size * y));
}

double cbrt(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  int k;
  const double fraction = std::frexp(std::abs(x), &k);
  const int beyond = (k % 3 + 3) % 3;
  static constexpr double root_of_beyond[]{1, 0x1.428a2f98d728bp+0, 0x1.965fea53d6e3dp+0};
  const double m = fraction * (1 << beyond);  // in [1/2, 4)
  // to 1e-4: Chebyshev's cubic over [1/2, 1]
  double t =
      root_of_beyond[beyond] * polynomial(fraction, std::array{0.44113157750282331, 0.9220044243035053,
                                                               -0.50372191199259533, 0.14063547369258159});
  t *= (t * t * t + 2 * m) / (2 * t * t * t + m);  // Halley: to 1e-12
  const Sum cube = exact_product(t, t) * t;
  t -= ((cube.high - m) + cube.low) / (3 * t * t);
  return std::copysign(std::ldexp(t, (k - beyond) / 3), x);
}

double hypot(double x, double y) {
  if (std::isinf(x) || std::isinf(y)) return k_infinity;
  double longer = std::max(std::abs(x), std::abs(y)), shorter = std::min(std::abs(x), std::abs(y));
  if (std::isnan(x) || std::isnan(y)) return k_nan;
  if (shorter <= longer * 0x1p-60) return longer;
  const int scale = std::ilogb(longer);
  longer = std::ldexp(longer, -scale), shorter = std::ldexp(shorter, -scale);
  return std::ldexp(rounded(root(exact_product(longer, longer) + exact_product(shorter, shorter))), scale);
}

}  // namespace topple::elementary

namespace topple {

const char* arithmetic() {
  return "topple-19";
}

}  // namespace topple
