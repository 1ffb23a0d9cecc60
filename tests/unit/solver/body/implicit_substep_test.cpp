// Rigid bodies on stiff contacts: long steps against the same contacts followed in every detail.
#include "solver/body/body_pose.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

// Contacts on which the block bounces with 700 Hz.
Setup stiff_block(double tilt, double h, BodyModel model = BodyModel::rigid) {
  Setup setup = rocking_block(tilt, 1e6, h);
  setup.parameters.models = {model};
  return setup;
}

struct Course {
  double tilt = 0;  // deg, at the end
  double balance = 0, numerical = 0;
  int steps = 0;
};

Course course(const Setup& setup, double duration) {
  Simulation sim{setup.model, setup.starts, setup.parameters, setup.run.settle};
  Course out;
  for (; sim.state.time < duration - 1e-9; ++out.steps)
    if (!topple::step(setup.model, setup.parameters, sim.state, sim.workspace(), duration).ok())
      return {std::nan(""), 1, 1, 0};
  out.tilt = tilt(body_pose(sim.model, sim.state, 0)) * k_degrees;
  out.balance = sim.state.energy.balance_error();
  out.numerical = sim.state.energy.numerical / sim.state.energy.largest;
  return out;
}

// The error of a substep is 1e-4 of the speed at a tolerance of 1e-3; some fifty substeps see the impacts,
// which are the worst. Bounds are twice what was found.
TEST(ImplicitSubstep, comes_to_the_motion_that_small_explicit_substeps_follow) {
  constexpr double k_duration = 1.5, k_tilt = 0.05;
  const double exact = course(stiff_block(k_tilt, 1e-5), k_duration).tilt;
  const auto look = [&](const topple::Setup& setup, double error, double balance, int most_steps) {
    const Course c = course(setup, k_duration);
    EXPECT_NEAR(c.tilt, exact, error);
    EXPECT_LT(c.balance, balance);
    EXPECT_LT(std::abs(c.numerical), balance);
    EXPECT_LE(c.steps, most_steps);
  };
  topple::Setup adaptive = stiff_block(k_tilt, 1e-4);
  adaptive.parameters.adaptive = true;
  adaptive.parameters.tolerance = 1e-2;
  look(adaptive, 1.4e-2, 1.5e-3, 300);
  adaptive.parameters.tolerance = 1e-3;
  look(adaptive, 1.4e-3, 9e-4, 530);
  adaptive.parameters.tolerance = 1e-4;
  look(adaptive, 1.8e-4, 1.7e-4, 1290);
  look(stiff_block(k_tilt, 1e-3), 1.3e-3, 8e-4, 1500);
  look(stiff_block(k_tilt, 4e-3), 3.3e-3, 7e-4, 375);
}

// A bounce is followed whatever the step. The smoothing of the law, 1 mm/s, is a thousandth of the speed.
TEST(ImplicitSubstep, bounces_with_the_restitution_asked_for) {
  const auto rebound = [](double e, double h) {
    topple::Setup setup = stiff_block(0, h);
    setup.run.settle = false;
    setup.starts[0].velocity = Vec3(0, 0, -1);
    for (Vec3& x : setup.model.node_position) x.z() += 0.01;
    setup.parameters.contact.restitution = e;
    setup.parameters.gravity.setZero();
    Simulation sim{setup.model, setup.starts, setup.parameters, false};
    EXPECT_TRUE(sim.advance(static_cast<int>(std::lround(0.1 / h))));
    return sim.state.bodies[0].velocity.z();
  };
  EXPECT_NEAR(rebound(1, 4e-3), 1, 1e-3);
  EXPECT_NEAR(rebound(0.5, 4e-3), 0.5, 1e-3);
  // with none, the smoothing decides what is left
  EXPECT_NEAR(rebound(0, 4e-3), rebound(0, 1e-5), 1e-3);
}

// Sliding ends where springs hold; a step is judged by the change of its forces, so that those of its start
// must be of the springs as they are. Coulomb: the way is v^2/(2 mu g), less what the smoothing of the bounce
// and the spring's last travel are, some 0.1 %.
TEST(ImplicitSubstep, slides_to_rest_at_any_tolerance_with_the_forces_of_its_state) {
  for (const double tolerance : {1e-3, 1e-5, 1e-6}) {
    SCOPED_TRACE(tolerance);
    topple::Setup setup = stiff_block(0, 1e-3);
    setup.parameters.contact.friction = 0.1;  // it slides before it tips
    setup.parameters.adaptive = true;
    setup.parameters.tolerance = tolerance;
    Simulation sim{setup.model, setup.starts, setup.parameters, true};
    sim.state.bodies[0].velocity = Vec3(0.3, 0, 0);
    prepare(setup.model, setup.parameters, sim.state, sim.workspace());
    const double from = sim.state.bodies[0].position.x();
    while (sim.state.time < 0.5) {
      const StepStatus status = topple::step(setup.model, setup.parameters, sim.state, sim.workspace(), 0.5);
      ASSERT_TRUE(status.ok()) << status.message(setup.model);
      State again = sim.state;
      Workspace fresh(setup.model);
      prepare(setup.model, setup.parameters, again, fresh);
      const BodyState &found = sim.state.bodies[0], &of_state = again.bodies[0];
      const double weight = setup.model.bodies[0].mass * k_standard_gravity;
      ASSERT_NEAR((found.force - of_state.force).norm(), 0, 1e-9 * weight) << sim.state.time;
      ASSERT_NEAR((found.moment - of_state.moment).norm(), 0, 1e-9 * weight) << sim.state.time;
    }
    const double way = 0.3 * 0.3 / (2 * setup.parameters.contact.friction * k_standard_gravity);
    EXPECT_NEAR(sim.state.bodies[0].position.x() - from, way, 1e-2 * way);
    EXPECT_LT(sim.state.bodies[0].velocity.norm(), 1e-4);
  }
}

// th'' = -p^2 sin(a - th) as long as th hardly changes, p^2 = 3g/4R. Contacts give way by a fifth of a
// micron.
TEST(ImplicitSubstep, lets_go_from_rest_at_any_tolerance) {
  constexpr double k_tilt = 0.05, k_time = 0.05;
  const double radius = std::hypot(0.19, 0.895), critical = std::atan2(0.19, 0.895),
               fall = 3 * k_g / (4 * radius) * std::sin(critical - k_tilt) * k_time * k_time / 2;
  for (const BodyModel model : {BodyModel::rigid, BodyModel::frame})
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
      topple::Setup setup = stiff_block(k_tilt, 1e-4, model);
      setup.parameters.adaptive = true;
      setup.parameters.tolerance = tolerance;
      EXPECT_NEAR(course(setup, k_time).tilt, (k_tilt - fall) * k_degrees, 3e-4);
    }
}

}  // namespace
}  // namespace topple::test
