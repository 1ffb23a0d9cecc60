// Rigid and elastic bodies that touch each other, and floors and walls made of members.
#include <algorithm>
#include <functional>
#include <numeric>

#include "solver/frame/body_system.h"
#include "solver/reduced/member_coupling.h"
#include "unit/solver/body_models.h"

namespace topple::test {
namespace {

/// Cabinets in a row along x, `gap` (m) between their surfaces, on a floor.
topple::Setup row(int count, double gap, BodyModel model, double cg_height = 1.05) {
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.cg_height = cg_height;
  for (int k = 0; k < count; ++k) {
    spec.name = copy_name("cabinet", k);
    spec.at.x() = k * (spec.size.x() + 0.03 + gap);
    setup.starts.push_back(add_cabinet(setup.model, spec));
  }
  setup.model.planes.push_back(ground());
  setup.parameters.adaptive = true;
  setup.parameters.contact.alpha = 500 * k_g;
  compute_as(setup, model);
  return setup;
}

/// Without weight or floor.
void free_of_all(topple::Setup& setup) {
  setup.model.planes.clear();
  setup.parameters.gravity.setZero();
  setup.run.settle = false;
  setup.run.duration = 0.5;
}

struct Momentum {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

Momentum momentum(const Model& model, const State& state) {
  Momentum sum;
  const auto add = [&](double mass, const Mat3& inertia, const Vec3& x, const Vec3& v, const Quat& q,
                       const Vec3& omega) {
    sum.linear += mass * v;
    sum.angular += mass * x.cross(v) + q * (inertia * omega);
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyState& s = state.bodies[b];
    const Body& body = model.bodies[b];
    if (s.level != ModelLevel::frame) {
      add(body.mass, body.inertia, s.position, s.velocity, s.rotation, s.angular_velocity);
      continue;
    }
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      add(model.node_mass[i], model.node_inertia[i], state.position[i], state.velocity[i], state.rotation[i],
          state.angular_velocity[i]);
  }
  return sum;
}

// Forces on the ends of members and their derivatives, against the power and differences of the loads.
TEST(Island, forces_between_members_are_carried_to_the_bodies_by_their_own_motion) {
  std::mt19937 rng(7);
  for (const auto& [first, second] :
       {std::pair(ModelLevel::rigid, ModelLevel::rigid), std::pair(ModelLevel::rigid, ModelLevel::elastic),
        std::pair(ModelLevel::elastic, ModelLevel::elastic)}) {
    topple::Setup setup = row(2, -0.01, BodyModel::elastic);
    setup.run.settle = false;
    const Model& model = setup.model;
    const Simulation sim = simulate(setup);
    std::vector<BodyState> bodies = sim.state.bodies;
    for (std::size_t b = 0; b < 2; ++b) {
      BodyState& s = bodies[b];
      s.level = b == 0 ? first : second;
      s.velocity = random_vector(rng);
      s.angular_velocity = random_vector(rng);
      s.rotation = Quat(1, 0.002, -0.003, 0.001).normalized();
      if (s.level == ModelLevel::rigid) continue;
      for (int k = 0; k < k_modes; ++k) {
        s.amplitude[k] = 1e-4 * random_vector(rng).x();
        s.rate[k] = 0.1 * random_vector(rng).x();
      }
    }
    NearSearch search(model);
    const std::vector<ElementPair> near = search.find(start_state(model, setup.starts).position, 0.05);
    MemberCoupling coupling(model, {0, 1}, near, bodies);
    ContactLaw law = setup.parameters.contact;
    law.friction = 10;  // sticks
    const auto velocity = [&](int b) {
      const BodyState& s = bodies[b];
      return BodyVelocity{packed(s.velocity), packed(Vec3(s.rotation * s.angular_velocity)), s.rate};
    };
    const auto unknown = [](BodyVelocity& u, int k) -> double& {
      double* const of[6] = {&u.linear.x, &u.linear.y, &u.linear.z, &u.angular.x, &u.angular.y, &u.angular.z};
      return k < 6 ? *of[k] : u.rate[k - 6];
    };
    MemberContacts contacts;
    const auto loads = [&](std::array<BodyVelocity, 2> u) {
      for (int b = 0; b < 2; ++b)
        coupling.place(b, bodies[b], rotation_matrix(packed(bodies[b].rotation)), u[b]);
      const std::vector<Vec3> start = coupling.position();
      for (MemberPair& pair : coupling.pairs()) pair.start = gather(pair, start);
      find_member_contacts(law, coupling.pairs(), coupling.position(), coupling.velocity(), start, contacts);
      return coupling.loads(contacts, coupling.pairs());
    };
    const std::array<BodyVelocity, 2> at{velocity(0), velocity(1)};
    const std::vector<BodyVelocity> acting = loads(at);
    ASSERT_FALSE(contacts.touches.empty());
    double power = 0, expected = 0;
    for (int b = 0; b < 2; ++b) {
      BodyVelocity u = at[b], f = acting[b];
      for (int k = 0; k < 6 + coupling.modes(b); ++k) power += unknown(u, k) * unknown(f, k);
    }
    for (const MemberTouch& touch : contacts.touches)
      expected += touch.out.force.dot(relative(touch, coupling.pairs()[touch.pair], coupling.velocity()));
    for (const MemberBlend& blend : contacts.blends)
      for (int k = 0; k < coupling.pairs()[blend.pair].nodes(); ++k)
        expected -= blend.slope * blend.surplus *
                    blend.by_sine[k].dot(coupling.velocity()[coupling.pairs()[blend.pair].node[k]]);
    EXPECT_NEAR(power, expected, 1e-9 * std::abs(expected));

    // -d(load)/d(u): what the factor of velocities adds to the tangent
    constexpr int n = 6 + k_modes;
    Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    for (const double factor : {0., 1.})
      coupling.each_block(law, contacts, coupling.pairs(), factor,
                          [&](int a, int i, int b, int j, const Mat6& block, const Mat6&) {
                            tangent.block<6, 6>(n * a + 6 * i, n * b + 6 * j) +=
                                (factor > 0 ? 1 : -1) * block;
                          });
    constexpr double k_step = 1e-6;
    for (int b = 0; b < 2; ++b)
      for (int k = 0; k < 6 + coupling.modes(b); ++k) {
        std::array<std::vector<BodyVelocity>, 2> moved;
        for (const int side : {0, 1}) {
          std::array<BodyVelocity, 2> u = at;
          unknown(u[b], k) += side == 0 ? -k_step : k_step;
          moved[side] = loads(u);
        }
        for (int a = 0; a < 2; ++a)
          for (int i = 0; i < 6 + coupling.modes(a); ++i) {
            const double slope = (unknown(moved[1][a], i) - unknown(moved[0][a], i)) / (2 * k_step);
            EXPECT_NEAR(-slope, tangent(n * a + i, n * b + k), 1e-5 * tangent.cwiseAbs().maxCoeff())
                << a << i << b << k;
          }
      }
  }
}

// A rigid body among frames: forces of contacts and of an anchor as differences of what acts at poses nearby.
TEST(Island, tangent_of_a_rigid_body_among_frames_is_the_derivative_of_its_forces) {
  topple::Setup setup = row(2, -0.01, BodyModel::frame);
  Model& model = setup.model;
  model.anchors.push_back({.name = "strap",
                           .body = 1,
                           .node = model.bodies[1].first_node + 5,
                           .arm = Vec3(0.02, 0.01, -0.03),
                           .to = Vec3(2, 0.5, 1),
                           .other = {},
                           .type = Anchor::Type::strap,
                           .stiffness = 1e5,
                           .length = 1});
  const State state = start_state(model, setup.starts);
  NearSearch search(model);
  BodySystem system(model, {0, 1}, search.find(state.position, 0.05), {1});
  const int own = system.rigid[0].own;
  BodyMotion at;
  system.load(state, at);
  std::mt19937 rng(5);
  // turned, so that no members are nearly parallel: of these the tangent leaves out a part
  at.rotation[own] = exp_quaternion(Vec3(0.3, 0.2, 0.4));
  for (int i = 0; i < model.bodies[0].node_count; ++i) at.position[i] += random_vector(rng, 1e-5);
  Parameters parameters = setup.parameters;
  parameters.contact.restitution = 1;
  parameters.contact.friction = 10;  // sticks
  const StepInputs now(parameters, 0);
  const Vec3 centre = model.bodies[1].centre_of_gravity;
  for (double away = 0.3; system.contacts.members.touches.empty() && away > 0; away -= 1e-3) {
    at.position[own] = centre + Vec3(away, 0, -0.05);
    system.place_carried(at);
    system.load_memory(state, at);
    system.evaluate(parameters, now, at, state.stick, at.position);
  }
  const auto moved = [&](const std::vector<double>& by, double share) {
    BodyMotion motion = at;
    for (int i = 0; i < system.count; ++i) {
      const Vec3 spin = share * Vec3(&by[6 * i + 3]);
      motion.position[i] += share * Vec3(&by[6 * i]);
      motion.rotation[i] = (exp_quaternion(spin) * motion.rotation[i]).normalized();
    }
    system.place_carried(motion);
    system.evaluate(parameters, now, motion, state.stick, at.position);
    std::vector<double> acting(6 * system.count, 0.);
    for (int i = 0; i < system.count; ++i)
      for (int k = 0; k < 3 && system.fixed[i] == 0; ++k) {
        acting[6 * i + k] = system.force[i][k];
        acting[6 * i + 3 + k] = system.moment[i][k];
      }
    return acting;
  };
  std::vector<double> by(6 * system.count, 0.);
  for (int i = 0; i < system.count; ++i)
    for (int k = 0; k < 6 && system.fixed[i] == 0; ++k) by[6 * i + k] = random_vector(rng)[0];
  constexpr double k_step = 1e-6;
  const std::vector<double> above = moved(by, k_step), below = moved(by, -k_step);
  ASSERT_FALSE(system.contacts.members.touches.empty());
  ASSERT_FALSE(system.contacts.planes.empty());
  // (K + c) x = -(difference) + c by  where K is the tangent: x = by
  const double c = 1e6;
  system.lu.set_zero();
  system.evaluate_with_tangent(parameters, now, at, state.stick, at.position, 0);
  for (int i = 0; i < system.count; ++i) {
    system.lu.add(i, i, Mat6(c * Mat6::Identity()));
    for (int k = 0; k < 6 && system.fixed[i] != 0; ++k) system.lu.fix(i, k);
  }
  ASSERT_EQ(system.lu.factor(), -1);
  std::vector<double> x(by.size());
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = c * by[k] - (above[k] - below[k]) / (2 * k_step);
  system.lu.solve(x.data());
  // third derivatives of stiff members over the step, and rounding of their forces
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(x[6 * own + k], by[6 * own + k], 1e-5) << k;
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], by[k], 1e-4) << k;
}

TEST(Island, bodies_that_knock_keep_momentum_and_energy) {
  for (const auto& [first, second] :
       {std::pair(BodyModel::rigid, BodyModel::rigid), std::pair(BodyModel::elastic, BodyModel::rigid),
        std::pair(BodyModel::elastic, BodyModel::elastic), std::pair(BodyModel::frame, BodyModel::rigid),
        std::pair(BodyModel::rigid, BodyModel::frame)})
    for (const ContactLawKind kind : {ContactLawKind::coulomb, ContactLawKind::paper}) {
      topple::Setup setup = row(2, 0.08, BodyModel::elastic);
      free_of_all(setup);
      setup.parameters.models = {first, second};
      setup.parameters.contact.kind = kind;
      setup.starts[0].velocity = Vec3(1, 0.2, 0.1);
      setup.starts[0].angular_velocity = Vec3(0.2, 0.5, -0.3);
      topple::Run run(setup);
      const Momentum before = momentum(setup.model, run.state());
      while (!run.over()) {
        run.advance();
        ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
      }
      const State& state = run.state();
      EXPECT_GT(run.outcome().bodies()[1].peak_pinch, 0);
      EXPECT_EQ(state.bodies[0].level == ModelLevel::frame, first == BodyModel::frame);
      EXPECT_EQ(state.bodies[1].level == ModelLevel::frame, second == BodyModel::frame);
      // forces are equal and opposite at every iteration of Newton; a frame's method weighs those at the ends
      // of a step otherwise than a rigid body's, to the local error of a step
      const bool mixed = (first == BodyModel::frame) != (second == BodyModel::frame);
      const Momentum after = momentum(setup.model, state);
      EXPECT_LT((after.linear - before.linear).norm(), (mixed ? 1e-4 : 1e-9) * before.linear.norm());
      // moments to the error of the method, which keeps no product of unknowns: some tens of substeps, each
      // of which may leave 0.1 of the tolerance of 1e-3
      EXPECT_LT((after.angular - before.angular).norm(), 3e-3 * before.angular.norm());
      EXPECT_LT(state.energy.balance_error(), 1e-3);
    }
}

// Two of equal mass that meet flat at v = 1 m/s. Of e = 0 the smoothing eps of the loss leaves them, who part
// on P (1 - v/sqrt(v^2 + eps^2)) = P eps^2/(2 v^2) after all but a half of their energy was lost closing,
//   v' = (eps^2 v^2/2)^(1/4).
TEST(Island, restitution_between_bodies_is_that_of_the_law) {
  constexpr double k_smoothing = 1e-3;
  for (const double tolerance : {1e-3, 1e-4})
    for (const double e : {0., 0.5, 1.}) {
      topple::Setup setup = row(2, 0.08, BodyModel::rigid, 0.895);
      free_of_all(setup);
      setup.parameters.tolerance = tolerance;
      setup.parameters.contact.restitution = e;
      setup.parameters.contact.normal_speed = k_smoothing;
      setup.starts[0].velocity = Vec3::UnitX();
      topple::Run run(setup);
      while (!run.over()) ASSERT_TRUE(run.advance().ok());
      const double apart = run.state().bodies[1].velocity.x() - run.state().bodies[0].velocity.x();
      const double expected = e > 0 ? e : std::pow(k_smoothing * k_smoothing / 2, 0.25);
      // substeps: what the method takes out of a contact that is resolved to 1e-4 of the speed; impulses: a
      // half of theta w a radian, at w below 0.5 and theta below 0.02, of half a turn
      EXPECT_NEAR(apart, expected, tolerance == 1e-3 ? 0.015 : 0.01) << tolerance;
    }
}

// A stack at rest: each box bears those above it.
TEST(Island, stack_settles_on_what_is_below) {
  for (const auto& [lowest, others] :
       {std::pair(BodyModel::rigid, BodyModel::rigid), std::pair(BodyModel::elastic, BodyModel::elastic),
        std::pair(BodyModel::frame, BodyModel::rigid), std::pair(BodyModel::rigid, BodyModel::frame)}) {
    topple::Setup setup;
    setup.model = steel_model();
    CabinetSpec spec = tall_cabinet();
    spec.size = Vec3(0.5, 0.6, 0.3);
    spec.mass = 8;
    spec.cg_height = 0.15;
    for (int k = 0; k < 3; ++k) {
      spec.name = copy_name("box", k);
      spec.at.z() = 0.33 * k;
      setup.starts.push_back(add_cabinet(setup.model, spec));
    }
    setup.model.planes.push_back(ground());
    setup.parameters.contact.alpha = 500 * k_g;
    compute_as(setup, others);
    setup.parameters.models[0] = lowest;
    Simulation sim = simulate(setup);
    double floor = 0;
    for (const ContactForce& force : sim.contacts()) floor += force.force.z();
    std::array<double, 3> on{};  // from below, N
    for (const MemberForce& force : member_forces(sim.workspace())) {
      const int a = body_of(sim.model, force.elements.a), b = body_of(sim.model, force.elements.b);
      EXPECT_EQ(std::abs(a - b), 1);
      on[std::max(a, b)] += a > b ? force.force.z() : -force.force.z();
    }
    const double weight = 8 * k_g;
    EXPECT_NEAR(floor, 3 * weight, 1e-7 * weight);
    EXPECT_NEAR(on[1], 2 * weight, 1e-7 * weight);
    EXPECT_NEAR(on[2], weight, 1e-7 * weight);
    // and stays there
    ASSERT_TRUE(sim.advance(50));
    for (const BodyState& s : sim.state.bodies) EXPECT_LT(s.velocity.norm(), 1e-6);
  }
}

// Shaken until they knock each other over: the same bodies, at the same times as frames.
TEST(Island, row_falls_as_frames_do) {
  std::vector<std::vector<BodyOutcome>> outcomes;
  using enum BodyModel;
  for (const std::vector<BodyModel>& models : {std::vector{frame, frame, frame},
                                               {rigid, rigid, rigid},
                                               {elastic, elastic, elastic},
                                               {rigid, frame, rigid}}) {
    topple::Setup setup = row(3, 0.02, models[0]);
    setup.parameters.models = models;
    shake(setup, 4.5, 1);
    setup.run.duration = 4;
    topple::Run run(setup);
    double lost = 0;
    while (!run.over()) {
      run.advance();
      ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
      lost = std::max(lost, run.state().energy.balance_error());
    }
    EXPECT_LT(lost, 1e-3);
    outcomes.push_back(run.outcome().bodies());
  }
  int fallen = 0;
  for (std::size_t b = 0; b < 3; ++b) {
    const std::optional<double> truth = outcomes[0][b].beyond_since;
    fallen += truth ? 1 : 0;
    for (const int which : {1, 2, 3}) {
      const std::optional<double> other = outcomes[which][b].beyond_since;
      ASSERT_EQ(other.has_value(), truth.has_value()) << b;
      EXPECT_NEAR(other.value_or(0), truth.value_or(0), 0.02 * truth.value_or(0)) << b;
    }
  }
  EXPECT_GT(fallen, 0);
}

// Rows that are pushed over: two blows, each resolved to a tenth of the step of 2 ms, and the falls between.
// How a blow ends turns on the instant in a step at which it begins: times scatter by a per cent or two,
// which is what rooms are held to.
TEST(Island, rows_fall_by_impulses_when_they_do_by_substeps) {
  const auto last_falls = [](double tolerance, double speed) {
    topple::Setup setup = row(3, 0.1, BodyModel::rigid);
    setup.parameters.tolerance = tolerance;
    setup.parameters.contact.alpha = 5e4 * k_g;
    setup.run.settle = false;
    setup.run.duration = 1;
    setup.starts[0].velocity = Vec3(speed, 0, 0);
    setup.starts[0].angular_velocity = Vec3(0, speed, 0);
    topple::Run run(setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    const std::optional<double> falls = run.outcome().bodies()[2].beyond_since;
    EXPECT_TRUE(falls.has_value());
    return falls.value_or(0);
  };
  const std::array speeds{2.1, 2.2, 2.3, 2.4, 2.5, 2.6};
  std::vector<double> truth;
  for (const double speed : speeds) truth.push_back(last_falls(1e-5, speed));
  for (const double tolerance : {2e-3, 1e-3}) {
    double squares = 0, mean = 0;
    for (std::size_t k = 0; k < speeds.size(); ++k) {
      const double error = last_falls(tolerance, speeds[k]) / truth[k] - 1;
      squares += error * error / speeds.size();
      mean += error / speeds.size();
    }
    EXPECT_LT(std::sqrt(squares), 0.02) << tolerance;
    EXPECT_LT(std::abs(mean), 0.01) << tolerance;
  }
}

// Each by itself is one of forty sets of bodies that touch: more than are kept. They rock as one, so that
// none meets another; 1e-9 m is what rounding makes of it.
TEST(Island, many_that_are_near_move_as_one) {
  topple::Setup setup = row(40, 0.02, BodyModel::rigid);
  shake(setup, 3, 1);
  setup.run.duration = 1;
  topple::Run run(setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
  const std::vector<BodyState>& bodies = run.state().bodies;
  const auto moved = [&](std::size_t b) -> Vec3 {
    return bodies[b].position - setup.model.bodies[b].centre_of_gravity;
  };
  EXPECT_GT(moved(0).norm(), 0.01);
  for (std::size_t b = 1; b < bodies.size(); ++b)
    EXPECT_LT((moved(b) - moved(0)).norm(), 1e-9) << setup.model.bodies[b].name;
}

// Forces of rows are those that move the bodies: while a cabinet leans on another one, turns and slides, they
// are what its acceleration takes, but for some per cent of its weight. Steps of 2 ms at up to 2 rad/s.
TEST(Island, forces_between_bodies_are_those_that_move_them) {
  topple::Setup setup = row(2, 0.1, BodyModel::rigid);
  setup.parameters.contact.alpha = 5e4 * k_g;
  setup.parameters.contact.restitution = 0.5;
  setup.run.settle = false;
  setup.run.duration = 0.9;
  setup.starts[0].velocity = Vec3(2.2, 0, 0);
  setup.starts[0].angular_velocity = Vec3(0, 2.1, 0);
  topple::Run run(setup);
  struct Step {
    double h;
    std::array<Vec3, 2> way, force;
  };
  std::vector<Step> steps;
  while (!run.over()) {
    const State before = run.state();
    ASSERT_TRUE(run.advance().ok());
    Step step{run.state().time - before.time, {}, {Vec3::Zero(), Vec3::Zero()}};
    for (std::size_t b = 0; b < 2; ++b)
      step.way[b] = run.state().bodies[b].position - before.bodies[b].position;
    for (const ContactForce& f : run.contacts())
      step.force[setup.model.node_body[setup.model.contact_points[f.point].node]] += f.force;
    for (const MemberForce& f : run.member_contacts()) {
      step.force[body_of(setup.model, f.elements.a)] += f.force;
      step.force[body_of(setup.model, f.elements.b)] -= f.force;
    }
    if (before.time > 0.4) steps.push_back(step);
    if (run.member_contacts().empty()) continue;             // each falls alone
    std::array<Vec3, 2> within{Vec3::Zero(), Vec3::Zero()};  // between rows the step's forces act
    const Snapshot at = run.snapshot(before.time + 0.4 * step.h);
    for (const ContactForce& f : at.contacts)
      within[setup.model.node_body[setup.model.contact_points[f.point].node]] += f.force;
    for (const MemberForce& f : at.between_members) {
      within[body_of(setup.model, f.elements.a)] += f.force;
      within[body_of(setup.model, f.elements.b)] -= f.force;
    }
    for (std::size_t b = 0; b < 2; ++b) EXPECT_EQ(within[b], step.force[b]);
  }
  std::vector<double> missing;  // over the weight
  for (std::size_t k = 0; k + 1 < steps.size(); ++k)
    for (std::size_t b = 0; b < 2; ++b) {
      const Step &now = steps[k], &next = steps[k + 1];
      if (!(now.force[b].norm() > 0)) continue;
      const Vec3 acceleration = (next.way[b] / next.h - now.way[b] / now.h) / ((now.h + next.h) / 2);
      const Vec3 needed = setup.model.bodies[b].mass * (acceleration - setup.parameters.gravity);
      missing.push_back((now.force[b] - needed).norm() / (setup.model.bodies[b].mass * k_standard_gravity));
    }
  ASSERT_GT(missing.size(), 100u);
  ranges::sort(missing);
  EXPECT_LT(missing[missing.size() / 2], 0.03);
}

// Loads and energy are those of all touches, each of which is listed, or one at its place stands for it.
TEST(Island, what_members_that_meet_in_a_corner_touch_counts_once) {
  for (const double turn : {0., 1e-3, 0.02}) {
    SCOPED_TRACE(turn);
    topple::Setup setup = row(2, -0.01, BodyModel::rigid);
    setup.run.settle = false;
    std::vector<BodyState> bodies = simulate(setup).state.bodies;
    bodies[1].rotation = Quat(1, turn, 0, 2 * turn).normalized();
    bodies[1].velocity = Vec3(-0.3, 0.1, 0);
    const std::vector<Vec3> positions = start_state(setup.model, setup.starts).position;
    NearSearch search(setup.model);
    MemberCoupling coupling(setup.model, {0, 1}, search.find(positions, 0.05), bodies);
    for (int b = 0; b < 2; ++b) coupling.place(b, bodies[b]);
    coupling.start();
    std::mt19937 rng(3);
    for (MemberPair& pair : coupling.pairs()) pair.stick.fill(Vec3::Zero());
    std::vector<int> all(coupling.pairs().size());
    std::iota(all.begin(), all.end(), 0);
    ContactLaw law = setup.parameters.contact;
    law.friction = 10;  // sticks
    MemberContacts each, merged;
    PairPlaces places;
    const std::span<const MemberPair> pairs = coupling.pairs();
    const auto find = [&] {
      find_member_contacts(law, pairs, coupling.position(), coupling.velocity(), coupling.position(), each);
      find_merged_contacts(law, pairs, all, coupling.position(), coupling.velocity(), coupling.position(),
                           true, places, merged);
    };
    find();
    ASSERT_FALSE(each.touches.empty());
    if (turn < 0.01)  // then most meet along their whole length, at their four ends
      EXPECT_LE(3 * merged.touches.size(), 2 * each.touches.size());
    else
      EXPECT_LT(merged.touches.size(), each.touches.size());
    std::vector<std::pair<int, int>> listed, expected;
    double weight = 0, whole = 0;
    for (const MemberTouch& touch : merged.touches) {
      merged.each_place(touch, [&](int pair, int place) { listed.emplace_back(pair, place); });
      weight += touch.weight;
    }
    for (const MemberTouch& touch : each.touches) {
      expected.emplace_back(touch.pair, touch.place);
      whole += touch.weight;
    }
    ranges::sort(listed);
    ranges::sort(expected);
    EXPECT_EQ(listed, expected);
    EXPECT_NEAR(weight, whole, 1e-12 * whole);
    const double energy = stored_energy(law, each, pairs);
    EXPECT_NEAR(stored_energy(law, merged, pairs), energy, 1e-9 * energy);
    for (MemberPair& pair : coupling.pairs())
      for (Vec3& stick : pair.stick) stick = 1e-4 * random_vector(rng);
    find();
    const std::vector<BodyVelocity> loads = coupling.loads(each, pairs), own = coupling.loads(merged, pairs);
    // of touches of different weights the lighter ones are damped more, and slip earlier when they are alone
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_LT((unpacked(own[b].linear) - unpacked(loads[b].linear)).norm(),
                1e-6 * unpacked(loads[b].linear).norm());
      EXPECT_LT((unpacked(own[b].angular) - unpacked(loads[b].angular)).norm(),
                1e-6 * unpacked(loads[b].angular).norm());
    }
  }
}

// A wall of members holds a body back as one does that is a plane.
TEST(Island, cabinet_leans_against_a_wall_of_members) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic}) {
    topple::Setup setup = row(1, 0, BodyModel::elastic);
    GridSpec wall;
    wall.name = "wall";
    wall.origin = Vec3(0.5, 0, 0);
    wall.along = Vec3::UnitY();
    wall.up = Vec3::UnitZ();
    wall.normal = -Vec3::UnitX();
    wall.from[0] = -1;
    wall.to[0] = 1;
    wall.from[1] = 0;
    wall.to[1] = 2;
    setup.starts.push_back(add_grid(setup.model, wall));
    setup.parameters.models = {model, BodyModel::frame};
    setup.starts[0].velocity = Vec3(0.8, 0, 0);
    setup.starts[0].angular_velocity = Vec3(0, 0.8, 0);
    setup.run.settle = false;
    setup.run.duration = 3;
    topple::Run run(setup);
    double furthest = 0;
    while (!run.over()) {
      run.advance();
      ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
      const BodyState& s = run.state().bodies[0];
      EXPECT_NE(s.level, ModelLevel::frame);
      furthest = std::max(furthest, (s.position + s.rotation * Vec3(0.19, 0, 0.7)).x());
    }
    EXPECT_GT(furthest, 0.45);  // it came there
    EXPECT_LT(furthest, 0.515);
    EXPECT_LT(run.state().energy.balance_error(), 1e-3);
  }
}

TEST(Island, goes_on_bit_for_bit_in_a_new_workspace_at_every_step) {
  for (const auto& [model, last] :
       {std::pair(BodyModel::rigid, BodyModel::rigid), std::pair(BodyModel::elastic, BodyModel::elastic),
        std::pair(BodyModel::rigid, BodyModel::frame)}) {
    topple::Setup setup = row(3, 0.02, model);
    setup.parameters.models.back() = last;
    setup.starts[0].velocity = Vec3(0.6, 0, 0);
    setup.run.settle = false;
    topple::Run run(setup);
    bool touched = false;
    for (int i = 0; i < 400; ++i) {
      topple::Run fresh(setup, unpack(setup.model, pack(run.state())), run.parameters());
      ASSERT_TRUE(run.advance().ok() && fresh.advance().ok());
      ASSERT_EQ(hash(run.state()), hash(fresh.state())) << i;
      touched = touched || !run.state().member_sticks.empty();
    }
    EXPECT_TRUE(touched);
  }
}

// All that can be edited of contacts and bodies, while they knock under a shake: what edits put in is booked.
TEST(Island, edits_while_bodies_knock_are_booked) {
  for (const auto& [model, last] :
       {std::pair(BodyModel::rigid, BodyModel::rigid), std::pair(BodyModel::elastic, BodyModel::elastic),
        std::pair(BodyModel::rigid, BodyModel::frame)}) {
    topple::Setup setup = row(3, 0.005, model);
    setup.parameters.models.back() = last;
    setup.parameters.contact.friction_static = 0.9;
    shake(setup, 3, 2);
    setup.starts[0].velocity = Vec3(0.4, 0, 0);
    setup.run.settle = false;
    setup.run.duration = 2.4;
    topple::Run run(setup);
    const std::pair<double, Edit> edits[] = {
        {0.4, {Edit::Key::alpha, 0, Vec3(2000 * k_g, 0, 0)}},
        {0.8, {Edit::Key::friction, 0, Vec3(0.3, 0, 0)}},
        {1.0, {Edit::Key::restitution, 0, Vec3(0.2, 0, 0)}},
        {1.2, {Edit::Key::q, 0, Vec3(1.5, 0, 0)}},
        {1.6, {Edit::Key::model, 0, Vec3(static_cast<double>(BodyModel::elastic), 0, 0)}},
        {2.0, {Edit::Key::law, 0, Vec3(static_cast<double>(ContactLawKind::paper), 0, 0)}}};
    auto next = std::begin(edits);
    bool touched = false;
    while (!run.over()) {
      if (next != std::end(edits) && run.time() >= next->first) run.edit((next++)->second);
      run.advance();
      ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
      touched = touched || !run.state().member_sticks.empty();
    }
    EXPECT_TRUE(touched);
    EXPECT_EQ(next, std::end(edits));
    EXPECT_LT(run.state().energy.balance_error(), 1e-3);
  }
}

// A bracket at the top of the middle one of three, against which the first one is pushed: as frames pull it.
TEST(Island, bracket_of_a_body_that_another_pushes_holds_what_a_frame_s_does) {
  std::vector<double> pulls;
  for (const auto& [model, middle] :
       {std::pair(BodyModel::frame, BodyModel::frame), std::pair(BodyModel::rigid, BodyModel::rigid),
        std::pair(BodyModel::elastic, BodyModel::elastic), std::pair(BodyModel::frame, BodyModel::rigid)}) {
    topple::Setup setup = row(3, 0.005, model);
    setup.parameters.models[1] = middle;
    const Body& body = setup.model.bodies[1];
    int top = body.first_node;
    for (int i = top; i < body.first_node + body.node_count; ++i)
      if (setup.model.node_position[i].z() > setup.model.node_position[top].z() + 1e-6) top = i;
    const Anchor bracket{.name = "bracket",
                         .body = 1,
                         .node = top,
                         .arm = Vec3::Zero(),
                         .to = setup.model.node_position[top] + Vec3(3, 0, 0),
                         .other = {},
                         .type = Anchor::Type::bracket,
                         .stiffness = 2e4,
                         .length = 3};
    setup.model.anchors.push_back(bracket);
    setup.parameters.anchors = {true};
    setup.starts[0].velocity = Vec3(0.5, 0, 0);
    setup.starts[0].angular_velocity = Vec3(0, 0.5, 0);
    setup.run.settle = false;
    setup.run.duration = 0.3;
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    EXPECT_LT(run.state().energy.balance_error(), 1e-3);
    pulls.push_back(run.outcome().anchors()[0].peak_force);
  }
  for (const double pull : pulls) EXPECT_NEAR(pull, pulls[0], 0.05 * pulls[0]);
}

// A heavy elastic box lies on a rigid one when a frame comes near: what their contacts hold is neither lost
// nor found when the elastic one becomes a frame.
TEST(Island, what_contacts_hold_is_kept_when_a_frame_comes_near) {
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.size = Vec3(0.5, 0.6, 0.3);
  spec.cg_height = 0.15;
  for (const double mass : {20., 200.}) {
    spec.name = mass < 100 ? "lower" : "upper";
    spec.mass = mass;
    setup.starts.push_back(add_cabinet(setup.model, spec));
    spec.at.z() += 0.33;
  }
  spec = tall_cabinet();
  spec.name = "comes";
  spec.at.x() = -0.58;
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.model.planes.push_back(ground());
  setup.parameters.adaptive = true;
  setup.parameters.contact.alpha = 500 * k_g;
  setup.parameters.shakes.clear();
  compute_as(setup, BodyModel::rigid);
  setup.parameters.models[1] = BodyModel::elastic;
  setup.parameters.models[2] = BodyModel::frame;
  setup.starts[2].velocity = Vec3(1, 0, 0);
  setup.run.settle = false;
  setup.run.duration = 0.3;
  topple::Run run(setup);
  double held = 0;  // J, when it becomes one
  while (!run.over()) {
    if (run.state().bodies[1].level == ModelLevel::elastic) held = run.state().energy.contact;
    ASSERT_TRUE(run.advance().ok());
  }
  EXPECT_GT(held, 0.1);
  EXPECT_EQ(run.state().bodies[0].level, ModelLevel::rigid);
  EXPECT_EQ(run.state().bodies[1].level, ModelLevel::frame);
  EXPECT_LT(run.state().energy.balance_error(), 1e-3);
}

// Four islands: whoever advances them.
TEST(Island, threads_do_not_change_a_bit) {
  const auto run_with = [](int workers) {
    topple::Setup setup;
    setup.model = steel_model();
    CabinetSpec spec = tall_cabinet();
    for (int k = 0; k < 8; ++k) {
      spec.name = copy_name("cabinet", k);
      spec.at = Vec3(0.43 * (k % 2), 3 * (k / 2), 0);
      spec.velocity = k % 2 == 0 ? Vec3(0.3 + 0.1 * k, 0, 0) : Vec3::Zero();
      setup.starts.push_back(add_cabinet(setup.model, spec));
    }
    setup.model.planes.push_back(ground());
    setup.run.settle = false;
    compute_as(setup, BodyModel::rigid);
    topple::Run run(setup);
    if (workers > 1)
      run.share({workers, [](int count, const std::function<void(int, int)>& f) {
                   for (int task = count - 1; task >= 0; --task) f(task, task % 2);
                 }});
    for (int i = 0; i < 300; ++i) EXPECT_TRUE(run.advance().ok());
    EXPECT_FALSE(run.state().member_sticks.empty());
    return hash(run.state());
  };
  EXPECT_EQ(run_with(1), run_with(2));
}

}  // namespace
}  // namespace topple::test
