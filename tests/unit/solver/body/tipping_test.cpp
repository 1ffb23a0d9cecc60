// The angle at which a body tips, and what bending takes off it.
#include "solver/reduced/tipping.h"

#include "solver/math/elementary.h"
#include "unit/solver/body_models.h"

namespace topple::test {
namespace {

constexpr double k_base_half = 0.15, k_column = 1.5, k_leg = 0.45, k_top = 30;  // m, m, m, kg

/// A mass, whose axes are the body's, on a slender column on a stiff square base of no weight.
topple::Setup mass_on_a_column(double young) {
  topple::Setup setup;
  const Material stiff{"stiff", 1e15, 0.3, 1e-2}, column{"column", young, 0.3, 1e-2};
  setup.model.materials = {stiff, column};
  setup.model.sections = {plain_section(1e-3, 1e-7, 1e-7, 2e-7, 0.8, 0.8)};
  FrameSpec spec;
  spec.name = "column";
  for (const double x : {-1, 1})
    for (const double y : {-1, 1}) spec.nodes.emplace_back(k_base_half * x, k_base_half * y, 0.015);
  spec.nodes.emplace_back(0, 0, 0.015);
  spec.nodes.emplace_back(0, 0, 0.015 + k_column);
  for (int corner = 0; corner < 4; ++corner) spec.members.push_back({{corner, 4}, 0, 0});
  spec.members.push_back({{4, 5}, 0, 1});
  spec.masses.push_back({5, k_top, Vec3::Constant(100)});
  setup.starts = add_frame(setup.model, spec);
  setup.model.planes.push_back(ground());
  compute_as(setup, BodyModel::automatic);
  return setup;
}

TEST(Tipping, begins_when_the_centre_of_gravity_stands_above_an_edge) {
  const topple::Setup setup = mass_on_a_column(205e9);
  EXPECT_NEAR(least_tipping_angle(setup.model.bodies[0]), std::atan(k_base_half / k_column), 1e-4);
  Body none = setup.model.bodies[0];
  none.support_polygon.clear();
  EXPECT_EQ(least_tipping_angle(none), std::numeric_limits<double>::infinity());
}

// At that angle a weight W acts along the line from the edge: W b/R across the column, W H/R along it. Seen
// from the mass, which turns with the column's end, the edge moves outward by what bending shifts it, less
// shear, and up by the turn and by what the column is shortened.
TEST(Tipping, changes_by_what_the_column_bends) {
  for (const double young : {205e9, 10e9}) {
    const topple::Setup setup = mass_on_a_column(young);
    const double weight = k_top * k_g, R = std::hypot(k_base_half, k_column);
    const double across = weight * k_base_half / R, along = weight * k_column / R;
    const double EI = young * 1e-7, kGA = 0.8 * young / 2.6 * 1e-3, EA = young * 1e-3;
    const double out = across * (std::pow(k_column, 3) / (6 * EI) - k_column / kGA);
    const double up = across * k_column * k_column / (2 * EI) * k_base_half + along * k_column / EA;
    const double change = (k_column * out + k_base_half * up) / (R * R) / std::atan(k_base_half / k_column);
    // the base's own weight and bending take less than a thousandth
    EXPECT_NEAR(tipping_error(setup.model, 0, k_g), change, 2e-3 * change);
    EXPECT_GT(change, young > 1e11 ? 1e-3 : 0.02);
  }
}

/// Two portals side by side, of which each bears half of the mass in the middle of its beam.
topple::Setup stool(double young) {
  topple::Setup setup;
  setup.model.materials = {{"stiff", 1e12, 0.3, 10}, {"soft", young, 0.3, 10}};
  setup.model.sections = {plain_section(1e-2, 1e-7, 1e-7, 2e-7, 1e3, 1e3)};
  FrameSpec spec;
  spec.name = "stool";
  for (const double y : {-k_base_half, k_base_half}) {
    const int first = static_cast<int>(spec.nodes.size());
    for (const double x : {-k_base_half, k_base_half}) {
      spec.nodes.emplace_back(x, y, 0.015);
      spec.nodes.emplace_back(x, y, 0.015 + k_leg);
    }
    spec.nodes.emplace_back(0, y, 0.015 + k_leg);
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(2, 3), std::pair(1, 4), std::pair(4, 3)})
      spec.members.push_back({{first + i, first + j}, 0, 1});
    spec.masses.push_back({first + 4, k_top / 2, Vec3::Constant(1)});
  }
  spec.members.push_back({{4, 9}, 0, 0});
  setup.starts = add_frame(setup.model, spec);
  setup.model.planes.push_back(ground());
  compute_as(setup, BodyModel::automatic);
  return setup;
}

// The weight in the middle turns a beam's ends by W L^2/(16 EI); feet of length h move outward by h times
// that, and to hold two back takes a force of that over h^3/(3 EI) + h^2 L/(2 EI) (moment theorems of portal
// frames).
TEST(Tipping, frees_what_friction_holds_of_spread_legs) {
  for (const double young : {205e9, 10e9}) {
    const topple::Setup setup = stool(young);
    const double EI = young * 1e-7, L = 2 * k_base_half, h = k_leg, weight = k_top / 2 * k_g;
    const double out = weight * L * L / (16 * EI) * h, give = h * h * h / (3 * EI) + h * h * L / (2 * EI);
    const double energy = 2 * out * out / give;                             // of two portals, two feet each
    EXPECT_NEAR(splay_energy(setup.model, 0, k_g), energy, 0.02 * energy);  // members weigh 1 % of it
  }
}

TEST(Tipping, is_an_error_of_a_rigid_body_only_where_the_floor_can_lift_or_slide_it) {
  topple::Setup setup = stool(10e9);
  Parameters& p = setup.parameters;
  const double angle = least_tipping_angle(setup.model.bodies[0]), lifts = k_g * std::tan(angle);
  p.contact.friction = 1.5;
  const double loose = rigid_error(setup.model, p, 0);
  const double height = setup.model.bodies[0].centre_of_gravity.z() - 0.015;
  const double R = std::hypot(k_base_half, height);
  const double barrier = setup.model.bodies[0].mass * k_g * R * (1 - std::cos(angle));
  EXPECT_NEAR(loose, std::sqrt(splay_energy(setup.model, 0, k_g) / barrier), 1e-3 * loose);
  shake(setup, 0.99 * lifts, 1);
  const double w = setup.model.bodies[0].elastic->frequency[0];
  const double sway = 0.99 * lifts / (w * w) / (height * angle);
  EXPECT_NEAR(rigid_error(setup.model, p, 0), sway, 1e-3 * sway);
  p.shakes[0].amplitude = 1.01 * lifts;
  EXPECT_EQ(rigid_error(setup.model, p, 0), loose);
  p.shakes[0].amplitude = 0.5 * lifts;
  p.contact.friction = 0.45 * std::tan(angle);
  EXPECT_EQ(rigid_error(setup.model, p, 0), loose);  // it slides
  p.contact.friction = 0.55 * std::tan(angle);
  EXPECT_LT(rigid_error(setup.model, p, 0), sway);
}

TEST(Tipping, of_a_body_without_modes_is_not_known_to_change) {
  topple::Setup setup = mass_on_a_column(205e9);
  setup.model.bodies[0].elastic = nullptr;
  EXPECT_EQ(tipping_error(setup.model, 0, k_g), 0);
}

}  // namespace
}  // namespace topple::test
