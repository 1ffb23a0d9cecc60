// Orders of convergence, and fronts of cost and error.
#include "solver/study/precision/convergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace topple::study {
namespace {

/// Sum of n equal parts of exp over 0..1, by values at their ends (order 1), middles (2) or Simpson's rule
/// (4).
double integral(int n, int order) {
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const double a = std::exp(double(k) / n), m = std::exp((k + 0.5) / n), b = std::exp((k + 1.) / n);
    sum += (order == 1 ? a : order == 2 ? m : (a + 4 * m + b) / 6) / n;
  }
  return sum;
}

// With 1/64 and finer the next term of the error, of h^2 relative to the leading one or of h, is below 1 %.
TEST(Convergence, the_order_of_quadrature_rules_is_found) {
  for (const int order : {1, 2, 4}) {
    const double coarse = integral(64, order), middle = integral(128, order), fine = integral(256, order);
    EXPECT_NEAR(observed_order(coarse - middle, middle - fine, 2).value(), order, 0.01) << order;
  }
}

TEST(Convergence, what_does_not_converge_has_no_order) {
  EXPECT_FALSE(observed_order(1e-3, 2e-3, 2));
  EXPECT_FALSE(observed_order(0, 0, 2));
  EXPECT_FALSE(observed_order(1e-3, 0, 2));
  EXPECT_FALSE(observed_order(0, 1e-3, 2));
}

TEST(Convergence, differences_are_root_mean_squares) {
  const double a[] = {1, 2, 3}, b[] = {1, 5, 7};
  EXPECT_DOUBLE_EQ(rms_difference(a, b), std::sqrt((9. + 16.) / 3));
  EXPECT_EQ(rms_difference(a, a), 0);
  EXPECT_EQ(rms_difference({}, {}), 0);
}

TEST(ParetoFront, has_what_nothing_cheaper_or_more_exact_beats) {
  const CostPoint points[] = {{5, 1}, {1, 10},  {2, 10},  {2, 4}, {4, 4},
                              {3, 6}, {10, .1}, {12, .1}, {5, 1}, {1, 20}};
  EXPECT_EQ(pareto_front(points), (std::vector<int>{1, 3, 0, 6}));
  EXPECT_EQ(pareto_front({}), std::vector<int>{});
}

}  // namespace
}  // namespace topple::study
