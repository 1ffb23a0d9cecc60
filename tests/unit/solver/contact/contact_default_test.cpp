#include "solver/contact/contact_default.h"

#include <gtest/gtest.h>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

const Vec3 k_down(0, 0, -k_g);

double of(const Setup& setup) {
  return rigid_alpha(setup.model, setup.parameters.contact, k_down).value_or(0);
}

TEST(ContactDefault, slender_block_sinks_by_what_its_landing_allows) {
  const topple::Setup setup = rocking_block(0, 1, 1e-3);
  const double b = 0.19, h = setup.model.bodies[0].centre_of_gravity.z() - 0.015,
               depth = 0.02 * std::pow(b, 4) / std::pow(h, 3);
  EXPECT_NEAR(of(setup), setup.model.bodies[0].mass * k_g / 2 * 0.03 / depth, 1e-9 * of(setup));
}

TEST(ContactDefault, members_give_way_by_a_hundredth_of_what_a_lean_is) {
  const topple::Setup setup = rocking_block(0, 1, 1e-3);
  const double h = setup.model.bodies[0].centre_of_gravity.z() - 0.015, L = 0.03;
  const double depth = std::min({1e-4 * h, 0.01 * 0.19, 0.01 * L}),
               alpha = setup.model.bodies[0].mass * k_g / 2 * L / depth;
  EXPECT_NEAR(member_alpha(setup.model, setup.parameters.contact, k_down).value_or(0), alpha, 1e-9 * alpha);
}

TEST(ContactDefault, contact_width_of_the_floor_counts_and_the_index_of_the_law) {
  topple::Setup setup = rocking_block(0, 1, 1e-3);
  const double narrow = of(setup);
  setup.model.planes[0].width = 0.09;
  EXPECT_NEAR(of(setup), 2 * narrow, 1e-9 * narrow);
  setup.model.planes[0].width = 0;
  setup.parameters.contact.q = 2;
  const double half_weight = setup.model.bodies[0].mass * k_g / 2;
  EXPECT_NEAR(of(setup), narrow * narrow / half_weight, 1e-9 * narrow * narrow / half_weight);
}

TEST(ContactDefault, side_lifts_within_two_percent_of_g_b_over_h) {
  topple::Setup setup = rocking_block(0, 1, 1e-3);
  setup.parameters.contact.alpha = of(setup);
  shake(setup, 1.02 * k_g * 0.19 / 0.895, 0.05);
  setup.run.duration = 5;
  topple::Run run(setup);
  while (!run.over() && !run.outcome().bodies()[0].first_uplift) ASSERT_TRUE(run.advance().ok());
  ASSERT_TRUE(run.outcome().bodies()[0].first_uplift);
  const double t = *run.outcome().bodies()[0].first_uplift;
  EXPECT_NEAR(1.02 * std::sin(2 * k_pi * 0.05 * t), 1, 0.02);
}

TEST(ContactDefault, stiffest_demand_of_all_bodies_counts) {
  topple::Setup one = rocking_block(0, 1, 1e-3);
  const double slender = of(one);
  CabinetSpec lying = tall_cabinet();
  lying.pose = CabinetSpec::Pose::on_back;
  lying.at = Vec3(5, 0, 0);
  topple::Setup both = shaken(1);
  const double cabinet = of(both);
  add_cabinet(both.model, lying);
  EXPECT_DOUBLE_EQ(of(both), cabinet);
  EXPECT_GT(slender, 0);
}

TEST(ContactDefault, there_is_none_without_a_floor_gravity_or_a_base) {
  topple::Setup setup = rocking_block(0, 1, 1e-3);
  EXPECT_FALSE(rigid_alpha(setup.model, {}, Vec3::Zero()));
  setup.model.supports.push_back({0, k_clamped});
  EXPECT_FALSE(rigid_alpha(setup.model, {}, k_down));
  setup.model.supports.clear();
  setup.model.planes.clear();
  EXPECT_FALSE(rigid_alpha(setup.model, {}, k_down));
}

}  // namespace
}  // namespace topple::test
