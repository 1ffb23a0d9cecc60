#include "solver/frame/modes.h"

#include <gtest/gtest.h>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

// Steel beam 50 x 50 mm, 1 m: shear coefficient 5/6.
Model square_beam(int elements, std::vector<Support> supports) {
  Model model;
  Material material = steel();
  material.young = 210e9;
  model.materials.push_back(material);
  const double b = 0.05, i = b * b * b * b / 12;
  model.sections.push_back(plain_section(b * b, i, i, 0.1406 * b * b * b * b, 5. / 6, 5. / 6));
  FrameSpec spec;
  spec.name = "beam";
  spec.nodes = {{0, 0, 0}, {1, 0, 0}};
  spec.members = {{{0, 1}, 0, 0, elements}};
  spec.supports = std::move(supports);
  add_frame(model, spec);
  return model;
}

// Bends along z alone: of each pair of equal modes one is left.
std::vector<Support> simply_supported() {
  return {{0, 0x2f}, {1, 0x2e}};
}

TEST(Modes, simply_supported_beam_has_timoshenkos_frequencies) {
  const double exact[] = {116.774, 461.361, 1017.80, 1763.04};
  double error[2][4];
  for (int k = 0; k < 2; ++k) {
    Model model = square_beam(20 << k, simply_supported());
    for (int i = 0; i < model.node_total(); ++i)
      if (i > 1) model.supports.push_back({i, 0x2a});  // plane bending
    const std::vector<Mode> modes = natural_modes(model, 0, 5);
    ASSERT_EQ(modes.size(), 5u);
    int found = 0;
    for (const Mode& mode : modes) {
      EXPECT_FALSE(mode.rigid);
      double along = 0, across = 0;
      for (const Vec3& u : mode.displacement) {
        along = std::max(along, std::abs(u.x()));
        across = std::max(across, std::abs(u.z()));
      }
      if (across > along && found < 4) {
        error[k][found] = std::abs(mode.frequency - exact[found]) / exact[found];
        ++found;
      }
    }
    ASSERT_EQ(found, 4);
  }
  for (int m = 0; m < 4; ++m) {
    SCOPED_TRACE(m);
    // lumped masses and elements of second order; six printed digits
    EXPECT_LT(error[1][m], error[0][m] / 3.5 + 5e-6);
    EXPECT_LT(error[1][m], 6e-3 * (m + 1) / 4);
  }
}

TEST(Modes, free_body_has_exactly_six_rigid_modes) {
  std::vector<Model> bodies;
  bodies.push_back(square_beam(2, {}));
  bodies.push_back(square_beam(300, {}));
  bodies.push_back(steel_model());
  add_cabinet(bodies.back(), tall_cabinet());
  for (const Model& model : bodies) {
    SCOPED_TRACE(model.bodies[0].name);
    const std::vector<Mode> modes = natural_modes(model, 0, 9);
    ASSERT_EQ(modes.size(), 9u);
    for (int k = 0; k < 9; ++k) {
      EXPECT_EQ(modes[k].rigid, k < 6) << k;
      EXPECT_EQ(modes[k].frequency > 1, k >= 6) << modes[k].frequency;
      EXPECT_EQ(modes[k].frequency == 0, k < 6) << modes[k].frequency;
    }
  }
}

TEST(Modes, supports_leave_the_rigid_motions_that_they_do_not_hold) {
  const auto rigid = [](std::vector<Support> supports) {
    int count = 0;
    for (const Mode& mode : natural_modes(square_beam(4, std::move(supports)), 0, 8)) count += mode.rigid;
    return count;
  };
  EXPECT_EQ(rigid({{0, k_clamped}}), 0);
  EXPECT_EQ(rigid({{0, 0x07}}), 3);             // a ball joint
  EXPECT_EQ(rigid({{0, 0x07}, {1, 0x06}}), 1);  // turns about its axis
  EXPECT_EQ(rigid({{0, 0x0f}, {1, 0x06}}), 0);
  EXPECT_EQ(rigid({{0, 0x38}}), 3);  // slides
}

TEST(Modes, large_and_small_bodies_are_solved_to_the_same_frequencies) {
  // 13 nodes: asked for few the Krylov way is taken, asked for many all vectors at once
  const Model model = square_beam(12, {});
  const std::vector<Mode> few = natural_modes(model, 0, 12), all = natural_modes(model, 0, 78);
  ASSERT_EQ(all.size(), 78u);
  for (std::size_t k = 6; k < few.size(); ++k)
    EXPECT_NEAR(few[k].frequency, all[k].frequency, 1e-6 * all[k].frequency) << k;
}

// The highest frequencies are those of nodes that weigh almost nothing: no measure of the lowest.
TEST(Modes, a_mass_on_a_light_cantilever_sways) {
  Model model;
  Material material = steel();
  material.density = 1e-3;
  model.materials.push_back(material);
  const double side = 0.02, i = side * side * side * side / 12, mass = 50;
  model.sections.push_back(
      plain_section(side * side, i, i, 0.1406 * side * side * side * side, 5. / 6, 5. / 6));
  FrameSpec spec;
  spec.name = "mast";
  spec.nodes = {{0, 0, 0}, {0, 0, 1}};
  spec.members = {{{0, 1}, 0, 0, 40}};
  spec.masses = {{1, mass}};
  spec.supports = {{0, k_clamped}};
  add_frame(model, spec);
  const std::vector<Mode> modes = natural_modes(model, 0, 4);
  ASSERT_EQ(modes.size(), 4u);
  for (const Mode& mode : modes) EXPECT_FALSE(mode.rigid);
  // shear takes 3e-4, forty elements a little more
  const double exact = std::sqrt(3 * material.young * i / mass) / (2 * k_pi);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(modes[k].frequency, exact, 2e-3 * exact);
}

TEST(Modes, a_held_body_has_no_rigid_modes_however_many_are_asked_for) {
  const Model model = square_beam(80, simply_supported());
  for (int count : {15, 20, 30}) {
    const std::vector<Mode> modes = natural_modes(model, 0, count);
    ASSERT_EQ(modes.size(), static_cast<std::size_t>(count));
    for (const Mode& mode : modes) EXPECT_GT(mode.frequency, 100) << count;
  }
}

TEST(Modes, shapes_solve_the_problem_and_effective_masses_add_up) {
  const Model model = square_beam(4, {{0, k_clamped}});
  const std::vector<Mode> modes = natural_modes(model, 0, 1000);
  ASSERT_EQ(modes.size(), 24u);
  Vec3 mass = Vec3::Zero();
  for (const Mode& mode : modes) {
    mass += mode.effective_mass;
    double norm = 0;
    for (int i = 0; i < model.node_total(); ++i)
      norm += model.node_mass[i] * mode.displacement[i].squaredNorm() +
              mode.rotation[i].dot(model.node_inertia[i] * mode.rotation[i]);
    EXPECT_NEAR(norm, 1, 1e-9);
  }
  // all but what hangs on the support itself
  const double moving = model.bodies[0].mass - model.node_mass[0];
  EXPECT_LT((mass - Vec3::Constant(moving)).norm(), 1e-9 * moving);
}

}  // namespace
}  // namespace topple::test
