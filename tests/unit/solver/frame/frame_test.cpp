#include <gtest/gtest.h>

#include "solver/run/overturn.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

Mat3 inertia_of_nodes(const Model& model, const Vec3& about) {
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < model.node_total(); ++i) {
    const Vec3 r = model.node_position[i] - about;
    sum +=
        model.node_inertia[i] + model.node_mass[i] * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  return sum;
}

Model model_with(const Section& section) {
  Model model;
  model.materials.push_back(steel());
  model.sections.push_back(section);
  return model;
}

TEST(Frame, masses_of_a_member_have_mass_centre_and_inertia_of_its_line_and_section) {
  std::mt19937 rng(51);
  for (int elements : {2, 4, 8}) {
    SCOPED_TRACE(elements);
    Section section = plain_section(3e-4, 4e-8, 9e-8, 6e-8, 1, 1);
    Model model = model_with(section);
    FrameSpec spec;
    spec.name = "bar";
    spec.nodes = {random_vector(rng), random_vector(rng)};
    spec.members = {{{0, 1}, 0, 0, elements}};
    add_frame(model, spec);
    const Vec3 along = spec.nodes[1] - spec.nodes[0], middle = (spec.nodes[0] + spec.nodes[1]) / 2;
    const double l = along.norm(), mass = 7850 * 3e-4 * l;
    EXPECT_NEAR(model.bodies[0].mass, mass, 1e-12 * mass);
    EXPECT_LT((model.bodies[0].centre_of_gravity - middle).norm(), 1e-14);
    const Mat3 triad = model.elements[0].triad;
    const Vec3 own = 7850 * l * Vec3(13e-8, 4e-8, 9e-8) + mass * l * l / 12 * Vec3(0, 1, 1);
    const Mat3 exact = triad * own.asDiagonal() * triad.transpose();
    EXPECT_LT((model.bodies[0].inertia - exact).norm(), 1e-12 * exact.norm());
    EXPECT_LT((inertia_of_nodes(model, middle) - exact).norm(), 1e-12 * exact.norm());
  }
}

TEST(Frame, triads_follow_the_member_and_its_up) {
  Model model = model_with(plain_section(1e-4, 1e-8, 1e-8, 1e-8, 1, 1));
  FrameSpec spec;
  spec.name = "corner";
  spec.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {1, 1, 2}};
  spec.members = {{{0, 1}, 0, 0}, {{1, 2}, 0, 0}, {{2, 3}, 0, 0, 2, {1, 1, 1}}};
  add_frame(model, spec);
  const auto triad = [&](int member) { return model.elements[model.members[member].first_element].triad; };
  Mat3 expected;
  expected << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  EXPECT_LT((triad(0) - expected).norm(), 1e-15);
  // vertical: up is x, y = up x along
  expected << 0, 0, 1, 0, -1, 0, 1, 0, 0;
  EXPECT_LT((triad(1) - expected).norm(), 1e-15);
  const Mat3 third = triad(2);
  EXPECT_LT((third.col(0) - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((third.col(2) - Vec3(1, 0, 1).normalized()).norm(), 1e-15);
  for (int m = 0; m < 3; ++m) {
    EXPECT_NEAR(triad(m).determinant(), 1, 1e-14);
    EXPECT_LT((triad(m) * triad(m).transpose() - Mat3::Identity()).norm(), 1e-14);
  }
}

TEST(Frame, stress_points_are_the_members_gauss_points) {
  Model model = model_with(plain_section(1e-4, 1e-8, 1e-8, 1e-8, 1, 1));
  FrameSpec spec;
  spec.name = "bar";
  spec.nodes = {{0, 0, 0}, {1, 0, 0}};
  spec.members = {{{0, 1}, 0, 0}};
  add_frame(model, spec);
  ASSERT_EQ(model.elements.size(), 2u);
  for (int e = 0; e < 2; ++e) {
    const double r = -model.elements[e].s, place = (e + (1 + r) / 2) * 0.5;  // 0..1 along the member
    EXPECT_NEAR(2 * place - 1, (e == 0 ? -1 : 1) / std::sqrt(3.), 1e-15);
  }
}

TEST(Frame, frame_far_from_the_origin_is_the_one_at_the_origin_moved) {
  // nodes grow while members are added: their ends must be read before
  Model model = model_with(plain_section(1e-4, 1e-8, 1e-8, 1e-8, 1, 1));
  FrameSpec spec;
  spec.name = "stool";
  spec.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1}};
  for (int leg = 0; leg < 3; ++leg) spec.members.push_back({{leg, 3}, 0, 0, 4});
  spec.copies = {Vec3::Zero(), Vec3(100, 50, 25), Vec3(-3, 8, 2)};
  const std::vector<BodyStart> starts = add_frame(model, spec);
  ASSERT_EQ(starts.size(), 3u);
  ASSERT_EQ(model.bodies.size(), 3u);
  const int n = model.bodies[0].node_count;
  EXPECT_EQ(n, 4 + 9);
  for (int c = 1; c < 3; ++c) {
    ASSERT_EQ(model.bodies[c].node_count, n);
    for (int i = 0; i < n; ++i) {
      EXPECT_LT((model.node_position[c * n + i] - model.node_position[i] - spec.copies[c]).norm(), 1e-12);
      EXPECT_NEAR(model.node_mass[c * n + i], model.node_mass[i], 1e-10 * model.node_mass[i]);
    }
  }
  // every other node lies on a leg
  for (int i = 4; i < n; ++i) {
    double nearest = 1;
    for (int leg = 0; leg < 3; ++leg) {
      const Vec3 along = (spec.nodes[3] - spec.nodes[leg]).normalized(),
                 to = model.node_position[i] - spec.nodes[leg];
      nearest = std::min(nearest, (to - to.dot(along) * along).norm());
    }
    EXPECT_LT(nearest, 1e-12) << "node " << i;
  }
}

TEST(Frame, tilts_about_the_side_of_its_lowest_nodes_that_it_leans_to) {
  for (const double tilt : {0.1, -0.1}) {
    SCOPED_TRACE(tilt);
    const topple::Setup setup = rocking_block(tilt, 1, 1e-3);
    const State state = start_state(setup.model, setup.starts);
    const double lowest = setup.model.node_position[0].z();
    for (int corner = 0; corner < 4; ++corner) {
      const Vec3 &from = setup.model.node_position[corner], &to = state.position[corner];
      const bool edge = from.x() * tilt > 0;
      EXPECT_NEAR(to.z() - lowest, edge ? 0 : 0.38 * std::sin(0.1), 1e-12) << corner;
      EXPECT_LT(edge ? (to - from).norm() : 0, 1e-12) << corner;
    }
  }
}

TEST(Frame, asked_mass_is_met_with_added_masses_kept) {
  Model model = model_with(plain_section(1e-4, 1e-8, 1e-8, 1e-8, 1, 1));
  FrameSpec spec;
  spec.name = "bar";
  spec.nodes = {{0, 0, 0}, {1, 0, 0}};
  spec.members = {{{0, 1}, 0, 0}};
  spec.masses = {{1, 4., {1, 2, 3}}};
  spec.mass = 10;
  add_frame(model, spec);
  const Mat3 added = model.node_inertia[1] - model.node_inertia[0];
  EXPECT_LT((added - Mat3(Vec3(1, 2, 3).asDiagonal())).norm(), 1e-14);
  EXPECT_NEAR(model.bodies[0].mass, 10, 1e-12);
  EXPECT_NEAR(model.node_mass[1] - model.node_mass[0], 4, 1e-12);
  EXPECT_NEAR(model.node_mass[2], 4, 1e-12);  // two thirds of the remaining 6 kg
  spec.mass = 4;
  try {
    add_frame(model, spec);
    FAIL() << "was built";
  } catch (const BuildError& e) {
    EXPECT_EQ(e.key, "mass");
  }
}

TEST(Frame, refuses_nodes_in_one_place_or_without_member_and_members_without_length_or_up) {
  const auto key_of = [](auto change) {
    Model model = model_with(plain_section(1e-4, 1e-8, 1e-8, 1e-8, 1, 1));
    FrameSpec spec;
    spec.name = "bad";
    spec.nodes = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    spec.members = {{{0, 1}, 0, 0}, {{1, 2}, 0, 0}};
    change(spec);
    try {
      add_frame(model, spec);
    } catch (const BuildError& e) {
      return e.key;
    }
    return std::string("built");
  };
  EXPECT_EQ(key_of([](FrameSpec&) {}), "built");
  EXPECT_EQ(key_of([](FrameSpec& s) { s.nodes[2] = s.nodes[0]; }), "nodes");
  EXPECT_EQ(key_of([](FrameSpec& s) { s.members.pop_back(); }), "nodes");
  EXPECT_EQ(key_of([](FrameSpec& s) { s.members[1].node[0] = 2; }), "members");
  EXPECT_EQ(key_of([](FrameSpec& s) { s.members[0].up = Vec3::UnitX(); }), "up");
}

// Four bars without symmetry, soft enough that steps resolve every mode: highest about 4e3 rad/s.
Model lopsided() {
  Model model = model_with(plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.8, 0.7));
  model.materials[0].young = 2e7;
  FrameSpec spec;
  spec.name = "lopsided";
  spec.nodes = {{0, 0, 0}, {1, 0, 0.1}, {0.2, 0.7, 0}, {0.3, 0.2, 0.9}};
  spec.members = {{{0, 1}, 0, 0}, {{0, 2}, 0, 0}, {{0, 3}, 0, 0}, {{1, 2}, 0, 0}};
  spec.masses = {{1, 0.7}, {3, 1.1}};
  add_frame(model, spec);
  return model;
}

struct Flight {
  double linear, angular, energy;  // relative change
  double unexplained;              // by the ledger, of the kinetic energy
  Vec3 tip;
};

Flight fly(const Model& model, Integrator integrator, double rho, double h, double seconds,
           const Vec3& spin) {
  Parameters p = weightless();
  p.integrator = integrator;
  p.spectral_radius = rho;
  p.time_step = h;
  BodyStart start;
  start.velocity = {0.3, -0.2, 0.1};
  start.angular_velocity = spin;
  Simulation sim(model, {start}, p);
  const auto energy = [&] { return kinetic_energy(sim.model, sim.state) + sim.state.energy.strain; };
  const Vec3 p0 = linear_momentum(model, sim.state), l0 = angular_momentum(model, sim.state);
  const double e0 = energy();
  sim.advance(static_cast<int>(std::lround(seconds / h)));
  return {(linear_momentum(model, sim.state) - p0).norm() / p0.norm(),
          (angular_momentum(model, sim.state) - l0).norm() / l0.norm(), std::abs(energy() - e0) / e0,
          std::abs(sim.state.energy.unexplained()) / e0, sim.state.position[model.bodies[0].first_node + 1]};
}

TEST(Frame, free_flight_keeps_momenta_and_energy_with_second_order_in_the_step) {
  const Model model = lopsided();
  const Vec3 spin(1, 3, 0.5);
  for (Integrator integrator : {Integrator::generalized_alpha, Integrator::central_difference}) {
    SCOPED_TRACE(static_cast<int>(integrator));
    Flight f[3];
    for (int k = 0; k < 3; ++k) f[k] = fly(model, integrator, 0.8, 2e-4 / (1 << k), 0.2, spin);
    for (const Flight& x : f) EXPECT_LT(x.linear, 1e-11);
    const double coarse = (f[0].tip - f[1].tip).norm(), fine = (f[1].tip - f[2].tip).norm();
    EXPECT_GT(fine, 1e-12);
    EXPECT_NEAR(coarse / fine, 4, 0.4);
    EXPECT_LT(f[2].angular, 0.35 * f[1].angular + 1e-12);
    EXPECT_LT(f[2].energy, 0.35 * f[1].energy + 1e-12);
    EXPECT_LT(f[2].angular, 1e-5);
    EXPECT_LT(f[2].energy, 1e-5);
    // the ledger follows nodes with unequal inertias, too
    EXPECT_LT(f[2].unexplained, 0.3 * f[1].unexplained + 1e-12);
    EXPECT_LT(f[2].unexplained, 1e-5);
  }
}

TEST(Frame, nodes_with_large_unequal_inertias_keep_the_angular_momentum) {
  // so large that the gyroscopic moment of the nodes, of either sign, decides the flight
  Model model = lopsided();
  for (Mat3& inertia : model.node_inertia) inertia = Vec3(0.02, 0.09, 0.05).asDiagonal();
  for (Integrator integrator : {Integrator::generalized_alpha, Integrator::central_difference}) {
    SCOPED_TRACE(static_cast<int>(integrator));
    const Flight coarse = fly(model, integrator, 0.8, 2e-4, 0.2, {1, 3, 0.5});
    const Flight fine = fly(model, integrator, 0.8, 1e-4, 0.2, {1, 3, 0.5});
    EXPECT_LT(fine.angular, 0.35 * coarse.angular + 1e-12);
    EXPECT_LT(fine.angular, 1e-5);
  }
}

TEST(Frame, both_integrators_tend_to_the_same_flight) {
  const Model model = lopsided();
  const Flight a = fly(model, Integrator::generalized_alpha, 0.8, 5e-5, 0.2, {1, 3, 0.5});
  const Flight b = fly(model, Integrator::central_difference, 0.8, 5e-5, 0.2, {1, 3, 0.5});
  // each is off by its second-order error, about 1e-6
  EXPECT_LT((a.tip - b.tip).norm(), 1e-5);
}

TEST(Frame, stiff_cabinet_tumbles_without_losing_momentum) {
  Model model = steel_model();
  add_cabinet(model, tall_cabinet());
  double last = 0;
  for (double h : {4e-3, 2e-3, 1e-3}) {
    SCOPED_TRACE(h);
    const Flight f = fly(model, Integrator::generalized_alpha, 0.8, h, 1, {1, 3, 0.5});
    EXPECT_LT(f.linear, 1e-11);
    if (last > 0) {
      EXPECT_LT(f.angular, 0.3 * last);
    }
    last = f.angular;
  }
  EXPECT_LT(last, 1e-5);
  const Flight f = fly(model, Integrator::central_difference, 0.8, 4e-5, 0.5, {1, 3, 0.5});
  EXPECT_LT(f.linear, 1e-11);
  EXPECT_LT(f.angular, 1e-7);
  EXPECT_LT(f.energy, 1e-6);
}

TEST(Frame, free_fall_is_the_parabola_and_bends_nothing) {
  for (Integrator integrator : {Integrator::generalized_alpha, Integrator::central_difference}) {
    Parameters p;
    p.integrator = integrator;
    p.time_step = 2e-4;
    BodyStart start;
    start.velocity = {1, 0.5, 2};
    Simulation sim(lopsided(), {start}, p);
    ASSERT_TRUE(sim.advance(2500));
    const double t = 0.5;
    const Vec3 travel = t * start.velocity + t * t / 2 * p.gravity;
    for (int i = 0; i < sim.model.node_total(); ++i) {
      // rounding of 2500 additions
      EXPECT_LT((sim.state.position[i] - sim.model.node_position[i] - travel).norm(), 1e-11);
      EXPECT_LT(log_quaternion(sim.state.rotation[i]).norm(), 1e-11);
    }
    EXPECT_LT(sim.state.energy.strain, 1e-12);
    EXPECT_LT(sim.state.energy.balance_error(), 1e-11);
  }
}

TEST(Frame, tilts_about_its_lowest_node_wherever_it_stands_and_however_its_nodes_are_listed) {
  FrameSpec spec;
  spec.name = "stool";
  spec.nodes = {{0.2, 0, 1}, {0, 0, 0}, {0.5, 0, 1e-3}, {0.1, 0, -1e-3}, {0.3, 0.4, 0.2}};
  for (int i = 1; i < 5; ++i) spec.members.push_back({{0, i}, 0, 0});
  // the one foot that is lowest, to whatever side: the next is 1 mm above it, a thousandth of the height
  for (const double tilt : {0.1, -0.1})
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(-3, 0, 0), Vec3(5000, 2, 7)}) {
      SCOPED_TRACE(testing::Message() << tilt << " at " << shift.transpose());
      FrameSpec there = spec;
      for (Vec3& x : there.nodes) x += shift;
      there.tilt = tilt;
      Model model = steel_model();
      const std::vector<BodyStart> starts = add_frame(model, there);
      EXPECT_EQ(starts[0].pivot, there.nodes[3]);
    }
}

}  // namespace
}  // namespace topple::test
