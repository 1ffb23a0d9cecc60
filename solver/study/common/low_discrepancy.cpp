#include "solver/study/common/low_discrepancy.h"

#include <array>
#include <cmath>
#include <numbers>

#include "solver/math/elementary.h"
#include "solver/study/common/axis.h"

namespace topple::study {
namespace {

constexpr int k_bits = 32;
using Directions = std::array<std::uint32_t, k_bits>;

/// A primitive polynomial x^degree + coefficients + 1 over two elements, and the first direction numbers.
struct Generator {
  int degree;
  unsigned coefficients;
  std::array<std::uint32_t, 5> first;
};
constexpr std::array<Generator, k_most_dimensions - 1> k_generators{{{1, 0, {1}},
                                                                     {2, 1, {1, 3}},
                                                                     {3, 1, {1, 3, 1}},
                                                                     {3, 2, {1, 1, 1}},
                                                                     {4, 1, {1, 1, 3, 3}},
                                                                     {4, 4, {1, 3, 5, 13}},
                                                                     {5, 2, {1, 1, 5, 5, 17}},
                                                                     {5, 4, {1, 1, 5, 5, 5}},
                                                                     {5, 7, {1, 1, 7, 11, 19}}}};

constexpr Directions directions_of(const Generator& of) {
  Directions v{};
  for (int i = 0; i < k_bits; ++i) {
    const auto at = static_cast<std::size_t>(i), degree = static_cast<std::size_t>(of.degree);
    if (i < of.degree) {
      v[at] = of.first[at] << (k_bits - 1 - i);
      continue;
    }
    v[at] = v[at - degree] ^ (v[at - degree] >> of.degree);
    for (std::size_t k = 1; k < degree; ++k)
      if (of.coefficients >> (degree - 1 - k) & 1u) v[at] ^= v[at - k];
  }
  return v;
}

constexpr auto k_directions = [] {
  std::array<Directions, k_most_dimensions> all{};
  for (int i = 0; i < k_bits; ++i) all[0][static_cast<std::size_t>(i)] = 1u << (k_bits - 1 - i);
  for (std::size_t d = 1; d < all.size(); ++d) all[d] = directions_of(k_generators[d - 1]);
  return all;
}();

std::uint32_t digits(std::uint32_t index, int dimension) {
  std::uint32_t x = 0;
  for (std::size_t bit = 0; index != 0; index >>= 1, ++bit)
    if (index & 1u) x ^= k_directions[static_cast<std::size_t>(dimension)][bit];
  return x;
}

double horner(double x, const std::array<double, 8>& c) {
  double sum = c[7];
  for (std::size_t i = 7; i-- > 0;) sum = c[i] + x * sum;
  return sum;
}

struct Ratio {
  std::array<double, 8> above, below;
  double at(double x) const { return horner(x, above) / horner(x, below); }
};
constexpr Ratio k_middle{
    {3.3871328727963666080, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
     4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3},
    {1, 4.2313330701600911252e1, 6.8718700749205790830e2, 5.3941960214247511077e3, 2.1213794301586595867e4,
     3.9307895800092710610e4, 2.8729085735721942674e4, 5.2264952788528545610e3}};
constexpr Ratio k_outer{
    {1.42343711074968357734, 4.63033784615654529590, 5.76949722146069140550, 3.64784832476320460504,
     1.27045825245236838258, 2.41780725177450611770e-1, 2.27238449892691845833e-2, 7.74545014278341407640e-4},
    {1, 2.05319162663775882187, 1.67638483018380384940, 6.89767334985100004550e-1, 1.48103976427480074590e-1,
     1.51986665636164571966e-2, 5.47593808499534494600e-4, 1.05075007164441684324e-9}};
constexpr Ratio k_far{{6.65790464350110377720, 5.46378491116411436990, 1.78482653991729133580,
                       2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                       2.71155556874348757815e-5, 2.01033439929228813265e-7},
                      {1, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2,
                       7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7,
                       2.04426310338993978564e-15}};

}  // namespace

double sobol(std::uint32_t index, int dimension) {
  return digits(index, dimension) * 0x1p-32;
}

double shifted_sobol(std::uint64_t stream, std::uint32_t index, int dimension) {
  const auto shift =
      static_cast<std::uint32_t>(scattered(stream, static_cast<std::uint64_t>(dimension)) * 0x1p32);
  return ((digits(index, dimension) ^ shift) + 0.5) * 0x1p-32;
}

double normal_quantile(double u) {
  const double q = u - 0.5;
  if (std::abs(q) <= 0.425) return q * k_middle.at(0.180625 - q * q);
  const double r = std::sqrt(-elementary::log(q < 0 ? u : 1 - u));
  const double z = r <= 5 ? k_outer.at(r - 1.6) : k_far.at(r - 5);
  return q < 0 ? -z : z;
}

double normal_probability(double z) {
  return std::erfc(-z / std::numbers::sqrt2) / 2;
}

}  // namespace topple::study
