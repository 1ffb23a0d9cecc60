#include "solver/step/statics.h"

#include <gtest/gtest.h>

#include "solver/run/run.h"
#include "unit/solver/fixtures.h"
#include "unit/solver/step/lees_frame.h"

namespace topple::test {
namespace {

constexpr double k_bending = 1e4;  // N m^2, EI of the beams of theory

// So slender that shear and axial strain play no part: EA L^2/EI = 1e8.
Section slender() {
  return plain_section(1e2, 1e-3, 1e-3, 2e-3, 1, 1);
}

Material soft() {
  Material m = steel();
  m.young = 1e7;
  m.poisson = 0;
  return m;
}

// A clamped chain along x of length 1; loads grow with the factor.
topple::Setup chain(int members, const Vec3& force, const Vec3& moment, int load_steps) {
  topple::Setup setup;
  Material material = soft();
  Section section = slender();
  section.area = k_bending / material.young * 1e8;
  setup.model = cantilever(section, material, 1, members, force, moment);
  for (Load& load : setup.model.loads) load.history.clear();
  setup.starts.push_back({});
  setup.parameters.gravity.setZero();
  setup.run.analysis = Analysis::statics;
  setup.run.settle = false;
  setup.run.statics.load_steps = load_steps;
  return setup;
}

const State& end_of(topple::Run& run) {
  while (!run.over()) run.advance();
  return run.state();
}

TEST(Statics, loads_that_grow_take_no_part_in_settling) {
  // far beyond what the column carries: settled with it there would be no start
  topple::Setup setup = chain(4, {-100 * k_bending, 0, 0}, Vec3::Zero(), 1000);
  setup.parameters.gravity = Vec3(-1e-6, 0, 0);
  setup.run.settle = true;
  const topple::Run run(setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  EXPECT_EQ(run.state().load_factor, 0);
  for (const Vec3& x : run.state().position) EXPECT_LT(x.x(), 1 + 1e-12);
  EXPECT_NEAR(run.state().position[4].x(), 1, 1e-5);
}

TEST(Statics, elastica_under_a_tip_load) {
  struct Case {
    double load, shortening, deflection, angle;
  };
  // Mattiasson 1981
  for (const Case& c : {Case{1, .056433, .301721, .461352}, Case{2, .160642, .493457, .781750},
                        Case{5, .387628, .713792, 1.215368}, Case{10, .554996, .810609, 1.430286}}) {
    SCOPED_TRACE(c.load);
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const int members = 8 << k;
      const topple::Setup setup = chain(members, {0, 0, -c.load * k_bending}, Vec3::Zero(), 10);
      topple::Run run(setup);
      const State& state = end_of(run);
      ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
      EXPECT_EQ(run.load_steps().size(), 10u);
      const Vec3 tip = state.position[members];
      const double angle = log_quaternion(state.rotation[members]).norm();
      error[k] = std::max({std::abs(1 - tip.x() - c.shortening), std::abs(-tip.z() - c.deflection),
                           std::abs(angle - c.angle)});
    }
    // second order in the length of the members; six printed digits
    EXPECT_LT(error[1], 1e-3);
    EXPECT_LT(error[1], error[0] / 3.5 + 2e-6);
  }
}

TEST(Statics, end_moment_rolls_a_beam_up_to_a_full_circle) {
  for (int load_steps : {1, 3, 10}) {
    SCOPED_TRACE(load_steps);
    const int members = 6;
    const topple::Setup setup = chain(members, Vec3::Zero(), {0, -2 * k_pi * k_bending, 0}, load_steps);
    topple::Run run(setup);
    const State& state = end_of(run);
    ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
    // equal curvature in every element closes the chain whatever its number; rounding 1e-16 times
    // EA L^2/EI = 1e8, tenfold
    EXPECT_LT(state.position[members].norm(), 1e-7);
    EXPECT_LT(state.rotation[members].vec().norm(), 1e-7);
    EXPECT_EQ(state.time, 1);
    EXPECT_EQ(state.step, load_steps);
  }
}

TEST(Statics, bend_of_45_degrees_under_a_load_out_of_its_plane) {
  Material material = steel();
  material.young = 1e7;
  material.poisson = 0;
  topple::Setup setup;
  setup.model.materials.push_back(material);
  setup.model.sections.push_back(plain_section(1, 1. / 12, 1. / 12, 1. / 6, 1, 1));
  FrameSpec spec;
  spec.name = "bend";
  constexpr int k_members = 8;
  for (int i = 0; i <= k_members; ++i) {
    const double a = k_pi / 4 * i / k_members;
    spec.nodes.push_back(100 * Vec3(std::sin(a), 1 - std::cos(a), 0));
  }
  for (int i = 0; i < k_members; ++i) spec.members.push_back({{i, i + 1}, 0, 0});
  spec.supports.push_back({0, k_clamped});
  spec.loads.push_back({k_members, {0, 0, 600}, Vec3::Zero(), {}});
  setup.starts = add_frame(setup.model, spec);
  setup.parameters.gravity.setZero();
  setup.run = {.analysis = Analysis::statics, .statics = {.load_steps = 6}, .settle = false};
  topple::Run run(setup);
  Vec3 half = Vec3::Zero();
  while (!run.over()) {
    ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
    if (run.state().step == 3) half = run.state().position[k_members];
  }
  // Simo & Vu-Quoc 1986 print (47.23, 15.79, 53.37) and at half the load (58.84, 22.33, 40.08), x and y
  // swapped; converged values of others differ by about 0.1
  const Vec3 tip = run.state().position[k_members];
  EXPECT_LT((Vec3(tip.y(), tip.x(), tip.z()) - Vec3(15.79, 47.23, 53.37)).cwiseAbs().maxCoeff(), 0.2);
  EXPECT_LT((Vec3(half.y(), half.x(), half.z()) - Vec3(22.33, 58.84, 40.08)).cwiseAbs().maxCoeff(), 0.2);
}

TEST(Statics, displacement_control_passes_the_limit_load_of_lees_frame) {
  double limit[2];
  for (int k = 0; k < 2; ++k) {
    const int members = 20 << k;
    topple::Setup setup = lees_frame(members);
    const int node = members + members / 5;
    setup.run.statics = {.load_steps = 240, .control = PathControl{node, 2, -60.}};
    topple::Run run(setup);
    limit[k] = 0;
    double at = 0;
    while (!run.over()) {
      ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
      if (const double load = 1000 * run.state().load_factor; load > limit[k]) {
        limit[k] = load;
        at = 120 - run.state().position[node].z();
      }
    }
    EXPECT_NEAR(at, 48.75, 0.3);  // one load step
    EXPECT_LT(run.state().load_factor * 1000, 0.99 * limit[k]);
    EXPECT_NEAR(run.state().position[node].z(), 60, 1e-9);
  }
  // second order in the length of the members
  const double extrapolated = limit[1] + (limit[1] - limit[0]) / 3;
  EXPECT_NEAR(extrapolated, 18546.5, 2e-4 * 18546.5);
  EXPECT_NEAR(limit[1], 18546.5, 5e-4 * 18546.5);
}

TEST(Statics, load_step_beyond_the_limit_keeps_what_converged_and_says_where_and_when) {
  topple::Setup setup = lees_frame(10);
  setup.model.loads[0].force = {0, 0, -25000};
  for (int i = 0; i < setup.model.node_total(); ++i)
    setup.model.supports.push_back({i, 0x2a});  // in its plane
  topple::Run run(setup);
  while (!run.over()) run.advance();
  const StepStatus& status = run.status();
  ASSERT_EQ(status.kind, StepStatus::Kind::no_equilibrium);
  EXPECT_GT(status.rejected, 0);
  // 18 594 N on this mesh; the load step of 2500 N is halved down to 1/1024
  EXPECT_NEAR(run.state().load_factor, 18594. / 25000, 1e-3);
  EXPECT_EQ(run.state().time, run.state().load_factor);
  ASSERT_EQ(run.load_steps().size(), 9u);
  EXPECT_TRUE(run.load_steps()[7].converged);
  EXPECT_EQ(run.load_steps()[7].factor, run.state().load_factor);
  EXPECT_FALSE(run.load_steps()[8].converged);
  const std::string text = status.message(setup.model);
  for (const char* part : {"\"lee\"", "element ", "load factor 0.74"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

// Euler: pi^2 EI/(4 L^2) for a clamped column, in both directions at once.
TEST(Statics, straight_column_is_not_followed_beyond_eulers_load_where_that_is_asked_for) {
  const double euler = k_pi * k_pi * k_bending / 4;
  topple::Setup setup = chain(8, {-2 * euler, 0, 0}, Vec3::Zero(), 10);
  setup.run.statics.stop_at_instability = true;
  topple::Run run(setup);
  while (!run.over()) run.advance();
  EXPECT_TRUE(run.status().ok() && run.stopped_early());
  EXPECT_FALSE(run.load_steps().back().converged);
  EXPECT_EQ(run.load_steps().back().stability.loss, Stability::Loss::buckling);
  // 16 elements: second order in their length; 1/1024 of a load step
  EXPECT_NEAR(run.state().load_factor, 0.5, 0.002);
}

TEST(Statics, column_with_a_small_push_follows_the_bent_branch) {
  const double euler = k_pi * k_pi * k_bending / 4;
  const topple::Setup setup = chain(8, {-1.2 * euler, 0, 1e-3 * euler}, Vec3::Zero(), 20);
  topple::Run run(setup);
  const State& state = end_of(run);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  // elastica: the tip of a column under 1.2 of Euler's load stands off by about 0.7 L
  EXPECT_GT(state.position[8].z(), 0.6);
}

TEST(Statics, mechanism_is_named) {
  topple::Setup setup = lees_frame(2);
  setup.model.supports = {{0, 0x2f}, {4, 0x2e}};  // the second foot rolls along x
  setup.model.loads[0].node = 2;
  setup.model.loads[0].force = {1000, 0, 0};
  setup.model.supports.front().fixed = 0x2e;
  topple::Run run(setup);
  while (!run.over()) run.advance();
  ASSERT_EQ(run.status().kind, StepStatus::Kind::no_equilibrium);
  EXPECT_EQ(run.status().body, 0);
  EXPECT_GE(run.status().element, 0);
  EXPECT_EQ(run.state().load_factor, 0);
}

/// Members of one element pair along x, clamped at their start, which nothing but their weight bends.
topple::Setup heavy_beams(double length, const Section& section, const Material& material, double gravity,
                          bool clamped_at_both_ends = false, const std::vector<Vec3>& copies = {}) {
  topple::Setup setup;
  setup.model.materials.push_back(material);
  setup.model.sections.push_back(section);
  FrameSpec spec;
  spec.name = "beam";
  spec.nodes = {{0, 0, 0}, {length, 0, 0}};
  spec.members = {{{0, 1}, 0, 0}};
  spec.supports.push_back({0, k_clamped});
  if (clamped_at_both_ends) spec.supports.push_back({1, k_clamped});
  spec.copies = copies;
  setup.starts = add_frame(setup.model, spec);
  setup.parameters.gravity = {0, 0, -gravity};
  setup.run = {.analysis = Analysis::statics, .settle = false};
  return setup;
}

Section thin() {
  return plain_section(1e-4, 1e-8, 1e-8, 2e-8, 1, 1);
}

// Distributed weight: fixed-end forces and moments make the ends of two elements exact.
TEST(Statics, own_weight_bends_a_cantilever_of_one_member_exactly) {
  const topple::Setup setup = heavy_beams(1, thin(), steel(), 1e-3 * k_g);
  topple::Run run(setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  const double w = 7850 * 1e-4 * 1e-3 * k_g, bending = 205e9 * 1e-8, shear = 205e9 / 2.6 * 1e-4;
  const double exact = w / (8 * bending) + w / (2 * shear);
  // 5e-7 m: geometric nonlinearity is the square of it
  EXPECT_NEAR(-run.state().position[1].z(), exact, 1e-7 * exact);
  const double angle = w / (6 * bending);
  EXPECT_NEAR(log_quaternion(run.state().rotation[1]).y(), angle, 1e-7 * angle);
}

// Moments w L^2/2 at a wall, w L^2/12 between two, half of that and the other way in the middle; the forces
// are those in the middle of each half.
TEST(Statics, own_weight_makes_the_section_forces_of_theory) {
  for (const bool both : {false, true}) {
    SCOPED_TRACE(both);
    const topple::Setup setup = heavy_beams(2, thin(), steel(), 1e-3 * k_g, both);
    topple::Run run(setup);
    ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
    const double weight = 7850 * 1e-4 * 2 * 1e-3 * k_g, moment = weight * 2;
    const auto at = [&](int e, double xi) {
      const Element& element = setup.model.elements[e];
      const SectionForces forces = forces_along(run.sections()[e], element.length, element.s, xi);
      // across the section's axes, world y and z
      return std::pair((element.triad * forces.moment).y(), (element.triad * forces.normal).z());
    };
    const double sign = at(0, -1).first > 0 ? 1 : -1;
    EXPECT_NEAR(sign * at(0, -1).first, moment / (both ? 12 : 2), 1e-6 * moment);
    EXPECT_NEAR(sign * at(0, 1).first, both ? -moment / 24 : moment / 8, 1e-6 * moment);
    EXPECT_NEAR(sign * at(1, -1).first, both ? -moment / 24 : moment / 8, 1e-6 * moment);
    EXPECT_NEAR(sign * at(1, 1).first, both ? moment / 12 : 0, 1e-6 * moment);
    EXPECT_NEAR(std::abs(at(0, 0).second), weight * (both ? 0.25 : 0.75), 1e-6 * weight);
    EXPECT_NEAR(std::abs(at(1, 0).second), weight * 0.25, 1e-6 * weight);
  }
}

// Where sections yield the hinge at the wall forms at w L^2/2: a cantilever that bears 2 % more stands.
TEST(Statics, a_cantilever_yields_under_its_own_weight_at_the_moment_of_theory) {
  const double weight = 7850 * 1e-4 * 2 * k_g;
  for (const double over : {0.98, 1.02}) {
    Material material = steel();
    material.yield = 235e6;
    Section section = thin();
    section.zy = section.zz = section.zt = over * weight * 2 / 2 / material.yield;
    const topple::Setup setup = heavy_beams(2, section, material, k_g);
    topple::Run run(setup);
    EXPECT_EQ(run.status().ok(), over > 1) << run.status().message(setup.model);
    if (over < 1) continue;
    EXPECT_NEAR(*run.outcome().bodies()[0].peak_yield_ratio, 1 / over, 0.01);
  }
}

TEST(Statics, loads_with_a_history_follow_it_over_the_load_steps) {
  topple::Setup setup = chain(2, {0, 0, -0.1 * k_bending}, Vec3::Zero(), 4);
  setup.model.loads[0].history = {{0, 0}, {0.5, 1}, {1, 0}};
  topple::Run run(setup);
  double greatest = 0;
  while (!run.over()) {
    ASSERT_TRUE(run.advance().ok());
    greatest = std::max(greatest, -run.state().position[2].z());
  }
  EXPECT_GT(greatest, 0.03);
  EXPECT_NEAR(run.state().position[2].z(), 0, 1e-9);  // elastic
}

TEST(Statics, continuing_from_a_checkpoint_gives_the_same_hashes) {
  topple::Setup setup = lees_frame(10);
  setup.run.statics = {.load_steps = 20, .control = PathControl{12, 2, std::nullopt}};
  topple::Run run(setup);
  ASSERT_TRUE(run.status().ok());
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(run.advance().ok());
  topple::Run other(setup, unpack(setup.model, pack(run.state())), run.parameters());
  while (!run.over()) {
    ASSERT_EQ(run.advance().ok(), other.advance().ok());
    EXPECT_EQ(hash(run.state()), hash(other.state()));
  }
}

// On a floor, pushed along x at its top by its weight at four nodes; `node`: one of them.
topple::Setup pushed_cabinet(int& node) {
  topple::Setup setup;
  setup.model = steel_model();
  const CabinetSpec spec = tall_cabinet();
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.model.planes.push_back(ground());
  for (int i = 0; i < setup.model.node_total(); ++i) {
    const Vec3& x = setup.model.node_position[i];
    const bool corner = std::abs(std::abs(x.x()) - 0.19) < 1e-9 && std::abs(std::abs(x.y()) - 0.44) < 1e-9;
    if (!corner || x.z() <= 1.5) continue;
    setup.model.loads.push_back({i, {10 * k_g, 0, 0}, Vec3::Zero(), {}});
    node = i;
  }
  setup.parameters.contact.alpha = 5e4 * k_g;
  setup.run.analysis = Analysis::statics;
  return setup;
}

// Friction and weight hold a cabinet that is pushed at its top, until its far edge carries all of it.
TEST(Statics, cabinet_on_a_floor_takes_a_push_until_it_tips) {
  int node = -1;
  const topple::Setup setup = pushed_cabinet(node);
  ASSERT_EQ(setup.model.loads.size(), 4u);
  topple::Run run(setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  while (!run.over()) run.advance();
  EXPECT_EQ(run.status().kind, StepStatus::Kind::no_equilibrium);
  // 40 kg g 0.19 m against 40 kg g at 1.79 m; a little less on an edge that gives way
  EXPECT_NEAR(run.state().load_factor, 0.19 / 1.79, 0.02 * 0.19 / 1.79);
}

// With its top moved it is followed over the balance point, where what pushed it has to hold it back.
TEST(Statics, cabinet_is_followed_over_its_balance_point) {
  int node = -1;
  topple::Setup setup = pushed_cabinet(node);
  setup.run.statics.control = PathControl{.node = node, .direction = 0, .to = 0.4, .arc_length = false};
  setup.run.statics.load_steps = 40;
  topple::Run run(setup);
  int compared = 0;
  while (!run.over()) {
    run.advance();
    const State& state = run.state();
    Vec3 centre = Vec3::Zero();
    double mass = 0, edge = 0;
    for (int i = 0; i < setup.model.node_total(); ++i) {
      centre += setup.model.node_mass[i] * state.position[i];
      mass += setup.model.node_mass[i];
      const Vec3& x = setup.model.node_position[i];
      if (x.x() > 0.189 && x.z() < 0.1) edge = state.position[i].x();
    }
    centre /= mass;
    if (state.position[node].x() < setup.model.node_position[node].x() + 0.1) continue;
    // about the edge: 40 kg g by the load factor, at the pushed nodes, against the weight
    const double exact = (edge - centre.x()) / state.position[node].z();
    // the floor gives way by its contact's depth, and the edge carries from there
    EXPECT_NEAR(state.load_factor, exact, 2e-3) << centre.x();
    ++compared;
  }
  EXPECT_TRUE(run.status().ok()) << run.status().message(setup.model);
  EXPECT_LT(run.state().load_factor, -0.01);
  EXPECT_GT(compared, 10);
}

TEST(Statics, own_weight_bends_every_body_alike) {
  const std::vector<Vec3> copies{Vec3::Zero(), Vec3(0, 2, 0), Vec3(0, 4, 0)};
  const topple::Setup setup = heavy_beams(1, thin(), steel(), k_g, false, copies);
  topple::Run run(setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  const State& state = run.state();
  EXPECT_LT(state.position[1].z(), -1e-6);
  for (int copy = 1; copy < 3; ++copy)
    for (int i = 0; i < 3; ++i) {
      const int there = setup.model.bodies[copy].first_node + i;
      // coordinates of 4 m are rounded to 1e-15
      EXPECT_LT((state.position[there] - state.position[i] - copies[copy]).norm(), 1e-12) << copy;
      EXPECT_LT((state.rotation[there].coeffs() - state.rotation[i].coeffs()).norm(), 1e-12) << copy;
    }
}

}  // namespace
}  // namespace topple::test
