// Factors and rates that a base on springs gives a block. Runs beside rigid bodies: planar_case_test.cpp.
#include "solver/planar/sprung_base.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "unit/solver/planar/planar_blocks.h"

namespace topple::planar::test {
namespace {

constexpr double k_newtons = 9.80665, k_length = 0.03;  // N/kgf; m, L of Eq. 2

ContactLaw law_of(double kgf, double q = 1) {
  ContactLaw law;
  law.alpha = kgf * k_newtons;
  law.q = q;
  return law;
}

/// So many points on the left edge, in the middle and on the right edge.
SprungBase base_of(const Block& block, const std::array<std::size_t, 3>& points, const ContactLaw& law) {
  const BaseLine base[] = {{-block.left, std::vector<int>(points[0])},
                           {(block.right - block.left) / 2, std::vector<int>(points[1])},
                           {block.right, std::vector<int>(points[2])}};
  return {block, base, law, k_length};
}

// Stiff contacts far stiffer in the middle than on the edges stop the base there first, about which the rate
// stays as it is (k^2 + h^2 of it about each point of the base below the centre of gravity); an edge then
// leaves (k^2 + h^2)/(k^2 + h^2 + b^2) of it, Housner's condition (k^2 + h^2 - b^2)/(k^2 + h^2 + b^2). Far
// softer there they take nothing. The other lines sink 63 times slower than the stiff ones.
TEST(SprungBase, middle_that_is_stiff_stops_the_base_before_its_edge_does) {
  const Block block = uniform_block(0.2, 0.9, 1);
  const double about_middle = block.inertia_over_mass() + block.height * block.height,
               b2 = block.right * block.right;
  ContactLaw law = law_of(1e9);
  law.normal_speed = 1e-6;  // as good as none
  for (const double rate : {0.2, 1.}) {
    EXPECT_NEAR(base_of(block, {1, 4000, 1}, law).landing_factor(block, Side::right, rate),
                about_middle / (about_middle - b2), 2e-3);
    EXPECT_NEAR(base_of(block, {4000, 1, 4000}, law).landing_factor(block, Side::right, rate), 1, 1e-3);
  }
}

// But for rounding, which grows in what touches and lets go.
TEST(SprungBase, left_and_right_are_alike) {
  const Block block = uniform_block(0.2, 0.9, 1);
  const SprungBase base = base_of(block, {3, 2, 3}, law_of(1e4));
  const double threshold = block.gravity * 0.2 / 0.9;
  for (const double rate : {1e-4, 0.1, 0.5})
    EXPECT_NEAR(base.landing_factor(block, Side::left, rate), base.landing_factor(block, Side::right, rate),
                1e-9);
  for (const double growth : {0., 1., 20.}) {
    const double right = base.lift_rate(block, Side::right, -threshold, -growth, block.gravity);
    EXPECT_NEAR(base.lift_rate(block, Side::left, threshold, growth, block.gravity), right, 1e-9);
    EXPECT_GT(right, 0);
  }
}

// An edge sinks by W L/alpha at q = 1, and a lean of that over half of the base is what it gains from.
TEST(SprungBase, stiff_contacts_hardly_let_it_lean) {
  const Block block = uniform_block(0.2, 0.9, 1);
  const double threshold = block.gravity * 0.2 / 0.9;
  const auto rate = [&](double kgf) {
    return base_of(block, {3, 2, 3}, law_of(kgf))
        .lift_rate(block, Side::right, -threshold, -20, block.gravity);
  };
  EXPECT_LT(rate(1e6), rate(1e4) / 30);
  EXPECT_LT(rate(1e8), rate(1e6) / 30);
}

// What is asked for may have contacts of any softness.
TEST(SprungBase, gains_no_energy_and_stays_finite_on_any_contacts) {
  std::mt19937 random(1);
  const auto even = [&](double low, double high) {
    return low + (high - low) * (random() / static_cast<double>(std::mt19937::max()));
  };
  const auto spread = [&](double low, double high) { return std::exp(even(std::log(low), std::log(high))); };
  for (int k = 0; k < 500; ++k) {
    Block block = uniform_block(spread(0.01, 1), spread(0.01, 2), 1);
    block.mass *= spread(1e-4, 1e3), block.inertia *= spread(1e-4, 1e3);
    block.left *= even(0.1, 1);
    ContactLaw law = law_of(spread(1e-3, 1e6), k % 3 == 0 ? even(0.5, 3) : 1);
    law.normal_speed = k % 5 == 0 ? spread(1e-3, 1) : law.normal_speed;
    const SprungBase base = base_of(block, {1 + random() % 4, 1 + random() % 4, 1 + random() % 4}, law);
    const Side side = k % 2 == 0 ? Side::right : Side::left;
    const double about_middle = block.inertia_over_mass() + block.height * block.height,
                 kept = about_middle - block.left * block.right,
                 most = std::sqrt((about_middle + block.left * block.left) *
                                  (about_middle + block.right * block.right));
    const double factor = base.landing_factor(block, side, spread(1e-8, 20));
    EXPECT_TRUE(factor >= 0 && (!(kept > 0) || factor * kept <= most * (1 + 1e-12))) << k << ": " << factor;
    const double push = -block.edge(side) / block.height * block.gravity * even(1, 3),
                 rate = base.lift_rate(block, side, push, (push < 0 ? -1 : 1) * spread(1e-3, 1e5),
                                       block.gravity);
    EXPECT_TRUE(rate >= 0 && std::isfinite(rate)) << k << ": " << rate;
  }
}

}  // namespace
}  // namespace topple::planar::test
