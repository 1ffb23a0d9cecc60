// Anchors between two bodies, whatever these are computed as.
#include <array>

#include "solver/body/anchors.h"
#include "solver/reduced/member_coupling.h"
#include "unit/solver/body_models.h"
#include "unit/solver/two_threads.h"

namespace topple::test {
namespace {

constexpr double k_tie_mass = 40, k_tie_stiffness = 2e4, k_tie_speed = 0.2;  // kg, N/m, m/s

// A rigid body among frames takes another method than they do, so that what one step changes in their force
// weighs differently in both: relative to the momentum, at these steps. Elsewhere it is rounding and Newton's
// corrections.
constexpr double k_rounding = 1e-8, k_two_methods = 2e-4;

struct Pair {
  const char* name;
  BodyModel first, second;
  double kept = k_rounding;
};
const Pair k_pairs[] = {{"rigid", BodyModel::rigid, BodyModel::rigid},
                        {"elastic", BodyModel::elastic, BodyModel::elastic},
                        {"rigid and elastic", BodyModel::rigid, BodyModel::elastic},
                        {"frame", BodyModel::frame, BodyModel::frame},
                        {"frame and rigid", BodyModel::frame, BodyModel::rigid, k_two_methods},
                        {"frame and elastic", BodyModel::frame, BodyModel::elastic}};

/// Two cabinets 1 m apart along x without weight or floor, tied between two points of theirs.
topple::Setup apart(const Pair& pair, const Vec3& from, const Vec3& to, Anchor::Type type) {
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.mass = k_tie_mass;
  for (int k = 0; k < 2; ++k) {
    spec.name = copy_name("cabinet", k);
    spec.at.x() = k * (spec.size.x() + 1);
    setup.starts.push_back(add_cabinet(setup.model, spec));
  }
  compute_as(setup, BodyModel::rigid);
  setup.parameters.models = {pair.first, pair.second};
  setup.parameters.gravity.setZero();
  setup.parameters.time_step = 1e-3;
  setup.run.settle = false;
  setup.run.duration = 1;
  const Model& model = setup.model;
  const auto end_at = [&](int body, const Vec3& point) {
    const Body& of = model.bodies[body];
    int nearest = of.first_node;
    for (int i = nearest; i < of.first_node + of.node_count; ++i)
      if ((model.node_position[i] - point).norm() < (model.node_position[nearest] - point).norm())
        nearest = i;
    return AnchorEnd{body, nearest, point - model.node_position[nearest]};
  };
  const Vec3 at = model.bodies[0].centre_of_gravity + from, other = model.bodies[1].centre_of_gravity + to;
  const AnchorEnd own = end_at(0, at);
  Anchor a;
  a.name = "tie";
  a.body = 0, a.node = own.node, a.arm = own.arm;
  a.to = other;
  a.other = end_at(1, other);
  a.type = type;
  a.stiffness = k_tie_stiffness;
  a.length = (at - other).norm();
  setup.model.anchors.push_back(a);
  setup.parameters.anchors = {true};
  return setup;
}

Vec3 momentum(const Simulation& sim) {
  Vec3 sum = Vec3::Zero();
  for (int b = 0; b < 2; ++b)
    sum += sim.model.bodies[b].mass * body_momentum(sim.model, sim.state, b).velocity;
  return sum;
}

double apart(const Simulation& sim) {
  return (body_pose(sim.model, sim.state, 1).centre - body_pose(sim.model, sim.state, 0).centre).x();
}

// Through both centres of gravity: the distance swings as k (1/m + 1/m) says, the common centre goes on. The
// cabinets give by their own bending, 2 % of the anchor's where the points hang on single nodes; a rigid one
// does not.
TEST(Tie, two_bodies_swing_as_their_reduced_mass_and_the_sum_of_their_momenta_stays) {
  for (const Pair& pair : k_pairs) {
    SCOPED_TRACE(pair.name);
    topple::Setup setup = apart(pair, Vec3::Zero(), Vec3::Zero(), Anchor::Type::bracket);
    setup.starts[0].velocity = Vec3(-k_tie_speed, 0, 0);
    Simulation sim = simulate(setup);
    const double before = apart(sim), omega = std::sqrt(2 * k_tie_stiffness / k_tie_mass);
    const bool stiff = pair.first == BodyModel::rigid && pair.second == BodyModel::rigid;
    for (int i = 0; i < 5; ++i) {
      ASSERT_TRUE(sim.advance(30));
      EXPECT_NEAR(apart(sim) - before, k_tie_speed / omega * std::sin(omega * sim.state.time),
                  (stiff ? 1e-3 : 0.05) * k_tie_speed / omega);
      EXPECT_LT((momentum(sim) + Vec3(k_tie_mass * k_tie_speed, 0, 0)).norm(),
                pair.kept * k_tie_mass * k_tie_speed);
      const AnchorForce now = anchor_forces(sim.model, sim.state)[0];
      EXPECT_NEAR(
          now.tension,
          k_tie_stiffness *
              ((anchor_point(sim.model, sim.state, 0).at - anchor_target(sim.model, sim.state, 0).at).norm() -
               setup.model.anchors[0].length),
          1e-9 * k_tie_stiffness);
    }
    EXPECT_LT(sim.state.energy.balance_error(), 1e-4);
  }
}

// Thrown, tied at corners: all of it moves, and no momentum comes or goes.
TEST(Tie, momentum_stays_while_both_turn) {
  for (const Pair& pair : k_pairs) {
    SCOPED_TRACE(pair.name);
    topple::Setup setup = apart(pair, Vec3(0.19, 0.44, 0.7), Vec3(-0.19, 0.4, -0.9), Anchor::Type::bracket);
    setup.starts[0].velocity = Vec3(0.3, -0.2, 0.1);
    setup.starts[1].angular_velocity = Vec3(0.5, 0.2, -0.3);
    Simulation sim = simulate(setup);
    const Vec3 before = momentum(sim);
    ASSERT_TRUE(sim.advance(80));
    EXPECT_LT((momentum(sim) - before).norm(), pair.kept * before.norm());
    EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
  }
}

// One point of both: a pin lets them turn about it and holds it together in all directions.
TEST(Tie, a_pin_holds_in_all_directions) {
  for (const Pair& pair : {k_pairs[0], k_pairs[4]}) {
    SCOPED_TRACE(pair.name);
    topple::Setup setup = apart(pair, Vec3(0.69, 0, 0), Vec3(-0.69, 0, 0), Anchor::Type::bracket);
    EXPECT_LT(setup.model.anchors[0].length, 1e-12);
    setup.model.anchors[0].length = 0;
    setup.model.anchors[0].stiffness = 1e6;
    setup.starts[0].velocity = Vec3(0, 0, 0.3);
    Simulation sim = simulate(setup);
    const Vec3 before = momentum(sim);
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(sim.advance(15));
      EXPECT_LT((anchor_point(sim.model, sim.state, 0).at - anchor_target(sim.model, sim.state, 0).at).norm(),
                0.3 * std::sqrt(k_tie_mass / 1e6));
    }
    EXPECT_LT((momentum(sim) - before).norm(), pair.kept * before.norm());
    // work of a vibration of some substeps a period, by a quadrature of third order
    EXPECT_LT(sim.state.energy.balance_error(), 1e-2);
  }
}

TEST(Tie, what_it_breaks_at_lets_both_go) {
  for (const Pair& pair : k_pairs) {
    SCOPED_TRACE(pair.name);
    topple::Setup setup = apart(pair, Vec3::Zero(), Vec3::Zero(), Anchor::Type::strap);
    setup.starts[0].velocity = Vec3(-k_tie_speed, 0, 0);
    const double peak = k_tie_speed * std::sqrt(k_tie_stiffness * k_tie_mass / 2);
    setup.model.anchors[0].strength = peak / 2;
    Simulation sim = simulate(setup);
    ASSERT_TRUE(sim.advance(100));
    EXPECT_EQ(sim.state.anchors[0].hold, AnchorHold::broken);
    const double apart_speed =
        (body_momentum(sim.model, sim.state, 1).velocity - body_momentum(sim.model, sim.state, 0).velocity)
            .x();
    // half of the greatest force is a quarter of the energy of their motion; it is found to a step's stretch
    EXPECT_NEAR(apart_speed, k_tie_speed * std::sqrt(0.75), 0.02 * k_tie_speed);
    EXPECT_NEAR(sim.state.energy.released, k_tie_mass / 4 * k_tie_speed * k_tie_speed / 4,
                0.05 * k_tie_mass / 16 * k_tie_speed * k_tie_speed);
    EXPECT_LT((momentum(sim) + Vec3(k_tie_mass * k_tie_speed, 0, 0)).norm(),
              pair.kept * k_tie_mass * k_tie_speed);
    EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
  }
}

// Taken away and put in place while it runs; the two steps' parts are others each time.
TEST(Tie, is_switched_while_it_runs) {
  for (const Pair& pair : k_pairs) {
    SCOPED_TRACE(pair.name);
    topple::Setup setup = apart(pair, Vec3::Zero(), Vec3::Zero(), Anchor::Type::bracket);
    setup.starts[0].velocity = Vec3(-k_tie_speed, 0, 0);
    setup.parameters.anchors = {false};
    Simulation sim = simulate(setup);
    ASSERT_TRUE(sim.advance(20));
    EXPECT_NEAR(body_momentum(sim.model, sim.state, 1).velocity.norm(), 0, 1e-12);
    sim.parameters.anchors = {true};
    ASSERT_TRUE(sim.advance(1));
    const double before = apart(sim), omega = std::sqrt(2 * k_tie_stiffness / k_tie_mass),
                 start = sim.state.time;
    ASSERT_TRUE(sim.advance(50));
    const double after = omega * (sim.state.time - start);
    EXPECT_NEAR(apart(sim) - before, k_tie_speed / omega * std::sin(after), 0.05 * k_tie_speed / omega);
    sim.parameters.anchors = {false};
    ASSERT_TRUE(sim.advance(20));
    EXPECT_LT((momentum(sim) + Vec3(k_tie_mass * k_tie_speed, 0, 0)).norm(),
              pair.kept * k_tie_mass * k_tie_speed);
    EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
  }
}

TEST(Tie, a_checkpoint_continues_to_the_bit) {
  for (const Pair& pair : k_pairs) {
    SCOPED_TRACE(pair.name);
    topple::Setup setup = apart(pair, Vec3(0.19, 0.44, 0.7), Vec3(-0.19, 0.4, -0.9), Anchor::Type::bracket);
    setup.starts[0].velocity = Vec3(0.3, -0.2, 0.1);
    topple::Run run(setup);
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(run.advance().ok());
    topple::Run other(setup, unpack(setup.model, pack(run.state())), run.parameters());
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(run.advance().ok());
      ASSERT_TRUE(other.advance().ok());
      ASSERT_EQ(hash(run.state()), hash(other.state())) << i;
    }
  }
}

// A third body beside the tied ones, so that there are two parts to step in parallel.
TEST(Tie, threads_change_no_bit) {
  for (const Pair& pair : k_pairs) {
    const auto hash_with = [&](int workers) {
      topple::Setup setup = apart(pair, Vec3(0.19, 0.44, 0.7), Vec3(-0.19, 0.4, -0.9), Anchor::Type::bracket);
      CabinetSpec spec = tall_cabinet();
      spec.name = "other";
      spec.at = Vec3(0, 3, 0);
      setup.starts.push_back(add_cabinet(setup.model, spec));
      setup.model.bodies[2].elastic = elastic_basis(setup.model, 2);
      setup.parameters.models.push_back(pair.second);
      for (BodyStart& start : setup.starts) start.velocity = Vec3(0.3, -0.2, 0.1);
      setup.starts[0].angular_velocity = Vec3(0.5, 0.2, -0.3);
      topple::Run run(setup);
      share(run, workers);
      for (int i = 0; i < 60; ++i) EXPECT_TRUE(run.advance().ok());
      return hash(run.state());
    };
    EXPECT_EQ(hash_with(1), hash_with(2)) << pair.name;
  }
}

// Forces on both bodies are the gradient of the anchor's energy, and the blocks those of the forces.
TEST(Tie, blocks_are_the_derivatives_of_the_loads) {
  topple::Setup setup =
      apart(k_pairs[2], Vec3(0.19, 0.44, 0.7), Vec3(-0.19, 0.4, -0.9), Anchor::Type::bracket);
  setup.model.anchors[0].length *= 0.9;
  const State start = start_state(setup.model, setup.starts);
  std::vector<BodyState> bodies = start.bodies;
  for (int b = 0; b < 2; ++b) {
    bodies[b].level = b == 0 ? ModelLevel::rigid : ModelLevel::elastic;
    bodies[b].position = setup.model.bodies[b].centre_of_gravity;
    bodies[b].rotation = Quat(1, 0.02, -0.03, 0.01).normalized();
    bodies[b].amplitude.setZero();
    if (b == 1) bodies[b].amplitude[2] = 1e-3;
  }
  MemberCoupling coupling(setup.model, {0, 1}, {}, bodies);
  coupling.ties().remember(start.anchors);
  const auto loads = [&] {
    for (int b = 0; b < 2; ++b) coupling.place(b, bodies[b]);
    return coupling.loads({}, {});
  };
  const auto number = [](const BodyVelocity& of, int k) {
    const double all[6] = {of.linear.x, of.linear.y, of.linear.z, of.angular.x, of.angular.y, of.angular.z};
    return k < 6 ? all[k] : of.rate[k - 6];
  };
  loads();
  std::array<std::array<Eigen::MatrixXd, 2>, 2> block;
  for (auto& row : block)
    for (auto& one : row)
      one = Eigen::MatrixXd::Zero(6 * MemberCoupling::k_most_groups, 6 * MemberCoupling::k_most_groups);
  coupling.each_block(setup.parameters.contact, {}, {}, 0,
                      [&](int a, int i, int b, int j, const Mat6& part, const Mat6&) {
                        block[a][b].block<6, 6>(6 * i, 6 * j) += part;
                      });
  constexpr double k_step = 1e-6;
  for (int b = 0; b < 2; ++b)
    for (int k = 0; k < 6 + (b == 0 ? 0 : 4); ++k) {
      std::array<std::vector<BodyVelocity>, 2> moved;
      const BodyState kept = bodies[b];
      for (const int side : {0, 1}) {
        const double h = side == 0 ? -k_step : k_step;
        BodyState& s = bodies[b];
        s = kept;
        Vec3 turn = Vec3::Zero();
        if (k < 3)
          s.position[k] += h;
        else if (k < 6)
          turn[k - 3] = h, s.rotation = exp_quaternion(turn) * kept.rotation;
        else
          s.amplitude[k - 6] += h;
        moved[side] = loads();
      }
      bodies[b] = kept;
      for (int a = 0; a < 2; ++a)
        for (int i = 0; i < 6 + (a == 0 ? 0 : 4); ++i)
          EXPECT_NEAR(-(number(moved[1][a], i) - number(moved[0][a], i)) / (2 * k_step), block[a][b](i, k),
                      1e-5 * k_tie_stiffness)
              << a << i << b << k;
    }
}

}  // namespace
}  // namespace topple::test
