#include "solver/math/fused.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <random>

namespace topple::test {
namespace {

std::uint64_t bits_of(double x) {
  return x != x ? 0x7ff8000000000000 : std::bit_cast<std::uint64_t>(x);
}

void expect_as_of_the_library(double a, double b, double c) {
  const Two here = fused_multiply_add(Two{a, b}, Two{b, a}, Two{c, c});
  for (int lane : {0, 1})
    ASSERT_EQ(bits_of(here[lane]), bits_of(std::fma(a, b, c)))
        << std::hexfloat << a << " * " << b << " + " << c << ": " << here[lane] << ", not "
        << std::fma(a, b, c);
}

// Mantissas with few and with many digits, so that ties and carries happen; exponents within `spread` of 0.
double number(std::mt19937_64& random, int spread) {
  const std::uint64_t digits[] = {0, random() & 7, random() & 0xffffff0000000, random() & 0xfffffffffffff,
                                  0xfffffffffffff};
  const std::uint64_t exponent = 1023 - spread + random() % (2 * spread + 1);
  return std::bit_cast<double>(random() << 63 | exponent << 52 | digits[random() % 5]);
}

TEST(FusedMultiplyAdd, has_the_bits_of_the_library_at_every_size_of_its_numbers) {
  std::mt19937_64 random(7);
  for (const int spread : {2, 30, 120, 1022})
    for (int k = 0; k < 100000; ++k)
      expect_as_of_the_library(number(random, spread), number(random, spread), number(random, spread));
}

TEST(FusedMultiplyAdd, has_the_bits_of_the_library_where_the_sum_cancels) {
  std::mt19937_64 random(8);
  for (int k = 0; k < 200000; ++k) {
    const double a = number(random, 20), b = number(random, 20);
    const auto near = std::bit_cast<std::uint64_t>(-a * b) + random() % 5 - 2;
    expect_as_of_the_library(a, b, std::bit_cast<double>(near));
  }
}

TEST(FusedMultiplyAdd, keeps_the_signs_of_zeros_and_what_is_not_finite) {
  using Limits = std::numeric_limits<double>;
  const double special[] = {0.,
                            -0.,
                            1.,
                            -1.,
                            0x1p-1074,
                            -0x1p-1022,
                            0x1p-540,
                            0x1p1023,
                            Limits::max(),
                            Limits::infinity(),
                            -Limits::infinity(),
                            Limits::quiet_NaN()};
  for (const double a : special)
    for (const double b : special)
      for (const double c : special) expect_as_of_the_library(a, b, c);
}

}  // namespace
}  // namespace topple::test
