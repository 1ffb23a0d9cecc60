#include "solver/study/elements/theory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace topple::study {
namespace {

TEST(Theory, elastica_has_the_printed_values) {
  const struct {
    double load, shortening, deflection, angle;
  } printed[] = {{1, .056433, .301721, .461352},
                 {2, .160642, .493457, .781750},
                 {5, .387628, .713792, 1.215368},
                 {10, .554996, .810609, 1.430286}};
  for (const auto& row : printed) {
    SCOPED_TRACE(row.load);
    const Elastica found = elastica(row.load);
    EXPECT_NEAR(found.shortening, row.shortening, 6e-7);
    EXPECT_NEAR(found.deflection, row.deflection, 6e-7);
    EXPECT_NEAR(found.angle, row.angle, 6e-7);
  }
}

TEST(Theory, elastica_is_a_linear_beam_under_a_small_load) {
  const double load = 1e-4;
  EXPECT_NEAR(elastica(load).deflection / (load / 3), 1, 1e-7);
  EXPECT_NEAR(elastica(load).angle / (load / 2), 1, 1e-7);
}

TEST(Theory, limit_of_a_parabola_is_its_value_at_zero) {
  const auto parabola = [](double h) { return 7 + 3 * h * h; };
  const Limit limit = second_order_limit(parabola(4), parabola(2), parabola(1));
  EXPECT_NEAR(limit.value, 7, 1e-14);
  EXPECT_NEAR(limit.uncertainty, 0, 1e-14);
  const auto quartic = [&](double h) { return parabola(h) + std::pow(h, 4); };
  const Limit other = second_order_limit(quartic(.4), quartic(.2), quartic(.1));
  EXPECT_LT(std::abs(other.value - 7), other.uncertainty);
}

}  // namespace
}  // namespace topple::study
