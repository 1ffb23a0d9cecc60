// A hand that pulls, against theory, on every level and with every integrator.

#include "unit/solver/body_models.h"
#include "unit/solver/two_threads.h"

namespace topple::test {
namespace {

constexpr double k_mass = 4, k_half_length = 0.1;  // kg, m
constexpr double k_force = 8;                      // N
constexpr double k_ramp = 0.05;                    // s

struct PulledAs {
  const char* name;
  BodyModel model;
  Integrator integrator;
  double time_step;
  bool adaptive = false;
};
// The bar's own stretching, at 6000 rad/s, sets the explicit step.
const PulledAs k_ways[] = {{"generalized-alpha", BodyModel::frame, Integrator::generalized_alpha, 1e-3},
                           {"newmark", BodyModel::frame, Integrator::newmark, 1e-3},
                           {"central-difference", BodyModel::frame, Integrator::central_difference, 1e-5},
                           {"rigid", BodyModel::rigid, Integrator::generalized_alpha, 1e-3},
                           {"rigid, adaptive", BodyModel::rigid, Integrator::generalized_alpha, 1e-3, true},
                           {"elastic", BodyModel::elastic, Integrator::generalized_alpha, 1e-3}};

Edit pull(int node, const Vec3& force) {
  return {.key = Edit::Key::pull, .index = node, .value = force};
}

/// A bar of 4 kg along x, with its ends at -0.1 and 0.1 and a third of its mass at each and in the middle,
/// which falls.
topple::Setup free_bar(const PulledAs& way) {
  topple::Setup setup;
  setup.model = sled(k_mass, 0.03, 0);
  setup.model.planes.clear();
  setup.starts.emplace_back();
  compute_as(setup, way.model);
  setup.parameters.integrator = way.integrator;
  setup.parameters.time_step = way.time_step;
  setup.parameters.adaptive = way.adaptive;
  setup.run.settle = false;
  setup.run.duration = 10;
  return setup;
}

int node_at(const topple::Setup& setup, const Vec3& place) {
  for (int node = 0; node < setup.model.node_total(); ++node)
    if ((setup.model.node_position[node] - place).norm() < 1e-9) return node;
  ADD_FAILURE() << "no node at " << place.transpose();
  return 0;
}

void advance_to(topple::Run& run, double time) {
  while (run.time() < time - 1e-9) ASSERT_TRUE(run.advance().ok());
}

/// The velocity of the bar's middle beside that of what only falls.
Vec3 falling(const topple::Run& run) {
  return body_momentum(run.setup().model, run.state(), 0).velocity + run.time() * Vec3(0, 0, k_g);
}

// v = F/m (t - ramp/2), and what let go of it flies on. 1e-5: twenty steps of the ramp at least, the bar's
// own stretching, which has not died away.
TEST(Pull, of_the_middle_moves_a_body_as_its_mass_says) {
  for (const PulledAs& way : k_ways) {
    SCOPED_TRACE(way.name);
    const topple::Setup setup = free_bar(way);
    topple::Run run(setup);
    const int middle = node_at(setup, Vec3::Zero());
    const Vec3 force = k_force * Vec3(0.6, 0.8, 0);
    run.edit(pull(middle, force));
    ASSERT_NO_FATAL_FAILURE(advance_to(run, 0.5));
    const double since = run.time() - k_ramp / 2;
    const Vec3 velocity = falling(run);
    EXPECT_LT((velocity - since / k_mass * force).norm(), 1e-5 * velocity.norm());
    EXPECT_NEAR(run.energy().input, k_mass / 2 * velocity.squaredNorm(), 1e-4 * run.energy().input);
    EXPECT_LT(run.energy().balance_error(), 1e-5);
    run.edit(pull(middle, Vec3::Zero()));
    const double let_go = run.time();
    ASSERT_NO_FATAL_FAILURE(advance_to(run, 0.8));
    const Vec3 last = let_go / k_mass * force;
    EXPECT_LT((falling(run) - last).norm(), 1e-5 * last.norm());
    const double input = run.energy().input;
    ASSERT_NO_FATAL_FAILURE(advance_to(run, 0.9));
    EXPECT_EQ(run.energy().input, input);
  }
}

// I theta'' = F L cos theta of a force that keeps its direction, by a fine Runge-Kutta integration; the
// middle gains F t/m. 1e-4 rad of 1.4: second order in steps of 1 ms at 6 rad/s, and the bar's
// bending.
TEST(Pull, of_an_end_turns_a_body_and_its_work_is_the_energy) {
  const double inertia = free_bar(k_ways[0]).model.bodies[0].inertia(2, 2);
  const auto acceleration = [&](double t, double angle) {
    const double grip = t < k_ramp ? (1 - std::cos(k_pi * t / k_ramp)) / 2 : 1;
    return grip * k_force * k_half_length * std::cos(angle) / inertia;
  };
  const auto angle_at = [&](double time) {
    const int steps = 40000;
    const double h = time / steps;
    double angle = 0, rate = 0;
    for (int i = 0; i < steps; ++i) {
      const double t = h * i, half = angle + h / 2 * rate;
      const double a = acceleration(t, angle), b = acceleration(t + h / 2, half),
                   c = acceleration(t + h / 2, half + h * h / 4 * a),
                   d = acceleration(t + h, angle + h * rate + h * h / 2 * b);
      angle += h * rate + h * h / 6 * (a + b + c);
      rate += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return angle;
  };
  EXPECT_GT(angle_at(0.4), 1);
  for (const PulledAs& way : k_ways) {
    SCOPED_TRACE(way.name);
    const topple::Setup setup = free_bar(way);
    topple::Run run(setup);
    run.edit(pull(node_at(setup, Vec3(k_half_length, 0, 0)), Vec3(0, k_force, 0)));
    ASSERT_NO_FATAL_FAILURE(advance_to(run, 0.4));
    const Quat turned = body_pose(setup.model, run.state(), 0).rotation;
    const Vec3 along = turned * Vec3::UnitX();
    EXPECT_NEAR(std::atan2(along.y(), along.x()), angle_at(run.time()), 1e-4);
    EXPECT_LT(run.energy().balance_error(), 2e-4);
  }
}

// A body tips when F h is above W b, b from its centre to its edge. A twentieth of that on both sides, more
// than contacts give and than a force swings that grows in ten parts.
TEST(Pull, tips_a_cabinet_at_the_force_of_statics) {
  using enum BodyModel;
  for (const BodyModel model : {planar, rigid, elastic, frame})
    for (const double factor : {0.95, 1.05}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(model) << ", factor " << factor);
      topple::Setup setup;
      setup.model = steel_model();
      CabinetSpec spec = tall_cabinet();
      spec.base = CabinetSpec::Base::corners;
      setup.starts.push_back(add_cabinet(setup.model, spec));
      setup.model.planes.push_back(ground());
      setup.run.duration = 6;
      setup.parameters.contact.alpha = 1e5 * k_g;
      setup.parameters.want_stress = model == elastic || model == frame;
      compute_as(setup, model);
      const Body& body = setup.model.bodies[0];
      int top = 0;
      double edge = 0;
      for (int node = 0; node < setup.model.node_total(); ++node)
        if (setup.model.node_position[node].z() > setup.model.node_position[top].z() + 1e-9) top = node;
      for (const ContactPoint& point : setup.model.contact_points)
        edge = std::max(edge, setup.model.node_position[point.node].x() - body.centre_of_gravity.x());
      const double height = setup.model.node_position[top].z() - spec.at.z();
      topple::Run run(setup);
      EXPECT_EQ(run.state().bodies[0].level == ModelLevel::planar, model == planar);
      for (int part = 1; part <= 10; ++part) {
        run.edit(pull(top, Vec3(part / 10. * factor * k_g * body.mass * edge / height, 0, 0)));
        ASSERT_NO_FATAL_FAILURE(advance_to(run, 0.1 * part));
      }
      while (!run.over() && !run.outcome().bodies()[0].beyond_since) ASSERT_TRUE(run.advance().ok());
      EXPECT_EQ(run.outcome().bodies()[0].beyond_since.has_value(), factor > 1);
      EXPECT_LT(run.energy().balance_error(), 1e-3);
    }
}

// Amid the ramp of a second pull.
TEST(Pull, a_checkpoint_continues_to_the_bit) {
  for (const BodyModel model : {BodyModel::frame, BodyModel::elastic, BodyModel::rigid}) {
    SCOPED_TRACE(static_cast<int>(model));
    const topple::Setup setup = paper_cabinet(model);
    topple::Run run(setup);
    const int top = setup.model.node_total() - 1;
    run.edit(pull(top, Vec3(20, 5, 10)));
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(run.advance().ok());
    run.edit(pull(0, Vec3(0, 30, 0)));
    run.edit(pull(top, Vec3(0, 10, 20)));
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(run.advance().ok());
    topple::Run other(setup, unpack(setup.model, pack(run.state())), run.parameters());
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(run.advance().ok());
      ASSERT_TRUE(other.advance().ok());
      ASSERT_EQ(hash(run.state()), hash(other.state())) << i;
    }
  }
}

// One is pulled over against the other, which stands 20 mm beside it; what they lose is booked.
TEST(Pull, of_a_body_beside_another_keeps_the_balance_and_every_bit_on_two_threads) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic, BodyModel::frame}) {
    SCOPED_TRACE(static_cast<int>(model));
    const auto hash_with = [&](int workers) {
      topple::Setup setup = shaken(1.2);
      CabinetSpec spec = tall_cabinet();
      spec.name = "other";
      spec.at = Vec3(spec.size.x() + 0.05, 0, 0);
      setup.starts.push_back(add_cabinet(setup.model, spec));
      setup.parameters.contact.restitution = 0.3;
      compute_as(setup, model);
      topple::Run run(setup);
      share(run, workers);
      const double weight = k_g * setup.model.bodies[0].mass;
      run.edit(pull(setup.model.bodies[0].node_count - 1, Vec3(0.4 * weight, 0, 0)));
      while (!run.over()) EXPECT_TRUE(run.advance().ok());
      EXPECT_GT(run.energy().input, 1);
      EXPECT_GT((run.state().bodies[1].position - setup.model.bodies[1].centre_of_gravity).norm(), 0.01);
      EXPECT_LT(run.energy().balance_error(), 1e-3);
      return hash(run.state());
    };
    EXPECT_EQ(hash_with(1), hash_with(2));
  }
}

TEST(Pull, changes_without_a_jump_and_is_gone_when_it_was_let_go_of) {
  Parameters p;
  apply(pull(7, Vec3::Zero()), {}, 0.1, p);
  EXPECT_TRUE(p.pulls.empty());  // nothing was held
  apply(pull(7, Vec3(10, 0, 0)), {}, 0.1, p);
  EXPECT_EQ(pull_force(p.pulls[0], 0.1), Vec3::Zero());
  EXPECT_EQ(pull_force(p.pulls[0], 0.2), Vec3(10, 0, 0));
  const Vec3 here = pull_force(p.pulls[0], 0.12);
  apply(pull(7, Vec3(0, 0, 5)), {}, 0.12, p);
  EXPECT_EQ(pull_force(p.pulls[0], 0.12), here);
  apply(pull(3, Vec3(1, 0, 0)), {}, 0.12, p);
  ASSERT_EQ(p.pulls.size(), 2u);
  EXPECT_EQ(p.pulls[0].node, 3);
  apply(pull(7, Vec3::Zero()), {}, 0.3, p);
  EXPECT_EQ(pull_force(p.pulls[1], 0.3), Vec3(0, 0, 5));
  EXPECT_EQ(pull_force(p.pulls[1], 0.3 + k_ramp), Vec3::Zero());
  EXPECT_EQ(edited_value(p, Edit::Key::pull, 7), Vec3::Zero());
  EXPECT_EQ(edited_value(p, Edit::Key::pull, 3), Vec3(1, 0, 0));
  apply(pull(3, Vec3::Zero()), {}, 1, p);
  EXPECT_EQ(p.pulls.size(), 1u);
}

}  // namespace
}  // namespace topple::test
