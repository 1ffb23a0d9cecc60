#include "solver/frame/generalized_alpha.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

Simulation plucked(double rho, double h, double x0) {
  Parameters p = weightless();
  p.spectral_radius = rho;
  p.time_step = h;
  const Model model = oscillator();
  Simulation sim(model, {BodyStart{}}, p);
  sim.state.position[1].x() += x0;
  prepare(model, p, sim.state, sim.workspace());
  return sim;
}

TEST(GeneralizedAlpha, coefficients_are_chung_and_hulberts) {
  const GeneralizedAlpha one(1), zero(0), middle(0.5);
  EXPECT_DOUBLE_EQ(one.alpha_m, 0.5);
  EXPECT_DOUBLE_EQ(one.alpha_f, 0.5);
  EXPECT_DOUBLE_EQ(one.gamma, 0.5);
  EXPECT_DOUBLE_EQ(one.beta, 0.25);
  EXPECT_DOUBLE_EQ(zero.alpha_m, -1);
  EXPECT_DOUBLE_EQ(zero.alpha_f, 0);
  EXPECT_DOUBLE_EQ(zero.gamma, 1.5);
  EXPECT_DOUBLE_EQ(zero.beta, 1);
  EXPECT_DOUBLE_EQ(middle.alpha_m, 0);
  EXPECT_DOUBLE_EQ(middle.alpha_f, 1. / 3);
  EXPECT_DOUBLE_EQ(middle.beta, 4. / 9);
}

TEST(GeneralizedAlpha, follows_a_linear_oscillator_with_second_order) {
  for (double rho : {0., 0.5, 0.8, 1.}) {
    SCOPED_TRACE(rho);
    double error[3];
    for (int k = 0; k < 3; ++k) {
      const double h = 2e-3 / (1 << k);
      Simulation sim = plucked(rho, h, 0.01);
      ASSERT_TRUE(sim.advance(100 << k));
      const double t = 0.2;
      error[k] =
          std::max(std::abs(sim.state.position[1].x() - 1 - 0.01 * std::cos(k_oscillation * t)),
                   std::abs(sim.state.velocity[1].x() / k_oscillation + 0.01 * std::sin(k_oscillation * t)));
    }
    EXPECT_NEAR(error[0] / error[1], 4, 0.5);
    EXPECT_NEAR(error[1] / error[2], 4, 0.3);
  }
}

TEST(GeneralizedAlpha, keeps_the_energy_of_a_linear_oscillator_when_rho_is_one) {
  for (double h : {1e-3, 0.02, 0.5}) {
    Simulation sim = plucked(1, h, 0.01);
    const double before = sim.state.energy.strain;
    ASSERT_TRUE(sim.advance(1000));
    // 1000 steps of rounding; positions near 1 m hold 1e-16 of it against 0.01 m
    EXPECT_NEAR(sim.state.energy.strain + sim.state.energy.kinetic, before, 1e-9 * before) << "step " << h;
    EXPECT_NEAR(sim.state.energy.numerical, 0, 1e-9 * before);
  }
}

TEST(GeneralizedAlpha, books_as_numerical_what_a_linear_oscillator_loses) {
  for (double rho : {0., 0.5, 0.8})
    for (double h : {2e-3, 0.02, 0.1}) {
      SCOPED_TRACE(testing::Message() << "rho " << rho << ", step " << h);
      Simulation sim = plucked(rho, h, 0.01);
      const double before = sim.state.energy.strain;
      ASSERT_TRUE(sim.advance(50));
      const double lost = before - sim.state.energy.strain - sim.state.energy.kinetic;
      EXPECT_GT(lost, 1e-6 * before);
      EXPECT_NEAR(sim.state.energy.numerical, lost, 1e-9 * before);
    }
}

// Amplification matrix of one step for (x, h v, h^2 a) with the balance a_x = -w^2 x.
double spectral_radius(double rho, double h) {
  const double scale = 1e-3;
  Eigen::Matrix3d amplification;
  for (int k = 0; k < 3; ++k) {
    Simulation sim = plucked(rho, h, 0);
    Vec3 start = Vec3::Zero();
    start[k] = scale;
    sim.state.position[1].x() = 1 + start[0];
    sim.state.velocity[1].x() = start[1] / h;
    sim.state.algorithmic_acceleration[1].x() = start[2] / (h * h);
    sim.state.acceleration[1].x() = -k_oscillation * k_oscillation * start[0];
    EXPECT_TRUE(sim.advance(1));
    amplification.col(k) << (sim.state.position[1].x() - 1) / scale, sim.state.velocity[1].x() * h / scale,
        sim.state.algorithmic_acceleration[1].x() * h * h / scale;
  }
  return amplification.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(GeneralizedAlpha, spectral_radius_at_infinity_is_rho) {
  for (double rho : {0., 0.3, 0.5, 0.8, 1.}) {
    // the three roots meet at infinity: they part as the cube root of rounding times scale, or of 1/(h w)^2
    EXPECT_NEAR(spectral_radius(rho, 1e4 / k_oscillation), rho, 5e-3) << "rho " << rho;
  }
}

TEST(GeneralizedAlpha, spectral_radius_never_exceeds_one) {
  for (double rho : {0., 0.5, 0.8, 1.})
    for (double hw : {1e-2, 0.1, 1., 3., 10., 100.})
      EXPECT_LT(spectral_radius(rho, hw / k_oscillation), 1 + 1e-9) << "rho " << rho << ", h w " << hw;
}

Simulation spinning_cabinet(double spin, double h) {
  Model model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.angular_velocity = {spin, 0.3 * spin, 0.5 * spin};
  const BodyStart start = add_cabinet(model, spec);
  Parameters p = weightless();
  p.time_step = h;
  return Simulation(model, {start}, p);
}

TEST(GeneralizedAlpha, step_that_cannot_converge_is_reported_and_leaves_the_state) {
  Simulation sim = spinning_cabinet(1000, 5);
  sim.state.time = 3;
  const std::uint64_t before = hash(sim.state);
  const StepStatus status = sim.advance();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.kind, StepStatus::Kind::newton_diverged);
  EXPECT_EQ(status.body, 0);
  EXPECT_GE(status.node, 0);
  EXPECT_LT(status.node, sim.model.node_total());
  EXPECT_GT(status.time, 3);
  EXPECT_LE(status.time, 8);
  EXPECT_GE(status.rejected, 6);
  EXPECT_EQ(hash(sim.state), before);
  const std::string text = status.message(sim.model);
  EXPECT_NE(text.find("\"cabinet\""), std::string::npos) << text;
  EXPECT_NE(text.find("time_step"), std::string::npos) << text;
}

TEST(GeneralizedAlpha, step_that_converges_only_in_parts_is_halved) {
  int halved = 0;
  for (double spin : {20., 40., 60., 80.})
    for (double h : {0.01, 0.02, 0.04}) {
      Simulation sim = spinning_cabinet(spin, h);
      const StepStatus status = sim.advance();
      if (status.ok() && status.rejected > 0) {
        ++halved;
        EXPECT_NEAR(sim.state.time, h, 1e-15);
        EXPECT_EQ(sim.state.step, 1);
        EXPECT_TRUE(is_finite(sim.state));
      }
    }
  EXPECT_GT(halved, 0);
}

// Nine stiff contacts that close within one step: plain Newton jumps between open and closed for ever.
TEST(GeneralizedAlpha, cabinet_that_falls_flat_on_a_stiff_floor_finds_all_its_steps) {
  for (double friction : {0.3, 0.6, 0.9})
    for (double restitution : {0.2, 0.5}) {
      SCOPED_TRACE(testing::Message() << "friction " << friction << ", restitution " << restitution);
      Model model = steel_model();
      CabinetSpec spec = tall_cabinet();
      spec.tilt = 0.25;
      const BodyStart start = add_cabinet(model, spec);
      model.planes.push_back(ground());
      Parameters p;
      p.contact.alpha = 5000 * k_g;
      p.contact.friction = friction;
      p.contact.restitution = restitution;
      p.time_step = 2e-3;
      Simulation sim(model, {start}, p);
      ASSERT_TRUE(sim.advance(1000));
      EXPECT_LT(centre_of_mass(sim.model, sim.state).z(), 0.3);
    }
}

TEST(GeneralizedAlpha, node_without_mass_and_member_is_singular) {
  Model model = steel_model();
  BodyBuilder builder(model, "loose");
  builder.line("bar", Vec3::Zero(), Vec3::UnitX(), 1, 2, 0, 0, Vec3::UnitZ());
  const int loose = builder.node({0, 0, 5});
  builder.add_material_mass();
  builder.close();
  Parameters p = weightless();
  State state = start_state(model, {BodyStart{}});
  Workspace workspace(model);
  const std::uint64_t before = hash(state);
  const StepStatus status = step(model, p, state, workspace);
  EXPECT_EQ(status.kind, StepStatus::Kind::singular);
  EXPECT_EQ(status.body, 0);
  EXPECT_EQ(status.node, loose);
  EXPECT_EQ(hash(state), before);
}

// The normal damping of a corner that weighs nothing is a step in its speed.
TEST(GeneralizedAlpha, stiff_block_that_lands_on_weightless_corners_finds_every_step) {
  for (const double alpha : {1e5, 1e6}) {
    SCOPED_TRACE(alpha);
    topple::Setup setup = rocking_block(0.1, alpha * k_g, 2.5e-4);
    setup.run.duration = 0.8;
    setup.parameters.resolves_contacts = false;
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    EXPECT_GE(run.outcome().bodies()[0].impacts, 1);
    EXPECT_EQ(run.rejected_steps(), 0);
  }
}

}  // namespace
}  // namespace topple::test
