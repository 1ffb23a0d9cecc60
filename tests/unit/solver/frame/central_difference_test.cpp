#include "solver/frame/central_difference.h"
#include "solver/contact/contact_law.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "solver/element/beam.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

// 2 over the highest frequency of M^-1 K in the reference pose, by a dense symmetric eigenvalue solve.
// `law`: with the springs that contact_force has at 1 - l/L = 1, at rest, where contact points lie on planes.
double dense_limit(const Model& model, int index, const ContactLaw* law = nullptr) {
  const Body& body = model.bodies[index];
  const int n = body.node_count;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(6 * n, 6 * n), root = k;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    const Mat12 tangent = beam_stiffness(model, element);
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b)
        k.block<6, 6>(6 * (element.node[a] - body.first_node), 6 * (element.node[b] - body.first_node)) +=
            tangent.block<6, 6>(6 * a, 6 * b);
  }
  for (int c = body.first_contact_point; law && c < body.first_contact_point + body.contact_point_count; ++c)
    for (const Plane& plane : model.planes) {
      const ContactPoint& point = model.contact_points[c];
      Mat3 by_position, by_velocity;
      contact_force(*law, {plane.normal, 1, contact_length(point, plane), Vec3::Zero(), Vec3::Zero(), 1},
                    by_position, by_velocity);
      const int i = 6 * (point.node - body.first_node);
      k.block<3, 3>(i, i) -= by_position;
    }
  for (int i = 0; i < n; ++i) {
    const int g = body.first_node + i;
    root.block<3, 3>(6 * i, 6 * i) = Mat3::Identity() / std::sqrt(model.node_mass[g]);
    root.block<3, 3>(6 * i + 3, 6 * i + 3) =
        Eigen::SelfAdjointEigenSolver<Mat3>(model.node_inertia[g]).operatorInverseSqrt();
  }
  for (const Support& support : model.supports)
    for (int direction = 0; direction < 6; ++direction)
      if (support.fixed >> direction & 1) {
        root.row(6 * (support.node - body.first_node) + direction).setZero();
        root.col(6 * (support.node - body.first_node) + direction).setZero();
      }
  const Eigen::MatrixXd a = root * k * root;
  return 2 / std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>((a + a.transpose()) / 2)
                           .eigenvalues()
                           .maxCoeff());
}

Model cabinet_model(int shelves = 0, int divisions = 1) {
  Model model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.shelves = shelves;
  spec.divisions = divisions;
  add_cabinet(model, spec);
  return model;
}

TEST(CentralDifference, limit_is_2_over_the_highest_frequency) {
  std::vector<Model> models = {cabinet_model(), cabinet_model(2), cabinet_model(0, 2)};
  models.push_back(
      cantilever(plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6), steel(), 1, 3, Vec3::Zero(), Vec3::Zero()));
  for (const Model& model : models) {
    BodySystem system(model, 0);
    const double exact = dense_limit(model, 0), found = explicit_limit(system);
    SCOPED_TRACE(testing::Message() << model.node_total() << " nodes");
    // power iteration comes from below in frequency: a step just under the limit must not be unstable by
    // more than a growth of 1e-3 h w per step
    EXPECT_GE(found, exact * (1 - 1e-9));
    EXPECT_LE(found, exact * (1 + 1e-3));
  }
}

TEST(CentralDifference, limit_counts_the_springs_that_a_law_has_and_no_others) {
  Model model = cabinet_model();
  model.planes.push_back({"floor", Vec3::Zero(), Vec3::UnitZ(), 0});
  BodySystem system(model, 0);
  for (const ContactLawTraits& traits : contact_laws()) {
    if (!traits.stores_energy) continue;  // no spring at rest: explicit_limit has that of a body that moves
    for (const double q : {1., 2.}) {
      SCOPED_TRACE(testing::Message() << "law " << traits.word << ", q " << q);
      ContactLaw law{.kind = traits.kind, .alpha = 1e9, .q = q};  // stiffer than the beams
      const double exact = dense_limit(model, 0, &law), found = explicit_limit(system, &law);
      EXPECT_LT(exact, 0.9 * dense_limit(model, 0));
      EXPECT_GE(found, exact * (1 - 1e-9));  // as in the test above
      EXPECT_LE(found, exact * (1 + 1e-3));
    }
  }
}

TEST(CentralDifference, is_stable_just_below_the_limit_and_not_above) {
  const Model model = cabinet_model();
  const double limit = dense_limit(model, 0);
  for (double share : {0.98, 1.01}) {
    SCOPED_TRACE(share);
    Parameters p = weightless();
    p.integrator = Integrator::central_difference;
    p.time_step = share * limit;
    BodyStart start;
    start.angular_velocity = {1, 3, 0.5};
    Simulation sim(model, {start}, p);
    BodySystem system(model, 0);
    IntegratorScratch scratch;
    StepEnergy energy;
    const double before = kinetic_energy(model, sim.state);
    for (int i = 0; i < 3000; ++i) {
      // by itself: `step` refuses the second
      const StepInputs from(p, i * p.time_step), to(p, from.time + p.time_step);
      const StepStatus status =
          advance_central_difference(system, {p, from, to, p.time_step, 0}, sim.state, scratch, energy);
      if (!status.ok() || kinetic_energy(model, sim.state) > 10 * before) break;
    }
    const double after = kinetic_energy(model, sim.state);
    if (share < 1) {
      EXPECT_NEAR(after, before, 1e-3 * before);
    } else {
      EXPECT_FALSE(after < 2 * before);
    }
  }
}

TEST(CentralDifference, step_over_the_limit_is_refused_and_leaves_the_state) {
  Model model = cabinet_model();
  CabinetSpec small = tall_cabinet();  // stiffer for its mass: sets the limit
  small.name = "small";
  small.size = {0.2, 0.3, 0.5};
  small.cg_height = 0.25;
  small.mass = 5;
  small.at.x() = 3;
  add_cabinet(model, small);
  const double limit = std::min(dense_limit(model, 0), dense_limit(model, 1));
  ASSERT_LT(dense_limit(model, 1), dense_limit(model, 0));
  Parameters p = weightless();
  p.integrator = Integrator::central_difference;
  p.time_step = 1.01 * limit;
  Simulation sim(model, {BodyStart{}, BodyStart{}}, p);
  const std::uint64_t before = hash(sim.state);
  const StepStatus status = sim.advance();
  EXPECT_EQ(status.kind, StepStatus::Kind::step_too_long);
  EXPECT_EQ(status.body, 1);
  EXPECT_NEAR(status.limit, limit, 1e-3 * limit);
  EXPECT_EQ(hash(sim.state), before);
  const std::string text = status.message(model);
  EXPECT_NE(text.find("\"small\""), std::string::npos) << text;
  sim.parameters.time_step = 0.99 * limit;
  EXPECT_TRUE(sim.advance().ok());
}

TEST(CentralDifference, follows_a_linear_oscillator_with_second_order) {
  double error[3];
  for (int k = 0; k < 3; ++k) {
    Parameters p = weightless();
    p.integrator = Integrator::central_difference;
    p.time_step = 2e-3 / (1 << k);
    Simulation sim(oscillator(), {BodyStart{}}, p);
    sim.state.position[1].x() += 0.01;
    prepare(sim.model, p, sim.state, sim.workspace());
    ASSERT_TRUE(sim.advance(100 << k));
    error[k] =
        std::max(std::abs(sim.state.position[1].x() - 1 - 0.01 * std::cos(k_oscillation * 0.2)),
                 std::abs(sim.state.velocity[1].x() / k_oscillation + 0.01 * std::sin(k_oscillation * 0.2)));
    // leap-frog keeps the energy to (h w)^2/4 of it, without drift
    const double share = sim.state.energy.balance_error();
    EXPECT_LT(share, 0.26 * std::pow(p.time_step * k_oscillation, 2));
  }
  EXPECT_NEAR(error[0] / error[1], 4, 0.2);
  EXPECT_NEAR(error[1] / error[2], 4, 0.1);
}

// By the eigenvalues of what a step makes of position, velocity and mean acceleration of an oscillator.
double damped_radius(double wh) {
  const double w2 = wh * wh, ahead = 0.1, newest = 0.5;
  Mat3 step;  // of x, h v and h^2 a'
  step.row(2) << -newest * w2, 0, 1 - newest;
  step.row(0) << 1 - (0.5 + ahead) * w2, 1, 0;
  step.row(0) -= ahead * step.row(2);
  step.row(1) << -0.5 * w2, 1, 0;
  step.row(1) -= 0.5 * w2 * step.row(0);
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(CentralDifference, damped_takes_what_is_fast_for_the_step_and_books_it) {
  const Model model = oscillator();
  for (const double wh : {0.2, 0.4, 1.2, 1.8}) {
    SCOPED_TRACE(wh);
    Parameters p = weightless();
    p.time_step = wh / k_oscillation;
    Simulation sim(model, {BodyStart{}}, p);
    sim.state.position[1].x() += 1e-4;
    prepare(model, p, sim.state, sim.workspace());
    BodySystem system(model, 0);
    IntegratorScratch scratch;
    StepEnergy energy;
    // 1 for a vibration of this period and amplitude
    const auto held = [&] {
      const double x = sim.state.position[1].x() - 1, v = sim.state.velocity[1].x() / k_oscillation;
      return (x * x * (1 - wh * wh / 4) + v * v) / 1e-8;
    };
    const double radius = damped_radius(wh);
    const int steps = static_cast<int>(std::min(200., 2 / (1 - radius)));
    double start = 0;
    for (int i = 0; i < 2 * steps; ++i) {
      if (i == steps) {
        start = held();
        energy = {};
      }
      const StepInputs from(p, i * p.time_step), to(p, from.time + p.time_step);
      ASSERT_TRUE(
          advance_damped_central_difference(system, {p, from, to, p.time_step, 0}, sim.state, scratch, energy)
              .ok());
    }
    const double taken = 1 - held() / start;
    // what is held swings within a period, as the damping goes with the velocity
    EXPECT_NEAR(std::log(1 - taken), 2 * steps * std::log(radius), 0.1 * 2 * steps * (1 - radius));
    const double unit = 0.5 * model.node_mass[1] * k_oscillation * k_oscillation * 1e-8;
    EXPECT_NEAR(energy.numerical, taken * start * unit, 1e-3 * start * unit);
  }
  EXPECT_NEAR((1 - damped_radius(0.05)) / 0.05, 0.1 * std::pow(0.05, 3), 0.01 * 0.1 * std::pow(0.05, 3));
  EXPECT_LT(damped_radius(1.86), 1);
  EXPECT_GT(damped_radius(1.89), 1);
}

TEST(CentralDifference, a_post_that_is_rubbed_where_it_stands_keeps_the_balance) {
  topple::Setup setup;
  setup.model = steel_model();
  setup.model.planes.push_back(ground());
  FrameSpec post;
  post.name = "post";
  post.nodes = {{0, 0, 0.014}, {0, 0, 0.4}};
  post.members = {{{0, 1}, 0, 0}};
  post.supports.push_back({1, k_clamped});
  setup.starts = add_frame(setup.model, post);
  FrameSpec bar;
  bar.name = "bar";
  bar.nodes = {{0.031, -0.3, 0.06}, {0.031, 0.3, 0.06}};
  bar.members = {{{0, 1}, 0, 0}};
  bar.masses = {{0, 5, Vec3::Zero()}, {1, 5, Vec3::Zero()}};
  bar.velocity = Vec3(-2, 0, -2);
  setup.starts.push_back(add_frame(setup.model, bar)[0]);
  setup.run.settle = false;
  setup.parameters.integrator = Integrator::central_difference;
  setup.parameters.models = {BodyModel::frame, BodyModel::frame};
  setup.parameters.contact.alpha = 1e5;
  setup.parameters.time_step = 1e-6;
  Simulation sim(setup.model, setup.starts, setup.parameters, false);
  ASSERT_TRUE(sim.advance(8000));
  EXPECT_GT(sim.state.energy.friction, 10);  // J
  // a quarter of it is left with half the step
  EXPECT_LT(sim.state.energy.balance_error(), 4e-7);
}

TEST(CentralDifference, keeps_supports) {
  Model model =
      cantilever(plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6), steel(), 1, 2, {10, 300, 100}, {5, 4, 3});
  Parameters p;
  p.integrator = Integrator::central_difference;
  p.time_step = dense_limit(model, 0) / 2;
  Simulation sim(model, {BodyStart{}}, p);
  ASSERT_TRUE(sim.advance(500));
  EXPECT_EQ(sim.state.position[0], model.node_position[0]);
  EXPECT_EQ(sim.state.rotation[0].coeffs(), Quat::Identity().coeffs());
  EXPECT_GT((sim.state.position[2] - model.node_position[2]).norm(), 1e-5);
}

TEST(CentralDifference, nan_is_reported) {
  Parameters p;
  p.integrator = Integrator::central_difference;
  p.time_step = 1e-5;
  Simulation sim(cabinet_model(), {BodyStart{}}, p);
  sim.state.velocity[3].y() = std::nan("");
  const std::uint64_t before = hash(sim.state);
  const StepStatus status = sim.advance();
  EXPECT_EQ(status.kind, StepStatus::Kind::not_finite);
  EXPECT_EQ(status.body, 0);
  EXPECT_EQ(hash(sim.state), before);
}

}  // namespace
}  // namespace topple::test
