// The model ladder: rigid and elastic bodies beside the frame that they stand for, and switches within a run.
#include "solver/ladder.h"

#include "solver/elastic_basis.h"
#include "solver/modes.h"
#include "solver/overturn.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_degrees = 180 / k_pi;

void compute_as(Setup& setup, BodyModel model) {
  for (std::size_t b = 0; b < setup.model.bodies.size(); ++b)
    setup.model.bodies[b].elastic = elastic_basis(setup.model, static_cast<int>(b));
  setup.parameters.models.assign(setup.model.bodies.size(), model);
}

Setup paper_cabinet(BodyModel model, double tilt = 0) {
  Setup setup = shaken(1, tilt);
  setup.parameters.contact.restitution = 0.5;
  compute_as(setup, model);
  return setup;
}

/// Thrown, turning about all axes, with nothing to hit.
Setup thrown(BodyModel model) {
  Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.velocity = Vec3(1, -0.5, 3);
  spec.angular_velocity = Vec3(2, -1, 1.5);
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.run.settle = false;
  compute_as(setup, model);
  return setup;
}

Simulation simulate(const Setup& setup) {
  return {setup.model, setup.starts, setup.parameters, setup.run.settle};
}

double tilt_of(const Simulation& sim) {
  return tilt(body_pose(sim.model, sim.state, 0)) * k_degrees;
}

State placed(const Simulation& sim) {
  State state = sim.state;
  place_nodes(sim.model, state);
  return state;
}

// The trajectory of a body without forces is exact but for its turning, of which the angular momentum is.
TEST(RigidBody, flies_as_a_rigid_body_does) {
  topple::Setup setup = thrown(BodyModel::rigid);
  Simulation sim = simulate(setup);
  const Vec3 x0 = sim.state.bodies[0].position, v0 = sim.state.bodies[0].velocity;
  const Vec3 spin0 = body_momentum(sim.model, sim.state, 0).angular_momentum;
  const double kinetic0 = sim.state.energy.kinetic;
  ASSERT_TRUE(sim.advance(2000));
  const double t = sim.state.time;
  const Vec3 g(0, 0, -k_g);
  EXPECT_LT((sim.state.bodies[0].position - x0 - t * v0 - t * t / 2 * g).norm(), 1e-11);
  EXPECT_LT((body_momentum(sim.model, sim.state, 0).angular_momentum - spin0).norm(), 1e-11 * spin0.norm());
  // 2 rad/s at 1 ms: the energy of turning errs by the square of 2e-3, less by its bounded nature
  const double gained = 0.5 * setup.model.bodies[0].mass * ((v0 + t * g).squaredNorm() - v0.squaredNorm());
  EXPECT_NEAR(sim.state.energy.kinetic, kinetic0 + gained, 1e-5 * kinetic0);
  EXPECT_LT(sim.state.energy.balance_error(), 1e-6);
}

// Euler's equations of a free body with three different moments, by a fine Runge-Kutta integration.
TEST(RigidBody, turns_with_second_order) {
  const topple::Setup setup = thrown(BodyModel::rigid);
  const Mat3 inertia = setup.model.bodies[0].inertia, inverse = inertia.inverse();
  Quat exact = Quat::Identity();
  Vec3 omega = setup.starts[0].angular_velocity;
  const double fine = 1e-4;
  const auto rate = [&](const Vec3& w) -> Vec3 { return inverse * (inertia * w).cross(w); };
  for (int i = 0; i < 10000; ++i) {
    const Vec3 k1 = rate(omega), k2 = rate(omega + fine / 2 * k1), k3 = rate(omega + fine / 2 * k2),
               k4 = rate(omega + fine * k3);
    const Vec3 middle = omega + fine / 2 * k2;
    exact = exact * exp_quaternion(fine * (omega + 4 * middle + omega + fine * k3) / 6);
    omega += fine / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  double error[2];
  for (int k = 0; k < 2; ++k) {
    topple::Setup run = setup;
    run.parameters.time_step = k == 0 ? 0.02 : 0.01;
    Simulation sim = simulate(run);
    ASSERT_TRUE(sim.advance(k == 0 ? 50 : 100));
    error[k] = sim.state.bodies[0].rotation.angularDistance(exact);
  }
  EXPECT_LT(error[0], 0.01);
  EXPECT_NEAR(error[0] / error[1], 4, 0.6);
}

// method.md 6: 0.02 to 0.04 degrees at 1 alpha; those bound the means, single instants after impacts double
// it.
TEST(RigidBody, follows_the_frame_on_soft_contacts) {
  Simulation rigid = simulate(paper_cabinet(BodyModel::rigid, 4 / k_degrees)),
             frame = simulate(paper_cabinet(BodyModel::frame, 4 / k_degrees));
  double squares = 0;
  for (int i = 0; i < 1500; ++i) {
    ASSERT_TRUE(rigid.advance(1) && frame.advance(1));
    squares += std::pow(tilt_of(rigid) - tilt_of(frame), 2);
  }
  EXPECT_LT(std::sqrt(squares / 1500), 0.04);
  EXPECT_LT(rigid.state.energy.balance_error(), 1e-3);
}

// The forces at the end of a step are those of the velocity that they leave, to 1e-5 of the speed; twice that
// where a step has parts. Normal ones only: springs that slipped are shorter in the state.
TEST(ReducedBody, ends_a_step_with_the_contact_forces_of_its_velocity) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic})
    for (const double alpha : {50., 1000.}) {
      topple::Setup setup = paper_cabinet(model, 4 / k_degrees);
      setup.parameters.contact.alpha = alpha * k_g;
      Simulation sim = simulate(setup);
      const Body& body = setup.model.bodies[0];
      for (int i = 0; i < 1500; ++i) {
        ASSERT_TRUE(sim.advance(1));
        const BodyState& s = sim.state.bodies[0];
        double push = 0;
        for (const ContactForce& force :
             contact_forces(sim.model, sim.parameters, sim.state, sim.workspace()))
          push += force.normal;
        const double speed = 1e-3 + s.velocity.norm() + body.reach * s.angular_velocity.norm(),
                     left =
                         setup.parameters.time_step / 2 / body.mass * (push - s.force.z() - body.mass * k_g);
        ASSERT_LT(std::abs(left), 2e-5 * speed) << alpha << ", step " << i;
      }
    }
}

// At rest on stiff contacts: an edge gives way in its middle, so that its ends bear more. A tenth of what
// rigidity misses is left for what one contact's force does at another.
TEST(ElasticBody, gives_way_at_its_contacts_as_the_frame_does) {
  struct Greatest {
    double force = 0, depth = 0;
  };
  const auto greatest = [](BodyModel model) {
    topple::Setup setup = paper_cabinet(model);
    setup.parameters.contact.alpha = 20000 * k_g;
    Simulation sim = simulate(setup);
    Greatest found;
    for (const ContactForce& contact : sim.contacts()) {
      found.force = std::max(found.force, contact.normal);
      found.depth = std::max(found.depth, contact.depth);
    }
    return found;
  };
  const Greatest frame = greatest(BodyModel::frame), elastic = greatest(BodyModel::elastic),
                 rigid = greatest(BodyModel::rigid);
  EXPECT_GT(frame.force, 1.05 * rigid.force);
  EXPECT_NEAR(elastic.force, frame.force, 0.1 * (frame.force - rigid.force));
  EXPECT_NEAR(elastic.depth, frame.depth, 0.1 * (frame.depth - rigid.depth));
}

// The modes that are left out and the step leave less than a tenth of what rigidity does.
TEST(ElasticBody, follows_the_frame_and_knows_its_stresses) {
  topple::Setup setups[] = {paper_cabinet(BodyModel::elastic), paper_cabinet(BodyModel::frame)};
  std::vector<double> tilts[2];
  double stress[2];
  for (int k = 0; k < 2; ++k) {
    setups[k].run.duration = 1.5;
    if (k == 1) setups[k].parameters.time_step = 2.5e-4;
    shake(setups[k], 2.2, 1);
    topple::Run run(setups[k]);
    for (int i = 0; !run.over(); ++i) {
      ASSERT_TRUE(run.advance().ok());
      if (k == 0 || i % 4 == 3) tilts[k].push_back(run.outcome().bodies()[0].tilt * k_degrees);
    }
    stress[k] = run.outcome().bodies()[0].peak_stress;
  }
  ASSERT_EQ(tilts[0].size(), tilts[1].size());
  double squares = 0;
  for (std::size_t i = 0; i < tilts[0].size(); ++i) squares += std::pow(tilts[0][i] - tilts[1][i], 2);
  EXPECT_GT(*std::max_element(tilts[1].begin(), tilts[1].end()), 5);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(tilts[0].size())), 0.02);
  EXPECT_NEAR(stress[0], stress[1], 0.02 * stress[1]);
}

// At rest everything is static: modes and what they leave out together are exact but for small rotations.
TEST(ElasticBody, at_rest_has_the_section_forces_of_the_frame) {
  std::vector<SectionForces> sections[2];
  double greatest = 0, force = 0;
  for (int k = 0; k < 2; ++k) {
    const topple::Setup setup = paper_cabinet(k == 0 ? BodyModel::elastic : BodyModel::frame);
    const topple::Run run(setup);
    ASSERT_TRUE(run.status().ok());
    sections[k] = run.sections();
  }
  for (const SectionForces& f : sections[1]) {
    greatest = std::max(greatest, f.moment.norm());
    force = std::max(force, f.normal.norm());
  }
  ASSERT_GT(greatest, 0.05);
  for (std::size_t e = 0; e < sections[0].size(); ++e) {
    EXPECT_LT((sections[0][e].moment - sections[1][e].moment).norm(), 2e-3 * greatest) << e;
    EXPECT_LT((sections[0][e].normal - sections[1][e].normal).norm(), 2e-3 * force) << e;
  }
}

TEST(ElasticBody, stays_at_rest) {
  const topple::Setup setup = paper_cabinet(BodyModel::elastic);
  Simulation sim = simulate(setup);
  const Vec3 before = sim.state.bodies[0].position;
  ASSERT_TRUE(sim.advance(1000));
  EXPECT_LT((sim.state.bodies[0].position - before).norm(), 1e-9);
  EXPECT_LT(sim.state.energy.kinetic, 1e-15);
}

// Slams in which contacts stick and slip by turns: no step is taken whose forces were not found.
TEST(ElasticBody, explains_its_energy_when_it_falls_flat) {
  for (const double direction : {0., 0.3, 0.7}) {
    SCOPED_TRACE(direction);
    topple::Setup setup = paper_cabinet(BodyModel::elastic, 13 / k_degrees);
    setup.starts[0].angular_velocity = Vec3(direction, 0.2, direction);
    setup.run.settle = false;
    setup.model.planes.push_back({"wall", Vec3(0.9, 0, 0), -Vec3::UnitX(), 0.09});
    Simulation sim = simulate(setup);
    ASSERT_TRUE(sim.advance(2500));
    EXPECT_GT(tilt_of(sim), 20);
    EXPECT_LT(sim.state.energy.balance_error(), 2e-3);  // of second order in the step; frames 1e-3
  }
}

// A mode swings at its frequency whatever the step, and the frame that it places holds its energy.
TEST(ElasticBody, swings_at_the_frequency_of_its_mode) {
  topple::Setup setup = thrown(BodyModel::elastic);
  setup.starts[0].angular_velocity.setZero();
  Simulation sim = simulate(setup);
  const ElasticBasis& basis = *setup.model.bodies[0].elastic;
  const std::vector<Mode> modes = natural_modes(setup.model, 0, 8);
  EXPECT_NEAR(basis.frequency[1], 2 * k_pi * modes[7].frequency, 1e-9 * basis.frequency[1]);
  const double q = 1e-3;
  sim.state.bodies[0].amplitude[1] = q;
  const State bent = placed(sim);
  std::vector<SectionForces> sections;
  section_forces(sim.model, bent, sections);
  double strain = 0;
  for (std::size_t e = 0; e < sections.size(); ++e)
    strain += section_energy(sim.model.elements[e], sections[e]);
  // of large rotations the frame knows the square of theirs, 1e-3 rad
  EXPECT_NEAR(strain, 0.5 * std::pow(basis.frequency[1] * q, 2), 1e-3 * strain);
  ASSERT_TRUE(sim.advance(500));
  EXPECT_NEAR(sim.state.bodies[0].amplitude[1], q * std::cos(basis.frequency[1] * sim.state.time), 1e-9 * q);
}

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
  state.bodies[0].rung = Rung::frame;
  const BodyPose pose = body_pose(sim.model, state, 0);
  const BodyMomentum momentum = body_momentum(sim.model, state, 0);
  return {pose.centre, momentum.velocity, momentum.angular_momentum, pose.rotation};
}

// Whatever its rung, a body has its momentum and its place, and a switch explains what energy it changes.
TEST(Ladder, goes_up_and_down_in_mid_flight) {
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
  EXPECT_EQ(sim.state.bodies[0].rung, Rung::frame);
  EXPECT_LT(sim.state.energy.balance_error(), 1e-5);
}

// In contact too: it goes on as the frame does that never switched, to what the rungs differ by.
TEST(Ladder, goes_up_and_down_in_contact) {
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

TEST(Ladder, begins_with_the_least_that_answers) {
  topple::Setup setup = paper_cabinet(BodyModel::automatic);
  Parameters& p = setup.parameters;
  EXPECT_EQ(base_rung(setup.model, p, 0).rung, Rung::elastic);
  EXPECT_EQ(base_rung(setup.model, p, 0).reason, RungReason::stress);
  p.want_stress = false;
  EXPECT_EQ(base_rung(setup.model, p, 0).rung, Rung::rigid);
  p.contact.alpha *= 400;  // 137 Hz of contact, 159 of the first mode
  EXPECT_EQ(base_rung(setup.model, p, 0).rung, Rung::elastic);
  EXPECT_EQ(base_rung(setup.model, p, 0).reason, RungReason::contact_frequency);
  p.models.clear();
  EXPECT_EQ(base_rung(setup.model, p, 0).rung, Rung::frame);
}

TEST(Ladder, is_elastic_from_half_the_first_frequency_on) {
  topple::Setup setup = paper_cabinet(BodyModel::automatic);
  Parameters& p = setup.parameters;
  p.want_stress = false;
  const double first = 2 * k_pi * natural_modes(setup.model, 0, 7)[6].frequency;
  // of the 40 kg on the contacts of the base, alpha/L each
  const double n = static_cast<double>(setup.model.bodies[0].base_points.size()),
               L = (0.09 + setup.model.contact_points[0].width) / 2;
  for (const double share : {0.999, 1.001}) {
    p.contact.alpha = 40 * std::pow(share * first / 2, 2) * L / n;
    EXPECT_EQ(base_rung(setup.model, p, 0).rung, share < 1 ? Rung::rigid : Rung::elastic) << share;
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
TEST(Ladder, climbs_before_a_section_yields_and_stays) {
  topple::Setup setup = shaken_until_it_yields();
  setup.parameters.contact.restitution = 0.5;
  compute_as(setup, BodyModel::automatic);
  topple::Run run(setup);
  EXPECT_EQ(run.state().bodies[0].rung, Rung::elastic);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const BodyOutcome& o = run.outcome().bodies()[0];
  EXPECT_GT(o.hinges, 0);
  EXPECT_EQ(run.state().bodies[0].rung, Rung::frame);
  ASSERT_GE(o.rung_changes.size(), 2u);
  EXPECT_EQ(o.rung_changes[1].rung, Rung::frame);
  EXPECT_EQ(o.rung_changes[1].reason, RungReason::yield);
  const Event* first_hinge = nullptr;
  for (const Event& event : run.events())
    if (event.kind == Event::Kind::hinge && !first_hinge) first_hinge = &event;
  ASSERT_TRUE(first_hinge);
  EXPECT_LE(o.rung_changes[1].time, first_hinge->time);
  EXPECT_LT(run.state().energy.balance_error(), 0.02);
}

// Integrators are of frames: without one nothing differs, down to the last bit.
TEST(Ladder, adaptive_central_differences_without_a_frame_step_as_without_them) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic}) {
    topple::Setup setup = paper_cabinet(model);
    setup.parameters.adaptive = true;
    shake(setup, 4, 2);
    topple::Run implicit(setup);
    setup.parameters.integrator = Integrator::central_difference;
    topple::Run run(setup);
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(run.advance().ok() && implicit.advance().ok());
    EXPECT_GT(run.time(), 0.1);
    EXPECT_EQ(hash(run.state()), hash(implicit.state()));
    EXPECT_FALSE(run.stable_step());
  }
}

TEST(Ladder, adaptive_central_differences_shorten_their_step_for_a_new_frame) {
  topple::Setup setup = shaken_until_it_yields();
  setup.parameters.integrator = Integrator::central_difference;
  setup.parameters.adaptive = true;
  compute_as(setup, BodyModel::automatic);
  topple::Run run(setup);
  double before = 0;
  while (run.state().bodies[0].rung != Rung::frame) {
    EXPECT_FALSE(run.stable_step());
    before = run.time();
    ASSERT_TRUE(run.advance().ok());
    ASSERT_FALSE(run.over());
  }
  for (int i = 0; i < 100; ++i) {
    EXPECT_NEAR(run.time() - before, 0.9 * run.stable_step().value(), 1e-9 * run.time());
    before = run.time();
    ASSERT_TRUE(run.advance().ok());
  }
  EXPECT_LT(run.state().energy.balance_error(), 1e-3);
}

// Two that meet are frames from before they touch until they are apart and calm again.
TEST(Ladder, is_a_frame_while_another_body_is_near) {
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
  compute_as(setup, BodyModel::rigid);
  topple::Run run(setup);
  EXPECT_EQ(run.state().bodies[0].rung, Rung::rigid);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const auto& changes = run.outcome().bodies()[1].rung_changes;
  ASSERT_FALSE(changes.empty());
  EXPECT_EQ(changes[0].reason, RungReason::near);
  EXPECT_GT(run.outcome().bodies()[1].peak_pinch, 0);
  EXPECT_LT(run.state().energy.balance_error(), 0.01);
  const Vec3 momentum = 40 * (body_momentum(setup.model, run.state(), 0).velocity +
                              body_momentum(setup.model, run.state(), 1).velocity);
  EXPECT_LT((momentum - Vec3(40, 0, 0)).norm(), 1e-6);
}

TEST(Ladder, goes_on_bit_for_bit_from_a_checkpoint) {
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
TEST(Ladder, goes_on_bit_for_bit_in_a_new_workspace_at_every_step) {
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

TEST(Ladder, who_looks_at_an_adaptive_run_changes_nothing) {
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
