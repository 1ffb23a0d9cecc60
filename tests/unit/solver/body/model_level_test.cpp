// Model levels: which level a body stands on, and switches within a run.
#include "solver/body/model_level.h"

#include "solver/body/body_pose.h"
#include "solver/reduced/tipping.h"
#include "solver/state/step_limits.h"
#include "unit/solver/body_models.h"

namespace topple::test {
namespace {

struct Snapshot {
  Vec3 centre, velocity, spin;
  Quat rotation;
};

Snapshot snapshot(const Simulation& sim) {
  const BodyPose pose = body_pose(sim.model, sim.state, 0);
  const BodyMomentum momentum = body_momentum(sim.model, sim.state, 0);
  return {pose.centre, momentum.velocity, momentum.angular_momentum, pose.rotation};
}

/// Of the body's own nodes.
Snapshot of_nodes(const Simulation& sim) {
  State state = placed(sim);
  state.bodies[0].level = ModelLevel::frame;
  const BodyPose pose = body_pose(sim.model, state, 0);
  const BodyMomentum momentum = body_momentum(sim.model, state, 0);
  return {pose.centre, momentum.velocity, momentum.angular_momentum, pose.rotation};
}

// Whatever its level, a body has its momentum and its place, and a switch explains what energy it changes.
TEST(ModelLevel, goes_up_and_down_in_mid_flight) {
  topple::Setup setup = thrown(BodyModel::frame);
  Simulation sim = simulate(setup);
  ASSERT_TRUE(sim.advance(100));
  const Vec3 spin = body_momentum(sim.model, sim.state, 0).angular_momentum;
  for (const BodyModel model : {BodyModel::elastic, BodyModel::frame, BodyModel::rigid, BodyModel::elastic,
                                BodyModel::rigid, BodyModel::frame}) {
    const Snapshot before = snapshot(sim);
    const double booked = sim.state.energy.model_switch, unexplained = sim.state.energy.unexplained();
    sim.parameters.models[0] = model;
    ASSERT_TRUE(sim.advance(1));
    const double h = sim.parameters.time_step;
    const Snapshot after = snapshot(sim);
    // a step of free flight: its exact travel, whatever computes it
    const Vec3 g(0, 0, -k_g);
    EXPECT_LT((after.centre - before.centre - h * before.velocity - h * h / 2 * g).norm(), 1e-8);
    EXPECT_LT((after.velocity - before.velocity - h * g).norm(), 1e-9);
    EXPECT_LT((after.spin - spin).norm(), 1e-4 * spin.norm());
    EXPECT_NEAR(before.rotation.angularDistance(after.rotation), h * 2.7, h * 0.3);
    // the mean motion that the nodes have is that of the body
    const Snapshot nodes = of_nodes(sim);
    EXPECT_LT((nodes.centre - after.centre).norm(), 1e-9);
    EXPECT_LT((nodes.velocity - after.velocity).norm(), 1e-9);
    EXPECT_LT((nodes.spin - after.spin).norm(), 1e-4 * spin.norm());
    EXPECT_LT(std::abs(sim.state.energy.model_switch - booked), 0.01);        // of 230 J
    EXPECT_LT(std::abs(sim.state.energy.unexplained() - unexplained), 5e-4);  // 2e-6 of it
    ASSERT_TRUE(sim.advance(100));
  }
  EXPECT_EQ(sim.state.bodies[0].level, ModelLevel::frame);
  EXPECT_LT(sim.state.energy.balance_error(), 1e-5);
}

// In contact too: it goes on as the frame does that never switched, to what the levels differ by.
TEST(ModelLevel, goes_up_and_down_in_contact) {
  Simulation frame = simulate(paper_cabinet(BodyModel::frame, 4 / k_degrees)),
             sim = simulate(paper_cabinet(BodyModel::frame, 4 / k_degrees));
  const BodyModel models[] = {BodyModel::elastic, BodyModel::rigid,   BodyModel::frame,
                              BodyModel::rigid,   BodyModel::elastic, BodyModel::frame};
  double furthest = 0;
  for (int i = 0; i < 1200; ++i) {
    if (i % 150 == 149) {
      const Snapshot before = snapshot(sim);
      const double unexplained = sim.state.energy.unexplained();
      EXPECT_FALSE(sim.contacts().empty());
      sim.parameters.models[0] = models[i / 150 % 6];
      ASSERT_TRUE(sim.advance(1) && frame.advance(1));
      const Snapshot after = snapshot(sim);
      // what the contacts do within a millisecond, g/2 h^2 and g h
      EXPECT_LT((after.centre - before.centre - 1e-3 * before.velocity).norm(), 1e-5);
      EXPECT_LT((after.velocity - before.velocity).norm(), 2e-2);
      EXPECT_LT(std::abs(sim.state.energy.unexplained() - unexplained), 2e-3);
      continue;
    }
    ASSERT_TRUE(sim.advance(1) && frame.advance(1));
    furthest = std::max(furthest, std::abs(tilt_of(sim) - tilt_of(frame)));
  }
  EXPECT_LT(furthest, 0.1);
  EXPECT_NE(sim.state.energy.model_switch, 0);
  EXPECT_LT(std::abs(sim.state.energy.model_switch), 0.05);  // J, of 5 that it rocks with
  EXPECT_LT(sim.state.energy.balance_error(), 2e-3);
}

TEST(ModelLevel, begins_with_the_least_that_answers) {
  topple::Setup setup = paper_cabinet(BodyModel::automatic);
  Parameters& p = setup.parameters;
  EXPECT_EQ(base_level(setup.model, p, 0).level, ModelLevel::elastic);
  EXPECT_EQ(base_level(setup.model, p, 0).reason, LevelReason::stress);
  p.want_stress = false;
  EXPECT_EQ(base_level(setup.model, p, 0).level, ModelLevel::rigid);
  EXPECT_EQ(base_level(setup.model, p, 0).reason, LevelReason::motion);
  p.contact.alpha *= 400;  // 137 Hz of contact, 159 of the first mode: what is wanted has not changed
  EXPECT_EQ(base_level(setup.model, p, 0).level, ModelLevel::rigid);
  p.models.clear();
  EXPECT_EQ(base_level(setup.model, p, 0).level, ModelLevel::frame);
}

TEST(ModelLevel, is_elastic_where_bending_changes_the_motion_by_more_than_is_allowed) {
  topple::Setup setup = paper_cabinet(BodyModel::automatic);
  Parameters& p = setup.parameters;
  p.want_stress = false;
  const double error = rigid_error(setup.model, p, 0);
  EXPECT_GT(error, 0);
  for (const double share : {0.999, 1.001}) {
    p.accuracy = share * error;
    const LevelChoice base = base_level(setup.model, p, 0);
    EXPECT_EQ(base.level, share < 1 ? ModelLevel::elastic : ModelLevel::rigid);
    EXPECT_EQ(base.reason, share < 1 ? LevelReason::bending : LevelReason::motion);
  }
}

// Rotations of nodes are allowed by what they do to what is asked for.
TEST(ModelLevel, allows_a_greater_deformation_where_only_motion_is_asked_for) {
  const topple::Setup setup = paper_cabinet(BodyModel::automatic);
  Parameters p = setup.parameters;
  const Body& body = setup.model.bodies[0];
  EXPECT_DOUBLE_EQ(elastic_error(body, p, 0.02), 0.01);
  p.want_stress = false;
  EXPECT_DOUBLE_EQ(elastic_error(body, p, 0.02), 2e-4 / least_tipping_angle(body));
}

// Its estimate is that of the level it stands on, the greatest so far.
TEST(ModelLevel, says_how_much_its_error_may_be) {
  for (const bool stress : {false, true}) {
    topple::Setup setup = paper_cabinet(BodyModel::automatic, 4 / k_degrees);
    setup.parameters.want_stress = stress;
    topple::Run run(setup);
    double greatest = run.state().bodies[0].error_estimate;
    while (!run.over()) {
      ASSERT_TRUE(run.advance().ok());
      greatest = std::max(greatest, run.state().bodies[0].error_estimate);
    }
    const auto& changes = run.outcome().bodies()[0].level_changes;
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_EQ(changes[0].error_estimate, greatest);
    if (stress)
      EXPECT_GT(greatest, 1e-5);
    else
      EXPECT_EQ(greatest, rigid_error(setup.model, setup.parameters, 0));
    EXPECT_LT(greatest, setup.parameters.accuracy);
  }
}

// A cabinet that falls and yields where it lands.
topple::Setup shaken_until_it_yields() {
  topple::Setup setup = shaken(3, 12 / k_degrees);
  for (Element& element : setup.model.elements) {
    const Section& post = setup.model.sections[0];
    element.capacity << 60e6 * post.area, 60e6 * post.zt / std::sqrt(3), 60e6 * post.zy, 60e6 * post.zz;
  }
  return setup;
}

// What has hinges stays a frame.
TEST(ModelLevel, climbs_before_a_section_yields_and_stays) {
  topple::Setup setup = shaken_until_it_yields();
  setup.parameters.contact.restitution = 0.5;
  compute_as(setup, BodyModel::automatic);
  topple::Run run(setup);
  EXPECT_EQ(run.state().bodies[0].level, ModelLevel::elastic);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const BodyOutcome& o = run.outcome().bodies()[0];
  EXPECT_GT(o.hinges, 0);
  EXPECT_EQ(run.state().bodies[0].level, ModelLevel::frame);
  ASSERT_GE(o.level_changes.size(), 2u);
  EXPECT_EQ(o.level_changes[1].level, ModelLevel::frame);
  EXPECT_EQ(o.level_changes[1].reason, LevelReason::yield);
  const Event* first_hinge = nullptr;
  for (const Event& event : run.events())
    if (event.kind == Event::Kind::hinge && !first_hinge) first_hinge = &event;
  ASSERT_TRUE(first_hinge);
  EXPECT_LE(o.level_changes[1].time, first_hinge->time);
  EXPECT_LT(run.state().energy.balance_error(), 0.02);
}

// A body that stands is sampled a few times in a period of its contacts, not twenty: its stresses change with
// the floor alone.
TEST(ModelLevel, elastic_takes_long_steps_while_it_hardly_bounces) {
  topple::Setup setup = paper_cabinet(BodyModel::elastic);
  setup.parameters.contact.alpha *= 400;
  setup.parameters.shakes.clear();
  shake(setup, 1, 0.5);  // far below uplift
  setup.parameters.shakes[0].taper = 1;
  setup.run.duration = 2;
  double stress[2];
  for (const bool adaptive : {false, true}) {
    setup.parameters.adaptive = adaptive;
    setup.parameters.time_step = 1e-4;
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    stress[adaptive] = run.outcome().bodies()[0].peak_stress;
    if (!adaptive) continue;
    const Model& model = setup.model;
    const double stiffness = model.bodies[0].contact_point_count *
                             penalty_stiffness(setup.parameters.contact, 0.1,
                                               contact_length(model.contact_points[0], model.planes[0]));
    EXPECT_LT(run.step(), 2 / (4 * bounce_limit(model.bodies[0].mass, stiffness)));
  }
  EXPECT_NEAR(stress[1], stress[0], 2e-3 * stress[0]);  // 0.2 of what `accuracy` allows
}

// Integrators are of frames: without one nothing differs, down to the last bit.
TEST(ModelLevel, adaptive_central_differences_without_a_frame_step_as_without_them) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic}) {
    topple::Setup setup = paper_cabinet(model);
    setup.parameters.adaptive = true;
    shake(setup, 4, 2);
    topple::Run implicit(setup);
    setup.parameters.integrator = Integrator::central_difference;
    topple::Run run(setup);
    for (int i = 0; i < 300 && !run.over(); ++i) ASSERT_TRUE(run.advance().ok() && implicit.advance().ok());
    EXPECT_GT(run.time(), 0.1);
    EXPECT_EQ(hash(run.state()), hash(implicit.state()));
    EXPECT_FALSE(run.stable_step());
  }
}

// With the refinement of an estimate, too: tolerances do not shorten them.
TEST(ModelLevel, adaptive_central_differences_shorten_their_step_for_a_new_frame) {
  for (const double refinement : {1., 2.}) {
    topple::Setup setup = shaken_until_it_yields();
    setup.parameters.integrator = Integrator::central_difference;
    setup.parameters.adaptive = true;
    setup.parameters.substep_refinement = refinement;
    compute_as(setup, BodyModel::automatic);
    topple::Run run(setup);
    double before = 0;
    while (run.state().bodies[0].level != ModelLevel::frame) {
      EXPECT_FALSE(run.stable_step());
      before = run.time();
      ASSERT_TRUE(run.advance().ok());
      ASSERT_FALSE(run.over());
    }
    for (int i = 0; i < 100; ++i) {
      EXPECT_NEAR(run.time() - before, 0.9 * run.stable_step().value() / refinement, 1e-9 * run.time());
      before = run.time();
      ASSERT_TRUE(run.advance().ok());
    }
    EXPECT_LT(run.state().energy.balance_error(), 1e-3);
  }
}

/// Two of which the first comes to the second, a frame.
topple::Setup meets_a_frame(BodyModel model) {
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.velocity = Vec3(1, 0, 0);
  setup.starts.push_back(add_cabinet(setup.model, spec));
  spec.name = "second";
  spec.at.x() = 0.6;
  spec.velocity.setZero();
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.run.settle = false;
  setup.run.duration = 2;
  setup.parameters.gravity.setZero();
  compute_as(setup, model);
  return setup;
}

// An elastic one is one too from before they touch until they are apart and calm again.
TEST(ModelLevel, is_a_frame_while_one_is_near) {
  topple::Setup setup = meets_a_frame(BodyModel::elastic);
  setup.parameters.models[1] = BodyModel::frame;
  topple::Run run(setup);
  EXPECT_EQ(run.state().bodies[0].level, ModelLevel::elastic);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const auto& changes = run.outcome().bodies()[0].level_changes;
  ASSERT_GT(changes.size(), 1u);
  EXPECT_EQ(changes[1].reason, LevelReason::near);
  EXPECT_GT(run.outcome().bodies()[1].peak_pinch, 0);
  EXPECT_LT(run.state().energy.balance_error(), 0.01);
  const Vec3 momentum = 40 * (body_momentum(setup.model, run.state(), 0).velocity +
                              body_momentum(setup.model, run.state(), 1).velocity);
  EXPECT_LT((momentum - Vec3(40, 0, 0)).norm(), 1e-6);
}

// By the forces between members alone, which a body in free flight has no others than.
TEST(ModelLevel, climbs_before_a_blow_of_another_body_makes_a_section_yield) {
  topple::Setup setup = meets_a_frame(BodyModel::automatic);
  const Section& post = setup.model.sections[0];
  for (Element& element : setup.model.elements)
    element.capacity << 20e6 * post.area, 20e6 * post.zt / std::sqrt(3), 20e6 * post.zy, 20e6 * post.zz;
  setup.parameters.time_step = 5e-4;  // the balance is of second order in it: 0.012 at 1 ms
  compute_as(setup, BodyModel::automatic);
  topple::Run run(setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  bool yields = false;
  for (const BodyOutcome& body : run.outcome().bodies()) {
    ASSERT_FALSE(body.level_changes.empty());
    EXPECT_EQ(body.level_changes[0].level, ModelLevel::elastic);
    for (const LevelChange& change : body.level_changes)
      yields = yields || change.reason == LevelReason::yield;
    EXPECT_GT(body.peak_yield_ratio.value(), 0.9);
  }
  EXPECT_TRUE(yields);
  EXPECT_LT(run.state().energy.balance_error(), 0.01);
}

TEST(ModelLevel, stays_what_it_is_while_others_than_frames_are_near) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic}) {
    topple::Setup setup = meets_a_frame(model);
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    for (const BodyOutcome& body : run.outcome().bodies())
      EXPECT_EQ(body.level_changes.size(), traits(model).lists_start ? 1u : 0u);
    EXPECT_GT(run.outcome().bodies()[1].peak_pinch, 0);
  }
}

// The 0.08 s of calm after which a frame comes down begin when the other body has left.
TEST(ModelLevel, is_not_calm_while_a_frame_is_near) {
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  setup.starts.push_back(add_cabinet(setup.model, spec));
  spec.name = "second";
  spec.at.x() = 0.45;
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.run.settle = false;
  setup.parameters.gravity.setZero();
  compute_as(setup, BodyModel::elastic);
  setup.parameters.models[1] = BodyModel::frame;
  Simulation sim = simulate(setup);
  ASSERT_EQ(sim.state.bodies[0].reason, LevelReason::near);
  sim.state.bodies[0].calm_since = 0;  // it was alone, and calm, before
  ASSERT_TRUE(sim.advance(1));
  EXPECT_EQ(sim.state.bodies[0].reason, LevelReason::near);
  EXPECT_EQ(sim.state.bodies[0].calm_since, -1);
}

TEST(ModelLevel, goes_on_bit_for_bit_from_a_checkpoint) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic}) {
    topple::Setup setup = paper_cabinet(model, 4 / k_degrees);
    topple::Run run(setup);
    while (run.state().step < 300) ASSERT_TRUE(run.advance().ok());
    topple::Run other(setup, unpack(setup.model, pack(run.state())), run.parameters());
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(run.advance().ok() && other.advance().ok());
    EXPECT_EQ(hash(run.state()), hash(other.state()));
  }
}

// Nodes of bodies that are not frames are placed when somebody looks, and nothing may go by where they are.
// Parts of different sizes follow each other, so that nothing of one may be left for the next.
TEST(ModelLevel, goes_on_bit_for_bit_in_a_new_workspace_at_every_step) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic, BodyModel::frame}) {
    topple::Setup setup = paper_cabinet(model, 0.02);
    setup.parameters.adaptive = true;
    setup.parameters.contact.alpha = 5000 * k_g;
    topple::Run run(setup), fresh(setup);
    for (int i = 0; i < 300; ++i) {
      ASSERT_TRUE(run.advance().ok());
      fresh = topple::Run(setup, fresh.point());
      ASSERT_TRUE(fresh.advance().ok());
      ASSERT_EQ(hash(run.state()), hash(fresh.state())) << static_cast<int>(model) << ", step " << i;
    }
  }
}

// Of a soft frame on stiff contacts, whose feet move by more under each other's forces than they sink: placed
// where those put them they would bear 23 % more. What friction at the feet adds is not fitted: 5 %.
TEST(ModelLevel, a_frame_bears_what_the_elastic_body_bore_that_it_was) {
  topple::Setup setup;
  setup.model = steel_model();
  setup.model.materials[0].young = 6e9;
  CabinetSpec spec = tall_cabinet();
  spec.base = CabinetSpec::Base::corners;
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.model.planes.push_back(ground());
  setup.parameters.contact.alpha = 1e5 * k_g;
  setup.parameters.adaptive = true;
  setup.parameters.accuracy = 1e-9;
  compute_as(setup, BodyModel::automatic);
  topple::Run run(setup);
  ASSERT_EQ(run.state().bodies[0].level, ModelLevel::elastic);
  const std::vector<ContactForce> before = run.contacts();
  ASSERT_TRUE(run.advance().ok());
  ASSERT_EQ(run.state().bodies[0].level, ModelLevel::frame);
  ASSERT_EQ(run.contacts().size(), before.size());
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_NEAR(run.contacts()[k].normal, before[k].normal, 0.05 * before[k].normal) << k;
}

// The spring that friction holds has the flexibility of the point behind it in an elastic body and not in a
// frame: as long as it was it would bear eight times as much, or slip.
TEST(ModelLevel, friction_bears_after_a_change_what_it_bore_before) {
  topple::Setup setup = paper_cabinet(BodyModel::elastic);
  setup.parameters.contact.alpha = 1e5 * k_g;
  setup.parameters.gravity += Vec3(0.1 * k_g, 0, 0);
  Simulation sim = simulate(setup);
  const auto friction = [&] {
    Vec3 sum = Vec3::Zero();
    for (const ContactForce& contact : sim.contacts()) sum += contact.force;
    sum.z() = 0;
    return sum;
  };
  const double weight = sim.model.bodies[0].mass * k_g;
  sim.state.energy.largest = 100;  // J, so that a frame is calm
  for (const BodyModel model : {BodyModel::frame, BodyModel::elastic}) {
    const ModelLevel level = sim.state.bodies[0].level;
    sim.parameters.models[0] = model;
    sim.parameters.time_step = 1e-3;
    for (int k = 0; k < 78 && level == ModelLevel::frame; ++k) ASSERT_TRUE(sim.advance(1));
    sim.parameters.time_step = 1e-6;  // before what is missing makes the body slide until it is there again
    Vec3 before = Vec3::Zero();
    for (int k = 0; k < 4000 && sim.state.bodies[0].level == level; ++k) {
      before = friction();
      ASSERT_TRUE(sim.advance(1));
    }
    ASSERT_NE(sim.state.bodies[0].level, level);
    EXPECT_LT(before.x(), -0.05 * weight);
    EXPECT_LT((friction() - before).norm(), 0.02 * weight) << traits(sim.state.bodies[0].level).word;
  }
}

/// On contacts so stiff that explicit substeps of a frame cost less than implicit steps.
topple::Setup falls_on_a_stiff_floor(BodyModel model) {
  topple::Setup setup = shaken_until_it_yields();
  setup.parameters.contact.alpha = 5e4 * k_g;
  setup.parameters.adaptive = true;
  compute_as(setup, model);
  return setup;
}

TEST(ModelLevel, explicit_substeps_go_on_bit_for_bit_in_a_new_workspace_at_every_step) {
  const topple::Setup setup = falls_on_a_stiff_floor(BodyModel::automatic);
  topple::Run run(setup);
  while (run.state().bodies[0].level != ModelLevel::frame) ASSERT_TRUE(run.advance().ok() && !run.over());
  topple::Run fresh(setup, run.point());
  const std::int64_t iterations = run.newton_iterations();
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(run.advance().ok());
    fresh = topple::Run(setup, fresh.point());
    ASSERT_TRUE(fresh.advance().ok());
    ASSERT_EQ(hash(run.state()), hash(fresh.state())) << "step " << i;
  }
  EXPECT_LT(run.newton_iterations() - iterations, 300);
}

// What bends for good, of a body that begins elastic and of a frame in implicit steps of a tenth of the
// tolerance: 1 % is what `auto` allows its models.
TEST(ModelLevel, explicit_substeps_do_what_implicit_steps_do) {
  topple::Setup implicit = falls_on_a_stiff_floor(BodyModel::frame);
  implicit.parameters.tolerance = 1e-4;
  std::vector<double> plastic;
  for (const topple::Setup& setup : {falls_on_a_stiff_floor(BodyModel::automatic), implicit}) {
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    EXPECT_LT(run.state().energy.balance_error(), 1e-4);
    EXPECT_EQ(run.newton_iterations() < run.step(), plastic.empty());
    plastic.push_back(run.state().energy.plastic);
  }
  EXPECT_NEAR(plastic[0], plastic[1], 0.01 * plastic[1]);
}

TEST(ModelLevel, who_looks_at_an_adaptive_run_changes_nothing) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic}) {
    topple::Setup setup = paper_cabinet(model);
    setup.run.duration = 3;
    setup.parameters.adaptive = true;
    shake(setup, 4, 2);
    topple::Run looked_at(setup), left_alone(setup);
    for (int i = 0; i < 500; ++i) {
      ASSERT_TRUE(looked_at.advance().ok() && left_alone.advance().ok());
      EXPECT_GT(looked_at.state().position.size(), 0u);
    }
    EXPECT_EQ(hash(looked_at.state()), hash(left_alone.state()));
  }
}

}  // namespace
}  // namespace topple::test
