// Power series of the time since the start of a step, and where they change sign. P: double, or a pack of
// runs (pack.h).
#pragma once

#include <algorithm>
#include <array>

#include "solver/math/lanes.h"

namespace topple::planar {

inline constexpr int k_order = 20;           ///< highest power of an acceleration that is kept
inline constexpr int k_terms = k_order + 3;  ///< of a motion: that, integrated twice
inline constexpr double k_never = 1e300;     ///< s
inline constexpr auto k_reciprocal = [] {    ///< 1/i
  std::array<double, k_terms + 1> of{};
  for (int i = 1; i <= k_terms; ++i) of[static_cast<std::size_t>(i)] = 1. / i;
  return of;
}();

/// term[0] + term[1] t + ... + term[degree] t^degree; what lies above is undefined. Of a pack no lane's
/// own degree, `last()`, is above `degree`; from there on the lane is zero.
template <class P>
struct Series {
  std::array<P, k_terms> term;
  int degree = 0;

  Series() = default;
  Series(P constant) { *this = constant; }
  Series& operator=(P constant) {
    term[0] = constant;
    end(0, P(0));
    return *this;
  }
  /// Lanes end at `each`, none above `greatest`.
  void end(int greatest, P each) {
    degree = greatest;
    if constexpr (k_is_pack<P>) {
      each_ = each;
      for (int i = greatest; bits(each < P(i)) != 0; --i) (*this)[i] = choose(each < P(i), P(0), (*this)[i]);
    }
  }
  P last() const {
    if constexpr (k_is_pack<P>)
      return each_;
    else
      return P(degree);
  }
  /// That of one lane.
  Series<double> alone(int k) const {
    Series<double> of;
    of.degree = static_cast<int>(of_lane(last(), k));
    for (int i = 0; i <= of.degree; ++i) of[i] = of_lane((*this)[i], k);
    return of;
  }
  P& operator[](int i) { return term[static_cast<std::size_t>(i)]; }
  const P& operator[](int i) const { return term[static_cast<std::size_t>(i)]; }

  P at(P t) const {
    P sum = (*this)[degree];
    for (int i = degree; i-- > 0;) sum = (*this)[i] + t * sum;
    return sum;
  }
  P slope_at(P t) const {
    P sum(0);
    for (int i = degree; i > 0; --i) sum = P(i) * (*this)[i] + t * sum;
    return sum;
  }
  /// Term i, 0 beyond the degree.
  P or_zero(int i) const { return i <= degree ? (*this)[i] : P(0); }

 private:
  struct None {};
  [[no_unique_address]] std::conditional_t<k_is_pack<P>, P, None> each_{};
};

/// Term i of the product a b, b known to its degree and a to term i - first_of_b.
template <class P>
[[gnu::always_inline]] inline P product_term(const Series<P>& a, const Series<P>& b, int i, int b_degree,
                                             int first_of_b = 0) {
  P even(0), odd(0);  // two sums, for the processor's sake
  const int last = std::min(i, b_degree);
  int j = first_of_b;
  for (; j < last; j += 2) {
    even = even + a[i - j] * b[j];
    odd = odd + a[i - j - 1] * b[j + 1];
  }
  if (j == last) even = even + a[i - j] * b[j];
  return even + odd;
}
template <class P>
[[gnu::always_inline]] inline P product_term(const Series<P>& a, const Series<P>& b, int i) {
  return product_term(a, b, i, i);
}

inline constexpr double k_arming = 1e-7;  ///< s

/// Where polynomials fall below zero within 0..span, s.
template <class P>
class Falls {
 public:
  /// Of polynomials up to this degree.
  Falls(P span, int highest);

  /// The first t at which sign * polynomial + offset falls below zero, else k_never. One that begins below
  /// zero and does not rise above it within k_arming falls at 0; what an event has just set to zero may begin
  /// a rounding error below it. No root is missed: the polynomial is split until the signs of its Bernstein
  /// coefficients tell (Descartes' rule), down to 2^-45 of the span.
  P first(const Series<P>& polynomial, P sign, P offset) const;

 private:
  static constexpr int k_nested = 4;
  P scaled(const Series<P>& p, P sign, int i) const {
    return sign * p[i] * power_[static_cast<std::size_t>(i)];
  }
  /// Of its values: t q >= min(0, least q), term by term from k_nested on.
  P lower_bound(const Series<P>& polynomial, P sign, P offset) const;

  P span_;
  std::array<P, k_terms> power_;
};

/// Where the series of a step end: at order `highest`, or earlier where the terms within `span` fall below
/// `tolerance`; then how long they hold. Each lane has its own end; terms beyond it do no harm.
template <class P>
class Truncation {
 public:
  Truncation(P span, P tolerance, P highest);

  /// Term i of a series of accelerations has this size; called for i = 0, 1, ...; true for the last.
  bool ends(int i, P size) {
    const P here = size * power_;
    auto last = highest_ <= P(i);
    if (i >= k_fewest) last = last | ((here <= tolerance_) & (before_ <= tolerance_));
    last = last & open_;
    if (bits(last) != 0) {
      greatest_ = i;
      last_ = choose(last, P(i), last_);
      size_ = choose(last, size, size_), size_before_ = choose(last, unscaled_before_, size_before_);
      open_ = open_ & complement(last);
    }
    before_ = here, unscaled_before_ = size;
    power_ = power_ * span_;
    return bits(open_) == 0;
  }
  /// Time within which the last two terms stay below the tolerance, s, at most the span.
  P length() const;
  P last() const { return last_; }                     ///< order of the last term
  int greatest() const { return greatest_; }           ///< of the lanes' last ones
  void limit(P span) { span_ = lesser(span, span_); }  ///< before the first term

 private:
  static constexpr int k_fewest = 5;
  P span_, tolerance_, highest_, last_{0};
  P power_{1}, before_{0}, unscaled_before_{0}, size_{0}, size_before_{0};
  int greatest_ = 0;
  MaskOf<P> open_ = P(0) <= P(0);
};

}  // namespace topple::planar
