#include <gtest/gtest.h>

#include <Eigen/LU>

#include "solver/frame/generalized_alpha.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

struct Rule {
  double beta, gamma;
};
constexpr Rule k_average{0.25, 0.5}, k_damped{4. / 9, 5. / 6};

Parameters newmark(const Rule& rule, double h) {
  Parameters p = weightless();
  p.integrator = Integrator::newmark;
  p.beta = rule.beta;
  p.gamma = rule.gamma;
  p.time_step = h;
  return p;
}

Simulation plucked(const Rule& rule, double h) {
  const Model model = oscillator();
  const Parameters p = newmark(rule, h);
  Simulation sim(model, {BodyStart{}}, p);
  sim.state.position[1].x() += 0.01;
  prepare(model, p, sim.state, sim.workspace());
  return sim;
}

double oscillator_error(const Rule& rule, double h) {
  Simulation sim = plucked(rule, h);
  const double t = 0.2;
  sim.advance(static_cast<int>(std::lround(t / h)));
  return std::max(std::abs(sim.state.position[1].x() - 1 - 0.01 * std::cos(k_oscillation * t)),
                  std::abs(sim.state.velocity[1].x() / k_oscillation + 0.01 * std::sin(k_oscillation * t)));
}

TEST(Newmark, average_acceleration_is_of_second_order_and_the_damped_rule_of_first) {
  const auto order = [](const Rule& rule) {
    return std::log2(oscillator_error(rule, 5e-4) / oscillator_error(rule, 2.5e-4));
  };
  EXPECT_NEAR(order(k_average), 2, 0.1);
  EXPECT_NEAR(order(k_damped), 1, 0.1);
}

// Linear acceleration, beta = 1/6: omega h = 2 sqrt(3), where central differences have 2.
TEST(Newmark, is_refused_where_linear_theory_says_that_it_grows) {
  constexpr Rule k_linear{1. / 6, 0.5};
  Parameters central = newmark(k_linear, 1e-9);
  central.integrator = Integrator::central_difference;
  Simulation probe(oscillator(), {BodyStart{}}, central);
  ASSERT_TRUE(probe.advance(1));
  const double limit = std::sqrt(3.) * *explicit_limit(probe.workspace());
  Simulation stable = plucked(k_linear, 0.99 * limit);
  ASSERT_TRUE(stable.advance(1000));
  EXPECT_LT(std::abs(stable.state.position[1].x() - 1), 0.02);  // it was pulled by 0.01
  Simulation grows = plucked(k_linear, 1.01 * limit);
  const StepStatus status = grows.advance();
  EXPECT_EQ(status.kind, StepStatus::Kind::step_too_long);
  EXPECT_NEAR(status.limit, limit, 1e-9 * limit);
}

// Two masses on a spring that tumble and swing: rotations take part.
Quat tumbled(const Rule& rule, double h) {
  Model model = oscillator();
  model.supports.clear();
  model.node_inertia[1] = Vec3(1, 2, 1.5).asDiagonal();
  BodyStart start;
  start.angular_velocity = {1, 2, 0.5};
  Simulation sim(model, {start}, newmark(rule, h));
  sim.advance(static_cast<int>(std::lround(0.4 / h)));
  return sim.state.rotation[1];
}

TEST(Newmark, orders_hold_for_a_tumbling_body) {
  const auto order = [](const Rule& rule) {
    const Quat a = tumbled(rule, 1e-3), b = tumbled(rule, 5e-4), c = tumbled(rule, 2.5e-4);
    const auto apart = [](const Quat& p, const Quat& q) { return (p.conjugate() * q).vec().norm(); };
    return std::log2(apart(a, b) / apart(b, c));
  };
  EXPECT_NEAR(order(k_average), 2, 0.1);
  EXPECT_NEAR(order(k_damped), 1, 0.1);
}

TEST(Newmark, average_acceleration_keeps_the_energy_of_a_linear_oscillator) {
  for (double h : {1e-3, 0.02, 0.5}) {
    Simulation sim = plucked(k_average, h);
    const double before = sim.state.energy.strain;
    ASSERT_TRUE(sim.advance(1000));
    // 1000 steps of rounding; positions near 1 m hold 1e-16 of it against 0.01 m
    EXPECT_NEAR(sim.state.energy.strain + sim.state.energy.kinetic, before, 1e-9 * before) << "step " << h;
    EXPECT_NEAR(sim.state.energy.numerical, 0, 1e-9 * before);
  }
}

TEST(Newmark, books_as_numerical_what_a_linear_oscillator_loses) {
  for (double h : {2e-3, 0.02, 0.1}) {
    Simulation sim = plucked(k_damped, h);
    const double before = sim.state.energy.strain;
    ASSERT_TRUE(sim.advance(50));
    const double lost = before - sim.state.energy.strain - sim.state.energy.kinetic;
    EXPECT_GT(lost, 1e-3 * before);
    EXPECT_NEAR(sim.state.energy.numerical, lost, 1e-9 * before);
  }
}

TEST(Newmark, damped_rule_slows_a_rigid_rotation_and_the_ledger_says_so) {
  Model model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.angular_velocity = {0, 3, 0};
  const BodyStart start = add_cabinet(model, spec);
  Simulation sim(model, {start}, newmark(k_damped, 4e-3));
  const double before = kinetic_energy(sim.model, sim.state);
  ASSERT_TRUE(sim.advance(500));
  const double lost = before - kinetic_energy(sim.model, sim.state) - sim.state.energy.strain;
  EXPECT_GT(lost, 0.01 * before);
  EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
}

// A mass of 10 kg swings at 7.72 m/s round the end of a stiff bar without mass of its own.
struct Swing {
  Vec3 x{3.0443, 0, 0}, v{0, 7.72, 0}, a = Vec3::Zero();
  double strain = 0;
  double energy() const { return 5 * v.squaredNorm() + strain; }
};
constexpr double k_swing_stiffness = 1e10;  // N, of the bar's section

// One step of average acceleration for a point mass on a spring, Newton from the circle.
void step_alone(Swing& s, double h) {
  constexpr double L = 3.0443, m = 10;
  Vec3 x = (s.x + h * s.v).normalized() * L, a;
  for (int iteration = 0; iteration < 20; ++iteration) {
    a = 4 / (h * h) * (x - s.x - h * s.v) - s.a;
    const double l = x.norm(), tension = k_swing_stiffness * (l / L - 1);
    const Vec3 n = x / l;
    const Mat3 tangent = (4 * m / (h * h) + tension / l) * Mat3::Identity() +
                         (k_swing_stiffness / L - tension / l) * n * n.transpose();
    x -= tangent.inverse() * (m * a + tension * n);
  }
  a = 4 / (h * h) * (x - s.x - h * s.v) - s.a;
  s.v += h / 2 * (s.a + a);
  s.x = x;
  s.a = a;
  s.strain = k_swing_stiffness / (2 * L) * (x.norm() - L) * (x.norm() - L);
}

Simulation swinging(double h) {
  Model model;
  Material material = steel();
  material.young = 1e13;
  material.density = 1e-3;
  model.materials.push_back(material);
  model.sections.push_back(plain_section(1e-3, 1e-3, 1e-3, 1e-3, 1, 1));
  FrameSpec spec;
  spec.name = "pendulum";
  spec.nodes = {{0, 0, 0}, {3.0443, 0, 0}};
  spec.members.push_back({{0, 1}, 0, 0});
  spec.supports.push_back({0, 0x7});
  spec.masses = {{1, 10.}};
  spec.velocity = {0, 7.72, 0};
  spec.angular_velocity = {0, 0, 7.72 / 3.0443};
  const std::vector<BodyStart> starts = add_frame(model, spec);
  return Simulation(model, starts, newmark(k_average, h));
}

TEST(Newmark, stiff_pendulum_moves_as_a_point_mass_stable_or_not) {
  for (double h : {0.01, 0.005}) {
    Simulation sim = swinging(h);
    Swing alone;
    const double before = alone.energy();
    for (int i = 0; i < std::lround(6.5 / h); ++i) {
      step_alone(alone, h);
      const StepStatus status = sim.advance();
      ASSERT_TRUE(status.ok()) << status.message(sim.model);
      EXPECT_EQ(status.rejected, 0) << sim.state.time;
    }
    // the bar weighs 3e-7 of the mass; at 10 ms its share has grown as the motion has
    EXPECT_NEAR(sim.state.energy.kinetic + sim.state.energy.strain, alone.energy(), 1e-5 * before);
    EXPECT_NEAR(alone.energy() / before, h > 0.007 ? 2.0726 : 0.9999, 1e-4);
    EXPECT_EQ(sim.state.position[0], Vec3(Vec3::Zero()));
    EXPECT_EQ(sim.state.velocity[0], Vec3(Vec3::Zero()));
  }
}

}  // namespace
}  // namespace topple::test
