// The elementary functions against MPFR, and the bits they give on every machine.
#include "solver/math/elementary.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

namespace topple {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

class Exact {
 public:
  explicit Exact(double value = 0) {
    mpfr_init2(value_, 160);
    mpfr_set_d(value_, value, MPFR_RNDN);
  }
  ~Exact() { mpfr_clear(value_); }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  operator mpfr_ptr() { return value_; }

 private:
  mpfr_t value_;
};

/// In units of the last digit that a double of the exact value's size has.
double error_in_ulps(double computed, Exact& exact) {
  const double nearest = mpfr_get_d(exact, MPFR_RNDN);
  if (!std::isfinite(nearest) || !std::isfinite(computed))
    return computed == nearest || (std::isnan(computed) && std::isnan(nearest)) ? 0 : k_infinity;
  const int exponent = mpfr_zero_p(mpfr_ptr(exact)) ? -1074 : std::max<int>(mpfr_get_exp(exact) - 53, -1074);
  mpfr_sub(exact, exact, Exact(computed), MPFR_RNDN);
  mpfr_mul_2si(exact, exact, -exponent, MPFR_RNDN);
  return std::abs(mpfr_get_d(exact, MPFR_RNDN));
}

/// Where arguments are drawn from: evenly, or evenly in their logarithm with both signs.
struct Range {
  double from, to;
  bool logarithmic = false;
};
constexpr Range k_all_sizes{1e-310, 1.7e308, true};

double drawn(const Range& range, std::mt19937_64& random) {
  const double share = static_cast<double>(random() >> 11) * 0x1p-53;
  if (!range.logarithmic) return range.from + share * (range.to - range.from);
  const double size = std::exp(std::log(range.from) + share * (std::log(range.to) - std::log(range.from)));
  return random() & 1 ? size : -size;
}

struct OfOne {
  std::string_view name;
  double (*function)(double);
  int (*exact)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
  std::vector<Range> ranges;
};
struct OfTwo {
  std::string_view name;
  double (*function)(double, double);
  int (*exact)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);
  std::vector<std::pair<Range, Range>> ranges;
};

const std::vector<OfOne>& of_one() {
  static const std::vector<OfOne> all{
      {"sin", elementary::sin, mpfr_sin, {{-4, 4}, {-1e4, 1e4}, {-3e6, 3e6}, k_all_sizes}},
      {"cos", elementary::cos, mpfr_cos, {{-4, 4}, {-1e4, 1e4}, {-3e6, 3e6}, k_all_sizes}},
      {"tan", elementary::tan, mpfr_tan, {{-4, 4}, {-1e4, 1e4}, {-3e6, 3e6}, k_all_sizes}},
      {"asin", elementary::asin, mpfr_asin, {{-1, 1}, {0.999, 1}, {1e-310, 1, true}}},
      {"acos", elementary::acos, mpfr_acos, {{-1, 1}, {0.999, 1}, {-1, -0.999}, {1e-310, 1, true}}},
      {"atan", elementary::atan, mpfr_atan, {{-2, 2}, {-40, 40}, k_all_sizes}},
      {"exp", elementary::exp, mpfr_exp, {{-1, 1}, {-750, 720}, {1e-310, 800, true}}},
      {"expm1", elementary::expm1, mpfr_expm1, {{-2, 2}, {-60, 60}, {1e-310, 800, true}}},
      {"log", elementary::log, mpfr_log, {{0, 3}, {0.99, 1.01}, {0, 1e9}, k_all_sizes}},
      {"log1p", elementary::log1p, mpfr_log1p, {{-1, 3}, {-0.01, 0.01}, k_all_sizes}},
      {"cbrt", elementary::cbrt, mpfr_cbrt, {{-8, 8}, k_all_sizes}}};
  return all;
}

const std::vector<OfTwo>& of_two() {
  static const std::vector<OfTwo> all{
      {"atan2",
       elementary::atan2,
       mpfr_atan2,
       {{{-2, 2}, {-2, 2}},
        {{-1e-3, 1e-3}, {-1, 1}},
        {k_all_sizes, k_all_sizes},
        {{1e-5, 1e5, true}, {1e-5, 1e5, true}}}},
      {"pow",
       elementary::pow,
       mpfr_pow,
       {{{0, 2}, {-3, 3}},
        {{0, 1e-3}, {0.5, 3}},
        {{0.999, 1.001}, {-7e5, 7e5}},
        {{0, 1e300}, {-1.1, 1.1}},
        {{1e-310, 1e308, true}, {1e-3, 1e3, true}}}},
      {"hypot",
       elementary::hypot,
       mpfr_hypot,
       {{{-2, 2}, {-2, 2}}, {k_all_sizes, k_all_sizes}, {{1e-5, 1e5, true}, {1e-5, 1e5, true}}}}};
  return all;
}

constexpr int k_draws = 20000;  // a range

/// The largest error over the ranges stays below 1 ulp, the promise of the header.
void expect_accurate(std::string_view name,
                     const std::function<double(std::mt19937_64&, std::size_t, std::string&)>& error_of,
                     std::size_t ranges) {
  std::mt19937_64 random(33);
  double worst = 0;
  std::string where;
  for (std::size_t range = 0; range < ranges; ++range) {
    for (int i = 0; i < k_draws; ++i) {
      std::string at;
      const double error = error_of(random, range, at);
      if (!(error <= worst)) worst = error, where = at;
    }
  }
  EXPECT_LT(worst, 1) << name << " at " << where;
}

TEST(Elementary, functions_of_one_number_are_below_1_ulp_of_the_exact_value) {
  for (const OfOne& f : of_one()) {
    expect_accurate(
        f.name,
        [&f](std::mt19937_64& random, std::size_t range, std::string& at) {
          const double x = drawn(f.ranges[range], random);
          char text[40];
          std::snprintf(text, sizeof text, "%a", x);
          at = text;
          Exact exact(x);
          f.exact(exact, exact, MPFR_RNDN);
          return error_in_ulps(f.function(x), exact);
        },
        f.ranges.size());
  }
}

TEST(Elementary, functions_of_two_numbers_are_below_1_ulp_of_the_exact_value) {
  for (const OfTwo& f : of_two()) {
    expect_accurate(
        f.name,
        [&f](std::mt19937_64& random, std::size_t range, std::string& at) {
          const double x = drawn(f.ranges[range].first, random), y = drawn(f.ranges[range].second, random);
          char text[80];
          std::snprintf(text, sizeof text, "%a, %a", x, y);
          at = text;
          Exact exact(x);
          f.exact(exact, exact, Exact(y), MPFR_RNDN);
          return error_in_ulps(f.function(x, y), exact);
        },
        f.ranges.size());
  }
}

// 6381956970095103 2^797 is the double nearest to a multiple of pi/2 (Muller, Elementary Functions, 2016, ch.
// 11).
TEST(Elementary, angles_next_to_multiples_of_a_quarter_turn_keep_their_digits) {
  std::vector<double> angles{std::ldexp(6381956970095103., 797)};
  for (int n = 1; n < 20000; ++n) {
    const double nearest = n * (std::numbers::pi / 2);
    angles.insert(angles.end(), {nearest, std::nextafter(nearest, 0), std::nextafter(nearest, k_infinity)});
  }
  for (const double x : angles) {
    Exact sine(x), cosine(x), tangent(x);
    mpfr_sin(sine, sine, MPFR_RNDN);
    mpfr_cos(cosine, cosine, MPFR_RNDN);
    mpfr_tan(tangent, tangent, MPFR_RNDN);
    const elementary::SinCos both = elementary::sin_cos(x);
    EXPECT_LT(error_in_ulps(both.sine, sine), 1) << x;
    EXPECT_LT(error_in_ulps(both.cosine, cosine), 1) << x;
    EXPECT_LT(error_in_ulps(elementary::tan(x), tangent), 1) << x;
  }
}

constexpr double k_special[]{0.,      -0.,      1.,        -1.,    0.5,    -0.5,       2.,
                             -2.,     3.,       -3.,       1e17,   -1e17,  k_infinity, -k_infinity,
                             k_nan,   4.9e-324, 1e-310,    1e308,  -1e308, 1e-20,      710.,
                             -745.13, 709.78,   0x1p-1022, -1e-310};

/// As the C library has it, but for the last digit.
void expect_like(double own, double c, const std::string& call) {
  if (std::isnan(c)) {
    EXPECT_TRUE(std::isnan(own)) << call;
  } else if (c == 0 || std::isinf(c)) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(own), std::bit_cast<std::uint64_t>(c)) << call;
  } else {
    EXPECT_LE(std::abs(own - c), std::abs(std::nextafter(c, k_infinity) - c) * 1.01) << call;
  }
}

TEST(Elementary, zeros_infinities_and_other_special_arguments_are_as_in_c) {
  double (*const c_of_one[])(double){std::sin, std::cos,   std::tan, std::asin,  std::acos, std::atan,
                                     std::exp, std::expm1, std::log, std::log1p, std::cbrt};
  double (*const c_of_two[])(double, double){std::atan2, std::pow, std::hypot};
  for (std::size_t f = 0; f < of_one().size(); ++f) {
    for (const double x : k_special)
      expect_like(of_one()[f].function(x), c_of_one[f](x),
                  std::string(of_one()[f].name) + "(" + std::to_string(x) + ")");
  }
  for (std::size_t f = 0; f < of_two().size(); ++f) {
    for (const double x : k_special) {
      for (const double y : k_special)
        expect_like(of_two()[f].function(x, y), c_of_two[f](x, y),
                    std::string(of_two()[f].name) + "(" + std::to_string(x) + ", " + std::to_string(y) + ")");
    }
  }
}

// FNV-1a of results at arguments that need no function to be drawn. The figure is that of every compiler and
// processor.
TEST(Elementary, bits_are_those_of_every_machine) {
  std::mt19937_64 random(1985);
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto argument = [&random] {  // of either sign, its exponent from -40 to 10
    const double digits = 1 + static_cast<double>(random() >> 12) * 0x1p-52;
    const double size = std::ldexp(digits, static_cast<int>(random() % 51) - 40);
    return random() & 1 ? size : -size;
  };
  const auto take = [&hash](double value) {
    if (std::isnan(value)) value = 0;  // its bits differ
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3;
  };
  for (int i = 0; i < k_draws; ++i) {
    for (const OfOne& f : of_one()) take(f.function(argument()));
    for (const OfTwo& f : of_two()) {
      const double x = argument();
      take(f.function(x, argument()));
    }
  }
  EXPECT_EQ(hash, 0x2df5a4a6a4dd48bcu);
}

}  // namespace
}  // namespace topple
