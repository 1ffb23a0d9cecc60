#include "solver/planar/power_series.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "solver/math/bits.h"

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

/// On 0..1, all leading terms that are zero removed: the sign for t > 0 stays. -1: of degree, where all are.
template <class P>
struct Polynomial {
  std::array<P, k_terms> a;
  int degree;  ///< greatest
  P last;      ///< degree of each

  P operator[](int i) const { return a[static_cast<std::size_t>(i)]; }

  void remove_leading_zeros(MaskOf<P> where) {
    for (;;) {
      const auto zero = where & (a[0] == P(0)) & (P(0) <= last);
      if (bits(zero) == 0) return;
      for (std::size_t i = 0; i < static_cast<std::size_t>(degree); ++i) a[i] = choose(zero, a[i + 1], a[i]);
      a[static_cast<std::size_t>(degree)] = choose(zero, P(0), a[static_cast<std::size_t>(degree)]);
      last = choose(zero, last - P(1), last);
      if constexpr (!k_is_pack<P>) --degree;
    }
  }
  /// Falls within low..high, in which it changes its sign once, in the lanes that are open; by Newton's
  /// method, bisection where that leaves.
  P root(P low, P high, P t, MaskOf<P> open) const {
    P root = t;
    for (int round = 0; round < 100; ++round) {
      P value = (*this)[degree], slope(0);
      for (int i = degree; i-- > 0;) slope = value + t * slope, value = (*this)[i] + t * value;
      const auto above = P(0) < value;
      low = choose(above, t, low), high = choose(above, high, t);
      const P next = t - value / slope;
      if (const auto found = open & (magnitude(next - t) <= P(k_last_step) * t); bits(found) != 0) {
        root = choose(found, clamp(next, low, high), root);
        open = open & complement(found);
        if (bits(open) == 0) return root;
      }
      const auto outside = open & complement((low < next) & (next < high));
      t = next;
      if (bits(outside) != 0) t = choose(outside, (low + high) / P(2), next);
    }
    return choose(open, t, root);
  }
};

template <class P>
struct Bernstein {
  std::array<P, k_terms> b;
  int degree;
  P last;

  Bernstein() = default;
  explicit Bernstein(const Polynomial<P>& p) : degree(p.degree), last(p.last) {
    const auto n = static_cast<std::size_t>(std::max(degree, 0));
    const auto share_of = [](double of) -> const Terms& {
      return k_one_over_binomial[static_cast<std::size_t>(std::max(0., of))];
    };
    const double all = of_lane(last, 0);
    if (bits(complement(last == P(all))) == 0) {
      const Terms& share = share_of(all);
      for (std::size_t i = 0; i <= n; ++i) b[i] = p.a[i] * P(share[i]);
    } else {
      const auto shares = per_lane<P>([&](int k) { return &share_of(of_lane(last, k)); });
      for (std::size_t i = 0; i <= n; ++i)
        b[i] = p.a[i] * pack_of<P>([&](int k) { return (*of_lane(shares, k))[i]; });
    }
    for (std::size_t k = 0; k < n; ++k) {
      P before = b[k];
      for (std::size_t i = k + 1; i <= n; ++i) before = std::exchange(b[i], b[i] + before);
    }
    if constexpr (k_is_pack<P>)
      for (std::size_t i = 0; i <= n; ++i) b[i] = choose(P(double(i)) <= last, b[i], P(0));
  }
  /// Changes of sign and the first sign.
  struct Signs {
    P changes{0}, first{0};
  };
  Signs signs() const {
    Signs of;
    P before(0);
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
      const auto change = ((before < P(0)) & (P(0) < b[i])) | ((P(0) < before) & (b[i] < P(0)));
      of.changes = of.changes + choose(change, P(1), P(0));
      of.first = choose(of.first == P(0), b[i], of.first);
      before = choose(b[i] == P(0), before, b[i]);
    }
    return of;
  }
  /// Where its control polygon crosses zero, in 0..1.
  P crossing() const {
    P at(1);
    auto open = P(0) <= P(0);
    for (std::size_t i = 1; i <= static_cast<std::size_t>(degree) && bits(open) != 0; ++i) {
      const auto here = open & (b[i] <= P(0));
      open = open & complement(here);
      if (bits(here) != 0) at = choose(here, (P(double(i) - 1) + b[i - 1] / (b[i - 1] - b[i])) / last, at);
    }
    return at;
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

double fall_within(const Polynomial<double>& p, const Bernstein<double>& part, double from, double width) {
  const auto [changes, first] = part.signs();
  if (changes == 0 || (changes == 1 && first < 0)) return k_never;
  if (changes == 1) return p.root(from, from + width, from + width * part.crossing(), true);
  if (width < k_narrowest) return k_never;  // touches zero
  Bernstein<double> right = part;
  const Bernstein<double> left = right.split();
  const double fall = fall_within(p, left, from, width / 2);
  return fall < k_never ? fall : fall_within(p, right, from + width / 2, width / 2);
}

template <class P>
Polynomial<double> alone(const Polynomial<P>& p, int k) {
  Polynomial<double> of;
  of.last = of_lane(p.last, k), of.degree = static_cast<int>(of.last);
  for (std::size_t i = 0; i <= static_cast<std::size_t>(of.degree); ++i) of.a[i] = of_lane(p.a[i], k);
  return of;
}

/// In the lanes that are open; k_never in the others.
template <class P>
P falls(const Polynomial<P>& p, MaskOf<P> open) {
  const Bernstein<P> whole(p);
  const auto [changes, first] = whole.signs();
  const auto once = open & (changes == P(1)) & complement(first < P(0));
  P fall(k_never);
  if (bits(once) != 0) fall = choose(once, p.root(P(0), P(1), whole.crossing(), once), fall);
  for_lanes(open & (P(1) < changes), [&](int k) {
    const Polynomial<double> one = alone(p, k);
    set_lane(fall, k, fall_within(one, Bernstein<double>(one), 0, 1));
  });
  return fall;
}

/// 2^n, -1022 <= n <= 1023
double power_of_2(int n) {
  return bits_as<double>(static_cast<std::uint64_t>(n + 1023) << 52);
}

/// x^(1/n) within a hundredth, x > 0.
double rough_root(double x, int n) {
  int exponent;
  const double m = std::frexp(x, &exponent), log2 = (exponent + 2 * m - 2) / n, whole = std::floor(log2);
  const double f = log2 - whole;
  return (1 + f * (0.6565 + 0.3435 * f)) * power_of_2(std::clamp(static_cast<int>(whole), -1022, 1023));
}

}  // namespace

template <class P>
Falls<P>::Falls(P span, int highest) : span_(span) {
  power_[0] = P(1);
  for (std::size_t i = 1; i <= static_cast<std::size_t>(highest); ++i) power_[i] = power_[i - 1] * span;
}

template <class P>
P Falls<P>::first(const Series<P>& polynomial, P sign, P offset) const {
  auto open = complement(P(0) < lower_bound(polynomial, sign, offset));
  P first(k_never);
  if (bits(open) == 0) return first;
  Polynomial<P> p;
  p.degree = polynomial.degree, p.last = polynomial.last();
  for (int i = 0; i <= p.degree; ++i) p.a[static_cast<std::size_t>(i)] = scaled(polynomial, sign, i);
  p.a[0] = p.a[0] + offset;
  p.remove_leading_zeros(open);
  open = open & (P(0) <= p.last);
  for_lanes(open & (p.a[0] < P(0)), [&](int k) {
    Polynomial<double> negative = alone(p, k);
    for (double& a : negative.a) a = -a;
    if (of_lane(span_, k) * falls(negative, true) <= k_arming) return;
    set_lane(first, k, 0);
  });
  open = open & (P(0) < first);
  if (bits(open) == 0) return first;
  const P fall = falls(p, open);
  return choose(open & (fall < P(k_never)), lesser(span_, fall * span_), first);
}

template <class P>
P Falls<P>::lower_bound(const Series<P>& p, P sign, P offset) const {
  P rest(0), also(0);  // two sums, for the processor's sake
  int i = k_nested;
  for (; i < p.degree; i += 2) {
    rest = rest + lesser(scaled(p, sign, i), P(0));
    also = also + lesser(scaled(p, sign, i + 1), P(0));
  }
  if (i == p.degree) rest = rest + lesser(scaled(p, sign, i), P(0));
  P low = rest + also;
  for (int k = std::min(p.degree, k_nested - 1); k >= 0; --k) low = scaled(p, sign, k) + lesser(low, P(0));
  return low + offset;
}

template <class P>
Truncation<P>::Truncation(P span, P tolerance, P highest)
    : span_(span), tolerance_(tolerance), highest_(highest) {}

template <class P>
P Truncation<P>::length() const {
  return pack_of<P>([&](int k) {
    const double tolerance = of_lane(tolerance_, k), size = of_lane(size_, k),
                 before = of_lane(size_before_, k);
    const int last = static_cast<int>(of_lane(last_, k));
    double length = of_lane(span_, k);
    if (tolerance == 0) return length;
    if (size > 0 && last > 0) length = std::min(length, rough_root(tolerance / size, last));
    if (before > 0 && last > 1) length = std::min(length, rough_root(tolerance / before, last - 1));
    return length;
  });
}

template class Falls<double>;
template class Falls<Four>;
template class Truncation<double>;
template class Truncation<Four>;

}  // namespace topple::planar
