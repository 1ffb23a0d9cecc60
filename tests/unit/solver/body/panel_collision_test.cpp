// Bodies whose corners meet panels while they move.
#include <Eigen/LU>
#include <cmath>

#include "solver/contact/panel_place.h"
#include "unit/solver/body_models.h"

namespace topple::test {
namespace {

constexpr double k_speed = 2;  // m/s

/// A box flies, one corner first, at the closed side of a cabinet towards -x, away from its members.
Setup corner_first(BodyModel of_cabinet, BodyModel of_box) {
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec cabinet = tall_cabinet();
  setup.starts.push_back(add_cabinet(setup.model, cabinet));
  CabinetSpec box;
  box.name = "box";
  box.size = Vec3::Constant(0.2);
  box.cg_height = 0.1;
  box.mass = 5;
  box.at = Vec3(-0.43, 0.2, 0.6);
  setup.starts.push_back(add_cabinet(setup.model, box));
  BodyStart& start = setup.starts[1];
  const Eigen::AngleAxisd turn(Quat::FromTwoVectors(Vec3(1, 0.8, 0.9), Vec3::UnitX()));
  start.pivot = setup.model.bodies[1].centre_of_gravity;
  start.rotation = turn.angle() * turn.axis();
  start.velocity = Vec3(k_speed, 0, 0);
  setup.parameters = weightless();
  setup.parameters.contact.alpha = 1000 * k_g;
  setup.parameters.contact.friction = 0;
  setup.parameters.contact.normal_speed = 1e-4;
  setup.parameters.time_step = of_box == BodyModel::frame ? 2e-5 : 1e-4;
  setup.run.settle = false;
  compute_as(setup, of_cabinet);
  setup.parameters.models[1] = of_box;
  return setup;
}

/// Of a rigid body's point, m/s; arm: from its centre of gravity, m.
Vec3 velocity_at(const BodyState& s, const Vec3& arm) {
  return s.velocity + (s.rotation * s.angular_velocity).cross(arm);
}

// Without friction the impulse has the direction of the normal, and the points part e times as fast as they
// met: exactly but for the turning during the contact of some milliseconds, which is 1 % of the speed. From
// then on the box, a cube, keeps its angular velocity.
TEST(PanelCollision, a_corner_parts_from_a_panel_as_its_restitution_asks) {
  for (const double e : {0., 0.3, 0.7, 1.}) {
    topple::Setup setup = corner_first(BodyModel::rigid, BodyModel::rigid);
    setup.parameters.contact.restitution = e;
    Simulation sim = simulate(setup);
    const State start = placed(sim);
    Vec3 of_corner(-10, 0, 0);  // at the start the foremost
    for (int i = 0; i < sim.model.node_total(); ++i)
      if (sim.model.node_body[i] == 1 && start.position[i].x() > of_corner.x()) of_corner = start.position[i];
    const Vec3 at(-0.19, of_corner.y(), of_corner.z());
    const Vec3 arm = of_corner - start.bodies[1].position;
    ASSERT_TRUE(sim.advance(1000));
    const double parting = (velocity_at(sim.state.bodies[0], at - sim.model.bodies[0].centre_of_gravity) -
                            velocity_at(sim.state.bodies[1], arm))
                               .x();
    EXPECT_NEAR(parting, e * k_speed, 0.01 * k_speed) << e;
    EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
  }
}

TEST(PanelCollision, momentum_is_kept_and_nobody_passes_on_every_level) {
  using enum BodyModel;
  for (const auto& [of_cabinet, of_box] :
       {std::pair(rigid, rigid), {elastic, elastic}, {rigid, elastic}, {frame, rigid}, {frame, frame}}) {
    const topple::Setup setup = corner_first(of_cabinet, of_box);
    Simulation sim = simulate(setup);
    const Vec3 linear = linear_momentum(sim.model, placed(sim)),
               angular = angular_momentum(sim.model, placed(sim));
    double before = 0, after = 0;  // x of the box's centre against the cabinet's
    const auto apart = [&] { return (body_pose(sim.model, sim.state, 1).centre).x(); };
    before = apart();
    const int steps = static_cast<int>(std::lround(0.15 / setup.parameters.time_step));
    ASSERT_TRUE(sim.advance(steps)) << traits(of_cabinet).word << ' ' << traits(of_box).word;
    after = apart();
    const State end = placed(sim);
    EXPECT_LT((linear_momentum(sim.model, end) - linear).norm(), 1e-9 * linear.norm());
    // the rotation of a step is exact to its third order
    EXPECT_LT((angular_momentum(sim.model, end) - angular).norm(), 1e-4 * angular.norm());
    EXPECT_GT(after, before);
    EXPECT_LT(after, -0.19);  // still beside the cabinet, which moves less
    EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
  }
}

// Two cabinets side by side whose edges meet edges: nothing is left to the panels.
TEST(PanelCollision, panels_change_nothing_where_edges_meet) {
  std::array<double, 2> force{}, tilt{};
  for (const bool surfaces : {false, true}) {
    topple::Setup setup;
    setup.model = steel_model();
    setup.model.surfaces = surfaces;
    for (int k = 0; k < 2; ++k) {
      CabinetSpec spec = tall_cabinet();
      spec.base = CabinetSpec::Base::corners;
      spec.name = "cabinet-" + std::to_string(k);
      spec.at = Vec3(0.42 * k, 0, 0);
      spec.velocity = Vec3(k == 0 ? 0.5 : 0, 0, 0);
      setup.starts.push_back(add_cabinet(setup.model, spec));
    }
    setup.model.planes.push_back(ground());
    setup.run.settle = false;
    setup.parameters.contact.alpha = 500 * k_g;
    compute_as(setup, BodyModel::rigid);
    setup.run.duration = 1;
    topple::Run run(setup);
    while (!run.over()) {
      ASSERT_TRUE(run.advance().ok());
      for (const MemberForce& f : run.member_contacts())
        force[surfaces] = std::max(force[surfaces], f.force.norm());
      tilt[surfaces] = std::max(tilt[surfaces], topple::tilt(body_pose(setup.model, run.state(), 1)));
    }
  }
  EXPECT_GT(force[0], 10);
  EXPECT_NEAR(force[1], force[0], 0.01 * force[0]);
  EXPECT_NEAR(tilt[1], tilt[0], 0.01 * tilt[0]);
}

}  // namespace
}  // namespace topple::test
