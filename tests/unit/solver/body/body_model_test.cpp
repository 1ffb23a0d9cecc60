// Rigid, reduced and elastic bodies beside the frame that they stand for.
#include "solver/body/body_pose.h"
#include "solver/frame/modes.h"
#include "solver/state/sections.h"
#include "unit/solver/body_models.h"

namespace topple::test {
namespace {

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

// 0.02 to 0.04 degrees at 1 alpha were measured; those bound the means, single instants after impacts double
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

// The weight spreads the feet, which friction holds.
TEST(ElasticBody, rests_with_the_friction_of_the_frame) {
  std::vector<ContactForce> contacts[2];
  double greatest = 0;
  for (int k = 0; k < 2; ++k) {
    topple::Setup setup = paper_cabinet(k == 0 ? BodyModel::elastic : BodyModel::frame);
    setup.parameters.contact.alpha = 20000 * k_g;
    const topple::Run run(setup);
    ASSERT_TRUE(run.status().ok());
    contacts[k] = run.contacts();
  }
  const auto friction = [](const ContactForce& contact) {
    return Vec3(contact.force.x(), contact.force.y(), 0);
  };
  for (const ContactForce& contact : contacts[1]) greatest = std::max(greatest, friction(contact).norm());
  EXPECT_GT(greatest, 0.5);
  ASSERT_EQ(contacts[0].size(), contacts[1].size());
  // normal forces differ by as much (gives_way_at_its_contacts_as_the_frame_does)
  for (std::size_t k = 0; k < contacts[0].size(); ++k)
    EXPECT_LT((friction(contacts[0][k]) - friction(contacts[1][k])).norm(), 0.1 * greatest) << k;
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

constexpr double k_stiff = 2e5;  // N, on which blows last about as long as a period of the highest mode

topple::Setup let_go_on_stiff_contacts(BodyModel model) {
  topple::Setup setup = paper_cabinet(model, 3 / k_degrees);
  setup.parameters.contact.alpha = k_stiff;
  setup.parameters.contact.restitution = 0;
  setup.parameters.adaptive = true;
  return setup;
}

/// One rocks against the other, 40 mm beside it.
topple::Setup knocks(BodyModel model) {
  topple::Setup setup = shaken(0.5, -4 / k_degrees);
  CabinetSpec spec = tall_cabinet();
  spec.name = "second";
  spec.at.x() = 0.42;
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.parameters.contact.alpha = k_stiff;
  setup.parameters.adaptive = true;
  compute_as(setup, model);
  return setup;
}

Outcome outcome_of(const topple::Setup& setup) {
  topple::Run run(setup);
  while (!run.over() && run.advance().ok()) {
  }
  EXPECT_TRUE(run.over());
  return run.outcome();
}

// Frames change by 0.6 and 7 % (those that knock) at a tenth of the tolerance.
TEST(Blow, makes_an_elastic_body_a_frame_where_stresses_are_asked_for) {
  for (topple::Setup (*scene)(BodyModel) : {let_go_on_stiff_contacts, knocks}) {
    topple::Setup frames = scene(BodyModel::frame);
    frames.parameters.tolerance /= 10;
    const Outcome automatic = outcome_of(scene(BodyModel::automatic)), truth = outcome_of(frames),
                  elastic = outcome_of(scene(BodyModel::elastic));
    for (std::size_t b = 0; b < truth.bodies().size(); ++b) {
      const double stress = truth.bodies()[b].peak_stress;
      EXPECT_NEAR(automatic.bodies()[b].peak_stress, stress, (scene == knocks ? 0.07 : 0.02) * stress);
      EXPECT_GT(elastic.bodies()[b].peak_stress, 1.2 * stress);
      EXPECT_GT(elastic.bodies()[b].level_changes[0].error_estimate, 0.2);
      EXPECT_LE(automatic.bodies()[b].level_changes[0].error_estimate, 0.01);
    }
    EXPECT_EQ(automatic.bodies()[0].level_changes[1].level, ModelLevel::frame);
    EXPECT_EQ(automatic.bodies()[0].level_changes[1].reason, LevelReason::blow);
  }
}

// A blow of an eighth of the speed raises an eighth, and is as far off: what is allowed goes by the peak. The
// bound of what stands is a few times the stress there is, hence the peak of the frames.
TEST(Blow, counts_as_much_as_it_raises_the_greatest_stress) {
  topple::Setup setup = paper_cabinet(BodyModel::elastic);
  setup.parameters.contact.alpha = k_stiff;
  Simulation sim = simulate(setup);
  BodyState& s = sim.state.bodies[0];
  ReducedBody body(sim.model, 0);
  body.find_contacts(StepInputs(sim.parameters, 0), s, sim.state.stick);
  const ContactLaw& law = sim.parameters.contact;
  const auto error = [&](double speed) { return body.blow_error(law, s, speed, true); };
  const double now = body.stress_bound(s), all = body.blow_error(law, true);
  EXPECT_EQ(error(0), 0);
  EXPECT_EQ(error(10), all);
  const double slow = error(1e-3);
  EXPECT_GT(slow, 0);
  EXPECT_NEAR(error(8e-3), 8 * slow, 1e-9);
  const double raises = slow / all * now;  // Pa, of the slow one
  s.peak_stress = 1.01 * now;
  EXPECT_NEAR(error(1e-3) * 1.01, slow, 1e-9);
  s.peak_stress = now + 1.9 * raises;
  EXPECT_GT(error(1e-3), 0);
  s.peak_stress = now + 2.1 * raises;  // it makes no new peak
  EXPECT_EQ(error(1e-3), 0);
}

// Of a free beam pushed at its end across itself, at rest in its own accelerating axes: M = 4/27 F l at l/3.
TEST(Blow, raises_what_its_force_does_at_rest) {
  constexpr int k_members = 12;
  constexpr double k_length = 3;  // m
  topple::Setup setup;
  setup.model = steel_model();
  FrameSpec spec;
  for (int i = 0; i <= k_members; ++i) spec.nodes.emplace_back(0, 0, k_length * i / k_members);
  for (int i = 0; i < k_members; ++i) spec.members.push_back({{i, i + 1}, 0, 0});
  setup.starts = add_frame(setup.model, spec);
  compute_as(setup, BodyModel::elastic);
  const Section& section = setup.model.sections[0];
  const double exact = 4. / 27 * k_length * section.fibre_y() / section.iz;
  // masses lie at 25 nodes
  EXPECT_NEAR(setup.model.bodies[0].elastic->rest_stress[0], exact, 0.01 * exact);
}

// Found only where a bound says that they may be more than before, they are those of every step.
TEST(ElasticBody, has_the_greatest_stresses_of_all_its_steps) {
  topple::Setup setup = paper_cabinet(BodyModel::elastic);
  shake(setup, 3, 1);
  topple::Run run(setup);
  Outcome all(setup.model, setup.starts);
  int steps = 0;
  while (!run.over()) {
    ASSERT_EQ(run.state().bodies[0].level, ModelLevel::elastic);
    all.observe_stresses(setup.model, 0, run.sections());
    steps += all.bodies()[0].peak_stress > 0.999 * run.outcome().bodies()[0].peak_stress;
    ASSERT_TRUE(run.advance().ok());
  }
  all.observe_stresses(setup.model, 0, run.sections());
  EXPECT_GT(steps, 10);
  EXPECT_EQ(all.bodies()[0].peak_stress, run.outcome().bodies()[0].peak_stress);
  EXPECT_EQ(all.bodies()[0].peak_stress, run.state().bodies[0].peak_stress);
}

// Nor where nothing strikes: what stands, and sways with the floor.
TEST(Blow, makes_no_frame_of_what_is_allowed_its_error) {
  topple::Setup motion = let_go_on_stiff_contacts(BodyModel::automatic), allowed = motion, stands = motion;
  motion.parameters.want_stress = false;
  motion.parameters.accuracy = 1e-6;  // elastic, of which theta^2/2 is less
  allowed.parameters.accuracy = 1;
  stands.starts[0] = paper_cabinet(BodyModel::automatic).starts[0];
  stands.run.settle = true;
  shake(stands, 0.5, 5);
  for (const topple::Setup* setup : {&motion, &allowed, &stands}) {
    const Outcome outcome = outcome_of(*setup);
    const BodyOutcome& o = outcome.bodies()[0];
    ASSERT_EQ(o.level_changes.size(), 1u) << name(o.level_changes[1].reason);
    EXPECT_EQ(o.level_changes[0].level, ModelLevel::elastic);
    EXPECT_EQ(o.level_changes[0].error_estimate > 0.2, setup == &allowed);
  }
}

}  // namespace
}  // namespace topple::test
