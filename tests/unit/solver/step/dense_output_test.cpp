// The motion within a step, and what acts there.
#include "solver/step/dense_output.h"

#include <map>

#include "solver/run/run.h"
#include "unit/solver/body_models.h"

namespace topple::test {
namespace {

constexpr double k_fine = 1e-4;  // s

// A rigid cabinet in free flight every k_fine: steps of it, by their number.
std::map<int, State> flight(BodyModel model, int steps) {
  Simulation sim = simulate(thrown(model));
  sim.parameters.time_step = k_fine;
  std::map<int, State> out{{0, placed(sim)}};
  for (int i = 1; i <= steps; ++i) {
    EXPECT_TRUE(sim.advance(1));
    out[i] = placed(sim);
  }
  return out;
}

// As long steps would end in these states: what half a step does to the errors within it.
TEST(DenseOutput, is_of_third_order_in_place_and_velocity) {
  const topple::Setup setup = thrown(BodyModel::rigid);
  std::map<int, State> exact = flight(BodyModel::rigid, 800);
  double turn_before = 0, spin_before = 0;
  for (const int n : {800, 400, 200}) {
    double turn = 0, spin = 0;
    for (int i = n / 8; i < n; i += n / 8) {
      State at;
      state_between(setup.model, exact[0], exact[n], exact[i].time, at);
      place_nodes(setup.model, at);
      const BodyState &s = at.bodies[0], &is = exact[i].bodies[0];
      turn = std::max(turn, s.rotation.angularDistance(is.rotation));
      spin = std::max(spin, (s.angular_velocity - is.angular_velocity).norm());
      // a parabola
      EXPECT_LT((s.position - is.position).norm(), 1e-12);
      EXPECT_LT((s.velocity - is.velocity).norm(), 1e-11);
      EXPECT_LT((at.position[3] - (s.position + s.rotation * (setup.model.node_position[3] -
                                                              setup.model.bodies[0].centre_of_gravity)))
                    .norm(),
                1e-12);
    }
    if (turn_before > 0) {  // 2^4 and 2^3, with terms of the next order
      EXPECT_NEAR(turn_before / turn, 16, 3);
      EXPECT_NEAR(spin_before / spin, 8, 1.5);
    }
    turn_before = turn;
    spin_before = spin;
  }
  EXPECT_LT(turn_before, 1e-6);
}

TEST(DenseOutput, meets_the_ends_of_the_step) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic, BodyModel::frame}) {
    const topple::Setup setup = thrown(model);
    std::map<int, State> exact = flight(model, 20);
    for (const int i : {0, 20}) {
      State at;
      state_between(setup.model, exact[0], exact[20], exact[i].time, at);
      place_nodes(setup.model, at);
      for (int k = 0; k < setup.model.node_total(); ++k) {
        EXPECT_LT((at.position[k] - exact[i].position[k]).norm(), 1e-12);
        EXPECT_LT((at.velocity[k] - exact[i].velocity[k]).norm(), 1e-10);
        EXPECT_LT(at.rotation[k].angularDistance(exact[i].rotation[k]), 1e-7);
        EXPECT_LT((at.angular_velocity[k] - exact[i].angular_velocity[k]).norm(), 1e-10);
      }
    }
  }
}

// A body may change its model at the start of a step.
TEST(DenseOutput, follows_a_body_through_a_change_of_its_model) {
  const BodyModel models[] = {BodyModel::rigid, BodyModel::frame, BodyModel::elastic, BodyModel::frame,
                              BodyModel::rigid};
  Simulation sim = simulate(thrown(models[0]));
  for (const BodyModel model : models) {
    sim.parameters.models[0] = model;
    const Vec3 x = body_pose(sim.model, sim.state, 0).centre,
               v = body_momentum(sim.model, sim.state, 0).velocity;
    ASSERT_TRUE(sim.advance(1));
    const double h = sim.parameters.time_step;
    State half;
    state_within_step(sim.model, sim.state, sim.state.time - h / 2, sim.workspace(), half);
    // free flight, to what reducing a frame places it by
    EXPECT_LT((body_pose(sim.model, half, 0).centre - x - h / 2 * v - h * h / 8 * Vec3(0, 0, -k_g)).norm(),
              1e-9);
    EXPECT_LT((body_momentum(sim.model, half, 0).velocity - v - h / 2 * Vec3(0, 0, -k_g)).norm(), 1e-6);
    ASSERT_TRUE(sim.advance(20));
  }
}

TEST(DenseOutput, finds_the_forces_there_and_changes_nothing) {
  for (const BodyModel model : {BodyModel::rigid, BodyModel::elastic, BodyModel::frame}) {
    topple::Setup setup = paper_cabinet(model, 4 / k_degrees);
    setup.parameters.adaptive = true;
    topple::Run quiet(setup), seen(setup);
    double furthest = 0;
    for (int i = 0; i < 60; ++i) {
      const double before = seen.time();
      const EnergyLedger energy = seen.energy();
      ASSERT_TRUE(quiet.advance().ok() && seen.advance().ok());
      for (const double share : {0.2, 0.7}) {
        const Snapshot at = seen.snapshot(before + share * (seen.time() - before));
        EXPECT_EQ(at.state.time, before + share * (seen.time() - before));
        EXPECT_EQ(at.state.step, seen.step() - 1);
        // what is linear between the ends of a balanced step is balanced
        EXPECT_NEAR(at.state.energy.unexplained(),
                    (1 - share) * energy.unexplained() + share * seen.energy().unexplained(), 1e-12);
        // contacts at planes push by their depth there
        for (const ContactForce& force : at.contacts) {
          const int node = setup.model.contact_points[force.point].node;
          const double L = contact_length(setup.model.contact_points[force.point], setup.model.planes[0]);
          const double depth =
              1 - (setup.model.planes[0].normal.dot(at.state.position[node] - setup.model.planes[0].point) +
                   setup.model.planes[0].width / 2) /
                      L;
          furthest = std::max(furthest, std::abs(depth - force.depth));
        }
      }
    }
    if (model != BodyModel::elastic) {  // it gives way beyond its modes
      EXPECT_LT(furthest, 1e-12);
    }
    EXPECT_EQ(hash(quiet.state()), hash(seen.state()));
    EXPECT_EQ(quiet.contacts().size(), seen.contacts().size());
  }
}

}  // namespace
}  // namespace topple::test
