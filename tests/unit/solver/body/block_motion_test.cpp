// Blocks in runs: on a floor, on each other, on a slope and in the air.
#include <functional>

#include "solver/contact/contact_default.h"
#include "solver/model/block.h"
#include "unit/solver/body_models.h"

namespace topple::test::blocks {
namespace {

BlockSpec box(const Vec3& size, double mass) {
  BlockSpec spec;
  spec.name = "box";
  spec.size = size;
  spec.mass = mass;
  spec.cg = Vec3(0, 0, size.z() / 2);
  return spec;
}

/// Under contacts as scenes choose them.
topple::Setup on_floor(const std::vector<BlockSpec>& specs, BodyModel model = BodyModel::rigid) {
  topple::Setup setup;
  for (const BlockSpec& spec : specs) setup.starts.push_back(add_block(setup.model, spec));
  setup.model.planes.push_back(ground(0));
  ContactLaw& law = setup.parameters.contact;
  law.alpha = *rigid_alpha(setup.model, law, setup.parameters.gravity);
  law.member_share = std::min(1., *member_alpha(setup.model, law, setup.parameters.gravity) / law.alpha);
  setup.parameters.adaptive = true;
  setup.parameters.models.assign(specs.size(), model);
  return setup;
}

double turn(const topple::Run& run, int body = 0) {
  return log_quaternion(run.state().bodies[static_cast<std::size_t>(body)].rotation).y();
}

/// s, at which the sign of the tilt changes first.
double first_impact(topple::Run& run) {
  double before = turn(run), from = 0;
  while (!run.over()) {
    EXPECT_TRUE(run.advance().ok());
    const double now = turn(run);
    if (now * before <= 0) return from + (run.time() - from) * before / (before - now);
    before = now, from = run.time();
  }
  ADD_FAILURE() << "does not come back";
  return 0;
}

/// Of th'' = -p^2 sin(a - th) from rest at `tilt` to 0, s, by Runge and Kutta's method.
double quarter_period(double b, double h, double tilt) {
  const double a = std::atan2(b, h), p2 = 3 * k_g / (4 * std::hypot(b, h)), dt = 1e-5;
  double th = tilt, rate = 0, t = 0;
  const auto pull = [&](double x) { return -p2 * std::sin(a - x); };
  while (th > 0) {
    const double k1 = pull(th), k2 = pull(th + dt / 2 * rate),
                 k3 = pull(th + dt / 2 * rate + dt * dt / 4 * k1),
                 k4 = pull(th + dt * rate + dt * dt / 2 * k2);
    th += dt * rate + dt * dt / 6 * (k1 + k2 + k3);
    rate += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    t += dt;
  }
  return t;
}

// Planar: to the last digits that the line between two steps leaves. Rigid: contacts give way by 2 % of the
// critical angle at most (contact_default.h), of which the time takes the square root of a part.
TEST(BlockMotion, rocks_as_housners_block) {
  for (const BodyModel model : {BodyModel::planar, BodyModel::rigid}) {
    BlockSpec spec = box(Vec3(0.3, 0.6, 1), 50);
    spec.tilt = 0.1;
    topple::Setup setup = on_floor({spec}, model);
    setup.run.settle = false;
    setup.parameters.contact.alpha *= 100;
    setup.parameters.adaptive = false;
    setup.parameters.time_step = 1e-4;
    topple::Run run(setup);
    const double exact = quarter_period(0.15, 0.5, 0.1);
    EXPECT_NEAR(first_impact(run), exact, (model == BodyModel::planar ? 1e-4 : 1e-3) * exact);
  }
}

TEST(BlockMotion, is_planar_by_itself_and_rigid_when_it_must) {
  const BlockSpec spec = box(Vec3(0.3, 0.6, 1), 50);
  const topple::Setup automatic = on_floor({spec}, BodyModel::automatic);
  const topple::Run alone(automatic);
  EXPECT_EQ(alone.state().bodies[0].level, ModelLevel::planar);
  EXPECT_EQ(alone.state().bodies[0].reason, LevelReason::solid);
  for (const BodyModel asked : {BodyModel::frame, BodyModel::elastic, BodyModel::rigid}) {
    const topple::Setup setup = on_floor({spec}, asked);
    EXPECT_EQ(can_be(setup.model, 0, asked), asked == BodyModel::rigid);
    const topple::Run run(setup);
    EXPECT_EQ(run.state().bodies[0].level, ModelLevel::rigid);
  }
}

TEST(BlockMotion, sinks_by_its_weight_on_its_corners) {
  for (const auto base : {BlockSpec::Base::corners, BlockSpec::Base::edges}) {
    BlockSpec spec = box(Vec3(0.3, 0.6, 1), 50);
    spec.base = base;
    const topple::Setup setup = on_floor({spec});
    const ContactLaw& law = setup.parameters.contact;
    const double points = base == BlockSpec::Base::corners ? 4 : 9;
    const topple::Run run(setup);
    ASSERT_TRUE(run.status().ok());
    ASSERT_EQ(run.contacts().size(), static_cast<std::size_t>(points));
    const double depth = std::pow(50 * k_g / (points * law.alpha), 1 / law.q);
    for (const ContactForce& f : run.contacts()) EXPECT_NEAR(f.depth, depth, 1e-9 * depth);
  }
}

/// Blocks that lie flat on each other, each farther along x than the one below.
std::vector<BlockSpec> stack(int count, double step) {
  std::vector<BlockSpec> specs;
  for (int k = 0; k < count; ++k) {
    BlockSpec spec = box(Vec3(0.3, 0.4, 0.12), 6);
    spec.name = copy_name("box", static_cast<std::size_t>(k));
    spec.at = Vec3(k * step, 0, k * (spec.size.z() + contact_width_of(spec.size)));
    specs.push_back(spec);
  }
  return specs;
}

TEST(BlockMotion, five_stand_still_on_each_other) {
  topple::Setup setup = on_floor(stack(5, 0));
  setup.run.duration = 10;
  topple::Run run(setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  const State start = run.state();
  while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
  for (int b = 0; b < 5; ++b) {
    EXPECT_LT((run.state().bodies[b].position - start.bodies[b].position).norm(), 1e-6) << b;
    EXPECT_LT(log_quaternion(start.bodies[b].rotation.conjugate() * run.state().bodies[b].rotation).norm(),
              1e-6)
        << b;
  }
}

TEST(BlockMotion, falls_with_its_centre_beyond_the_edge_of_the_one_below) {
  for (const double share : {0.44, 0.56}) {
    topple::Setup setup = on_floor(stack(2, share * 0.3));
    setup.run.settle = false;
    setup.run.duration = 2;
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
    const double tilted = tilt(body_pose(setup.model, run.state(), 1)) * k_degrees;
    if (share < 0.5)
      EXPECT_LT(tilted, 0.5);
    else
      EXPECT_GT(tilted, 10);
  }
}

// Two of one size that lean as one: about the edge of the lower one, by what both weigh.
TEST(BlockMotion, pile_falls_from_beyond_the_critical_angle_of_all) {
  constexpr double k_depth = 0.3, k_height = 0.5;
  for (const double share : {0.96, 1.04}) {
    std::vector<BlockSpec> specs(2, box(Vec3(k_depth, 0.4, k_height), 20));
    specs[1].name = "upper";
    specs[1].at.z() = k_height + contact_width_of(specs[1].size);
    topple::Setup setup = on_floor(specs);
    const double both = (k_height + contact_width_of(specs[1].size) + k_height) / 2;
    const double critical = std::atan2(k_depth / 2, both);
    for (BodyStart& start : setup.starts) {
      start.pivot = setup.model.bodies[0].base_centre + Vec3(k_depth / 2, 0, 0);
      start.rotation = share * critical * Vec3::UnitY();
    }
    setup.parameters.contact.friction = 1;
    setup.run.settle = false;
    setup.run.duration = 2;
    topple::Run run(setup);
    EXPECT_NEAR(run.outcome().bodies()[0].critical, critical, 1e-9);
    while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
    const BodyOutcome& lower = run.outcome().bodies()[0];
    EXPECT_EQ(lower.beyond_since.has_value(), share > 1);
    EXPECT_EQ(lower.tilt > 1, share > 1) << lower.tilt;
  }
}

// The floor moves from under it: (a - mu g) t^2/2, but for the time in which the springs of friction fill,
// which goes as 1/sqrt(alpha): 2e-4 of the way here.
TEST(BlockMotion, slides_by_coulombs_law_on_a_floor_that_is_pushed) {
  for (const BodyModel model : {BodyModel::planar, BodyModel::rigid}) {
    topple::Setup setup = on_floor({box(Vec3(0.6, 0.4, 0.1), 20)}, model);
    setup.parameters.contact.friction = 0.3;
    setup.parameters.contact.alpha *= 100;
    Shake push;
    push.kind = Shake::Kind::pulse;
    push.shape = Shake::Shape::rectangle;
    push.amplitude = 5, push.duration = 1;
    setup.parameters.shakes = {push};
    setup.run.duration = 0.5;
    topple::Run run(setup);
    const double from = run.state().bodies[0].position.x();
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    const double way = (5 - 0.3 * k_g) * run.time() * run.time() / 2;
    EXPECT_NEAR(std::abs(run.state().bodies[0].position.x() - from), way, 1e-3 * way);
  }
}

// As above, however short the steps that a tolerance asks for.
TEST(BlockMotion, a_rectangle_pushes_from_its_start_to_its_end) {
  for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
    topple::Setup setup = on_floor({box(Vec3(0.6, 0.4, 0.1), 20)});
    setup.parameters.contact.friction = 0.3;
    setup.parameters.contact.alpha *= 100;
    setup.parameters.tolerance = tolerance;
    Shake push;
    push.kind = Shake::Kind::pulse;
    push.shape = Shake::Shape::rectangle;
    push.start = 0.1, push.amplitude = 5, push.duration = 0.2;
    setup.parameters.shakes = {push};
    setup.run.duration = 0.3;
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok()) << tolerance;
    EXPECT_NEAR(run.state().time, 0.3, 1e-9) << tolerance;
    const double speed = (5 - 0.3 * k_g) * 0.2;
    EXPECT_NEAR(std::abs(run.state().bodies[0].velocity.x()), speed, 1e-3 * speed) << tolerance;
  }
}

// Thrown along the floor, also askew to its sides, with steps of its own: v^2/(2 mu g), but for the
// micrometres that the springs of friction give way, and for the lean forward. Steps over the instant at
// which it stops left it 1.3, 0.09 and 0.9 mm further back.
TEST(BlockMotion, comes_to_rest_by_coulombs_law_and_stays_there) {
  struct Row {
    double height, friction, aside;  ///< m, 1, m/s
  };
  for (const auto& [height, friction, aside] : {Row{0.5, 0.4, 0}, {0.3, 0.2, 0.1}, {0.3, 0.2, 0.3}}) {
    topple::Setup setup = on_floor({box(Vec3(0.3, 0.4, height), 20)}, BodyModel::rigid);
    setup.parameters.contact.friction = friction;
    setup.starts[0].velocity = Vec3(0.5, aside, 0);
    setup.run.settle = false;
    setup.run.duration = 1;
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    const double way = (0.25 + aside * aside) / (2 * friction * k_g);
    const BodyOutcome& out = run.outcome().bodies()[0];
    EXPECT_NEAR(out.peak_slide, way, 2e-3 * way) << height << ", " << aside;
    EXPECT_NEAR(out.slide, out.peak_slide, 5e-6) << height << ", " << aside;
  }
}

/// A held sheet of 2.5 m by 1 m that falls by `angle` towards +x, and a block on it that is turned as much.
topple::Setup on_slope(double angle, double friction) {
  topple::Setup setup;
  setup.model = steel_model();
  const BlockSpec flat = box(Vec3(0.3, 0.2, 0.08), 5);
  const double width = contact_width_of(flat.size);
  const Vec3 down(std::cos(angle), 0, -std::sin(angle)), normal(std::sin(angle), 0, std::cos(angle));
  const Vec3 edge(0.15, 0, width / 2), below = edge - (width + 0.03) / 2 * normal;
  FrameSpec slope;
  slope.name = "slope";
  for (const auto& [u, v] : {std::pair{-0.5, -0.5}, {2., -0.5}, {2., 0.5}, {-0.5, 0.5}})
    slope.nodes.push_back(below + u * down + v * Vec3::UnitY());
  for (int k = 0; k < 4; ++k) {
    FrameMember side{{k, (k + 1) % 4}, 0, 0};
    side.up = normal;
    slope.members.push_back(side);
    slope.supports.push_back({k, k_clamped});
  }
  slope.panels = {{0, 1, 2, 3}};
  setup.starts = add_frame(setup.model, slope);
  BlockSpec spec = flat;
  spec.tilt = angle;
  setup.starts.push_back(add_block(setup.model, spec));
  setup.run.settle = false;
  setup.parameters.contact.alpha = 1e4 * k_g;
  setup.parameters.contact.friction = friction;
  setup.parameters.contact.restitution = 0;
  setup.parameters.models = {BodyModel::frame, BodyModel::rigid};
  setup.run.duration = 0.3;
  return setup;
}

// What it bounces by the depth of its contacts when it is put on the sheet changes the way by 1e-5 of it.
TEST(BlockMotion, slides_down_a_sheet_by_coulombs_law_or_sticks) {
  const double angle = 20 / k_degrees;
  for (const double friction : {0.1, 0.2, 0.6}) {
    const topple::Setup setup = on_slope(angle, friction);
    topple::Run run(setup);
    const Vec3 from = run.state().bodies[1].position;
    while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
    const double along =
        (run.state().bodies[1].position - from).dot(Vec3(std::cos(angle), 0, -std::sin(angle)));
    const double way =
        std::max(0., std::sin(angle) - friction * std::cos(angle)) * k_g * run.time() * run.time() / 2;
    EXPECT_NEAR(along, way, way > 0 ? 1e-4 * way : 1e-5) << friction;
  }
}

// Nothing acts on it but its weight: the parabola, and angular momentum, stay to rounding.
TEST(BlockMotion, flies_as_a_rigid_body_does) {
  BlockSpec spec = box(Vec3(0.2, 0.3, 0.5), 12);
  spec.cg = Vec3(0.03, -0.05, 0.2);
  spec.velocity = Vec3(1, -0.5, 3);
  spec.angular_velocity = Vec3(2, -1, 1.5);
  topple::Setup setup;
  setup.starts.push_back(add_block(setup.model, spec));
  setup.run.settle = false;
  setup.parameters.models = {BodyModel::automatic};
  Simulation sim = simulate(setup);
  const Vec3 x0 = sim.state.bodies[0].position, v0 = sim.state.bodies[0].velocity;
  EXPECT_LT((x0 - setup.model.bodies[0].centre_of_gravity).norm(), 1e-15);
  EXPECT_LT((v0 - spec.velocity).norm(), 1e-14);
  EXPECT_LT((sim.state.bodies[0].angular_velocity - spec.angular_velocity).norm(), 1e-14);
  const Vec3 spin0 = body_momentum(sim.model, sim.state, 0).angular_momentum;
  ASSERT_TRUE(sim.advance(2000));
  const double t = sim.state.time;
  EXPECT_LT((sim.state.bodies[0].position - x0 - t * v0 - t * t / 2 * Vec3(0, 0, -k_g)).norm(), 1e-11);
  EXPECT_LT((body_momentum(sim.model, sim.state, 0).angular_momentum - spin0).norm(), 1e-11 * spin0.norm());
  EXPECT_LT(sim.state.energy.balance_error(), 1e-6);
}

}  // namespace
}  // namespace topple::test::blocks
