#include "solver/planar/power_series.h"

#include <cmath>
#include <utility>

namespace topple::planar {
namespace {

using Terms = std::array<double, k_terms>;

constexpr auto k_one_over_binomial = [] {  // of n over i
  std::array<Terms, k_terms> table{};
  for (std::size_t n = 0; n < table.size(); ++n) {
    double binomial = 1;
    for (std::size_t i = 0; i <= n; ++i) {
      table[n][i] = 1 / binomial;
      binomial = binomial * static_cast<double>(n - i) / static_cast<double>(i + 1);
    }
  }
  return table;
}();
constexpr double k_narrowest = 0x1p-45;
constexpr double k_last_step = 0x1p-35;  // of Newton's method: its square is left

/// On 0..1, all leading terms that are zero removed: the sign for t > 0 stays.
struct Polynomial {
  Terms a;
  int degree;

  double operator[](int i) const { return a[static_cast<std::size_t>(i)]; }

  /// Falls within low..high, in which it changes its sign once; by Newton's method, bisection where that
  /// leaves.
  double root(double low, double high, double t) const {
    for (int round = 0; round < 100; ++round) {
      double value = (*this)[degree], slope = 0;
      for (int i = degree; i-- > 0;) slope = value + t * slope, value = (*this)[i] + t * value;
      (value > 0 ? low : high) = t;
      const double next = t - value / slope;
      if (std::abs(next - t) <= k_last_step * t) return std::clamp(next, low, high);
      t = next > low && next < high ? next : (low + high) / 2;
    }
    return t;
  }
};

struct Bernstein {
  Terms b;
  int degree;

  explicit Bernstein(const Polynomial& p) : degree(p.degree) {
    const auto n = static_cast<std::size_t>(degree);
    for (std::size_t i = 0; i <= n; ++i) b[i] = p.a[i] * k_one_over_binomial[n][i];
    for (std::size_t k = 0; k < n; ++k) {
      double before = b[k];
      for (std::size_t i = k + 1; i <= n; ++i) before = std::exchange(b[i], b[i] + before);
    }
  }
  int sign_changes() const {
    int changes = 0;
    double before = 0;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
      if (b[i] == 0) continue;
      changes += (before < 0 && b[i] > 0) || (before > 0 && b[i] < 0);
      before = b[i];
    }
    return changes;
  }
  double first_sign() const {
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i)
      if (b[i] != 0) return b[i];
    return 0;
  }
  /// Where its control polygon crosses zero, in 0..1.
  double crossing() const {
    for (std::size_t i = 1; i <= static_cast<std::size_t>(degree); ++i)
      if (b[i] <= 0) return (static_cast<double>(i - 1) + b[i - 1] / (b[i - 1] - b[i])) / degree;
    return 1;
  }
  /// Becomes the right half; returns the left one (de Casteljau).
  Bernstein split() {
    Bernstein left = *this;
    const auto n = static_cast<std::size_t>(degree);
    for (std::size_t k = 1; k <= n; ++k) {
      for (std::size_t i = 0; i + k <= n; ++i) b[i] = (b[i] + b[i + 1]) / 2;
      left.b[k] = b[0];
    }
    return left;
  }
};

double fall_within(const Polynomial& p, const Bernstein& part, double from, double width) {
  const int changes = part.sign_changes();
  if (changes == 0 || (changes == 1 && part.first_sign() < 0)) return k_never;
  if (changes == 1) return p.root(from, from + width, from + width * part.crossing());
  if (width < k_narrowest) return k_never;  // touches zero
  Bernstein right = part;
  const Bernstein left = right.split();
  const double fall = fall_within(p, left, from, width / 2);
  return fall < k_never ? fall : fall_within(p, right, from + width / 2, width / 2);
}

/// x^(1/n) within a hundredth, x > 0.
double rough_root(double x, int n) {
  int exponent;
  const double m = std::frexp(x, &exponent), log2 = (exponent + 2 * m - 2) / n, whole = std::floor(log2);
  const double f = log2 - whole;
  return std::ldexp(1 + f * (0.6565 + 0.3435 * f), static_cast<int>(whole));
}

}  // namespace

Falls::Falls(double span, int highest) : span_(span) {
  power_[0] = 1;
  for (std::size_t i = 1; i <= static_cast<std::size_t>(highest); ++i) power_[i] = power_[i - 1] * span;
}

double Falls::first(const Series<double>& polynomial, double sign, double offset) const {
  if (lower_bound(polynomial, sign, offset) > 0) return k_never;
  Polynomial p;
  p.degree = -1;
  for (int i = 0; i <= polynomial.degree; ++i) {
    const double term = scaled(polynomial, sign, i) + (i == 0 ? offset : 0);
    if (p.degree >= 0 || term != 0) p.a[static_cast<std::size_t>(++p.degree)] = term;
  }
  if (p.degree < 0) return k_never;
  if (p[0] < 0) {
    Polynomial negative = p;
    for (double& a : negative.a) a = -a;
    if (!(span_ * fall_within(negative, Bernstein(negative), 0, 1) <= k_arming)) return 0;
  }
  const double fall = fall_within(p, Bernstein(p), 0, 1);
  return fall < k_never ? std::min(fall * span_, span_) : k_never;
}

double Falls::lower_bound(const Series<double>& p, double sign, double offset) const {
  double rest = 0, also = 0;  // two sums, for the processor's sake
  int i = k_nested;
  for (; i < p.degree; i += 2) {
    rest += std::min(0., scaled(p, sign, i));
    also += std::min(0., scaled(p, sign, i + 1));
  }
  if (i == p.degree) rest += std::min(0., scaled(p, sign, i));
  double low = rest + also;
  for (int k = std::min(p.degree, k_nested - 1); k >= 0; --k) low = scaled(p, sign, k) + std::min(0., low);
  return low + offset;
}

Truncation::Truncation(double span, double tolerance, int highest)
    : span_(span), tolerance_(tolerance), highest_(highest) {}

double Truncation::length() const {
  double length = span_;
  if (tolerance_ == 0) return length;
  if (size_ > 0 && last_ > 0) length = std::min(length, rough_root(tolerance_ / size_, last_));
  if (size_before_ > 0 && last_ > 1)
    length = std::min(length, rough_root(tolerance_ / size_before_, last_ - 1));
  return length;
}

}  // namespace topple::planar
