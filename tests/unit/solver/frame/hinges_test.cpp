#include "solver/frame/hinges.h"

#include <gtest/gtest.h>

#include "solver/run/run.h"
#include "unit/solver/plastic_statics.h"

namespace topple::test {
namespace {

constexpr double k_yield = 1e5, k_mp = 1.25e-4 * k_yield, k_ei = 205e9 * 5e-6, k_ga = 205e9 / 2.6 * 5e-3;
// Displacements of 1e-7 m at lengths of 1 m: positions hold 2e-9 of them, and frames that sway by this part
// of their height carry as much more or less.
constexpr double k_exact = 1e-6;
constexpr unsigned k_guided = k_clamped & ~1u;  // free along x: no membrane force
constexpr unsigned k_roller = 0b000110;

PlaneFrame beam(double length, unsigned left, unsigned right) {
  PlaneFrame frame;
  frame.nodes = {{0, 0, 0}, {length / 2, 0, 0}, {length, 0, 0}};
  frame.members = {{0, 1}, {1, 2}};
  frame.supports = {{0, left}, {2, right}};
  frame.loads = {{1, {0, 0, -1}, Vec3::Zero(), {}}};
  return frame;
}

Model weak(const PlaneFrame& frame, bool pure = true) {
  return frame.build(pure_bending_section(), weak_steel(k_yield), pure);
}

TEST(Hinges, fixed_beam_collapses_at_8_Mp_over_L_with_two_members) {
  constexpr double k_length = 2, k_step = k_mp * k_length * k_length / k_ei / 200;
  for (Scheme scheme : {Scheme::asi_gauss, Scheme::asi}) {
    PlaneFrame frame = beam(k_length, k_clamped, k_guided);
    frame.scheme = scheme;
    PlasticPath path(weak(frame));
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(path.move(1, 2, -k_step));
    EXPECT_NEAR(path.factor * k_length / (8 * k_mp), 1, k_exact);
    EXPECT_EQ(path.hinge_count(), 3);
  }
}

TEST(Hinges, midpoint_elements_overshoot_n_over_n_minus_1) {
  constexpr double k_length = 2, k_step = k_mp * k_length * k_length / k_ei / 100;
  for (int n : {2, 4, 8}) {
    PlaneFrame frame = beam(k_length, k_clamped, k_guided);
    frame.scheme = Scheme::midpoint;
    frame.supports.push_back({1, 0b111000});  // by symmetry: hinges on both sides leave it undetermined
    frame.elements = n;
    PlasticPath path(weak(frame));
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(path.move(1, 2, -k_step));
    EXPECT_NEAR(path.factor * k_length / (8 * k_mp), n / (n - 1.), k_exact) << n;
  }
}

TEST(Hinges, propped_cantilever_forms_its_first_hinge_at_16_Mp_over_3_L_and_collapses_at_6_Mp_over_L) {
  constexpr double k_length = 2;
  const double first = 16 * k_mp / (3 * k_length);
  PlasticPath path(weak(beam(k_length, k_clamped, k_roller)));
  ASSERT_TRUE(path.move(1, 2, -1e-10));
  const double stiffness = path.factor / 1e-10;
  // shear moves the redundant reaction, and with it the first hinge, by this part
  const double at_first = first / stiffness;
  double last = path.factor, moved = 1e-10;
  int with_one = 0;
  for (int i = 0; i < 400 && path.hinge_count() < 2; ++i) {
    const double step = at_first / 200;
    ASSERT_TRUE(path.move(1, 2, -step));
    moved += step;
    if (path.hinge_count() == 0) {
      EXPECT_NEAR(path.factor, stiffness * moved, 1e-6 * path.factor);
    } else if (path.hinge_count() == 1 && ++with_one > 1) {
      // then a simply supported beam: exact with shear, beside a hinge too
      const double exact = 1 / (k_length * k_length * k_length / (48 * k_ei) + k_length / (4 * k_ga));
      EXPECT_NEAR((path.factor - last) / step, exact, 1e-4 * exact);
    } else if (with_one == 1) {
      EXPECT_EQ(path.hinge(0), Hinge::first);
      const double a = 3 * k_ei / (k_ga * k_length * k_length);
      EXPECT_NEAR(path.factor / (first * (1 + a)), 1, 1. / 200);
    }
    last = path.factor;
  }
  EXPECT_GT(with_one, 10);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(path.move(1, 2, -at_first / 50));
  EXPECT_NEAR(path.factor * k_length / (6 * k_mp), 1, k_exact);
}

struct Portal {
  double beam, sway;  // load factors of V = 2 Mp/l and H = Mp/h
  double exact;
};

class HingesOfPortal : public testing::TestWithParam<Portal> {
 public:
  static constexpr double k_height = 3, k_span = 4;
  static Model model(const Portal& load, bool pure) {
    PlaneFrame frame;
    frame.nodes = {
        {0, 0, 0}, {0, 0, k_height}, {k_span / 2, 0, k_height}, {k_span, 0, k_height}, {k_span, 0, 0}};
    frame.members = {{0, 1}, {1, 2}, {2, 3}, {3, 4}};
    frame.supports = {{0, k_clamped}, {4, k_clamped}};
    frame.loads = {{1, {load.sway * k_mp / k_height, 0, 0}, Vec3::Zero(), {}},
                   {2, {0, 0, -load.beam * 2 * k_mp / k_span}, Vec3::Zero(), {}}};
    return weak(frame, pure);
  }
  // Greatest factor on the way through collapse.
  static double collapse(const Portal& load, bool pure) {
    topple::Setup setup;
    setup.model = model(load, pure);
    setup.starts.resize(1);
    setup.parameters.gravity.setZero();
    const bool sways = load.sway > 0;
    constexpr int k_steps = 80;
    const double travel = k_steps * k_mp * k_height * k_height / k_ei / 40;
    setup.run = {.analysis = Analysis::statics,
                 .statics = {.load_steps = k_steps,
                             .control = PathControl{sways ? 1 : 2, sways ? 0 : 2, sways ? travel : -travel}},
                 .settle = false};
    topple::Run run(setup);
    double greatest = 0;
    while (!run.over()) {
      if (!run.advance().ok()) return -1;
      greatest = std::max(greatest, run.state().load_factor);
    }
    return greatest;
  }
};

TEST_P(HingesOfPortal, collapse_load_is_that_of_plastic_theory) {
  const Portal load = GetParam();
  // the beam's sag and the frame's sway are 1e-5 of its sizes
  EXPECT_NEAR(collapse(load, true) / load.exact, 1, 2e-5);
}

TEST_P(HingesOfPortal, interaction_with_normal_force_costs_its_part_and_no_more) {
  const Portal load = GetParam();
  // N/N0 is about 4 Mp/(l N0) = 2.5e-5 * 1000: its square at most 1e-3
  const double with = collapse(load, false), without = collapse(load, true);
  EXPECT_LT(with, without);
  EXPECT_GT(with, 0.999 * without);
}

INSTANTIATE_TEST_SUITE_P(Modes, HingesOfPortal,
                         testing::Values(Portal{1, 0, 4}, Portal{0, 1, 4}, Portal{1, 1, 3}));

// A cantilever's tip driven down, back and down again.
TEST(Hinges, cycle_leaves_the_displacement_and_takes_the_work_of_theory) {
  constexpr double k_length = 2, k_load = k_mp / k_length;
  PlaneFrame frame;
  frame.nodes = {{0, 0, 0}, {k_length, 0, 0}};
  frame.members = {{0, 1}};
  frame.supports = {{0, k_clamped}};
  frame.loads = {{1, {0, 0, -1}, Vec3::Zero(), {}}};
  PlasticPath path(weak(frame));
  const double elastic = k_load * (k_length * k_length * k_length / (3 * k_ei) + k_length / k_ga);
  double work = 0;
  const auto drive = [&](double distance) {
    for (int i = 0; i < 50; ++i) {
      const double before = path.factor, dissipated = path.dissipated, stored = path.stored();
      ASSERT_TRUE(path.move(1, 2, -distance / 50));
      const double done = 0.5 * (before + path.factor) * distance / 50;
      work += done;
      // no energy appears anywhere on the way: k_exact of the full elastic energy for rounding
      EXPECT_GT(path.dissipated - dissipated, -k_exact * k_load * elastic);
      EXPECT_NEAR(done, path.stored() - stored + path.dissipated - dissipated, k_exact * k_load * elastic);
    }
  };
  drive(3 * elastic);
  EXPECT_NEAR(path.factor, k_load, k_exact * k_load);
  EXPECT_NEAR(path.dissipated, 2 * k_load * elastic, 1e-2 * k_load * elastic);  // the step in which it yields
  drive(-elastic);
  EXPECT_NEAR(path.factor, 0, k_exact * k_load);  // residual displacement 2, elastic slope back
  EXPECT_EQ(path.hinge_count(), 0);
  drive(-3 * elastic);
  EXPECT_NEAR(path.factor, -k_load, k_exact * k_load);
  EXPECT_NEAR(path.dissipated, 4 * k_load * elastic, 2e-2 * k_load * elastic);
  drive(3 * elastic);
  EXPECT_NEAR(path.factor, k_load, k_exact * k_load);
  EXPECT_NEAR(path.dissipated, 5 * k_load * elastic, 3e-2 * k_load * elastic);
  EXPECT_NEAR(work, path.dissipated + path.stored(), 10 * k_exact * k_load * elastic);
}

TEST(Hinges, section_breaks_at_its_curvature_and_only_when_plastic) {
  Model model = weak(beam(2, k_clamped, k_guided));
  model.materials[0].fracture_strain = 0.01;
  const Element& element = model.elements[0];
  const double half = model.sections[0].fibre_z();
  const SectionForces none{Vec3::Zero(), Vec3::Zero()};
  const auto broken = [&](const Vec3& gamma, const Vec3& kappa, const SectionForces& forces) {
    return breaks(model, element, {gamma, kappa}, forces);
  };
  EXPECT_FALSE(broken(Vec3::Zero(), {0, 0.0099 / half, 0}, none));
  EXPECT_TRUE(broken(Vec3::Zero(), {0, -0.0101 / half, 0}, none));
  EXPECT_TRUE(broken({0.0101, 0, 0}, Vec3::Zero(), none));
  EXPECT_FALSE(broken({-0.0101, 0, 0}, Vec3::Zero(), none));
  const double shear = std::sqrt(3.) * 0.01 * element.normal_stiffness.y();
  EXPECT_FALSE(broken(Vec3::Zero(), Vec3::Zero(), {{0, 0.99 * shear, 0}, Vec3::Zero()}));
  EXPECT_TRUE(broken(Vec3::Zero(), Vec3::Zero(), {{0, -1.01 * shear, 0}, Vec3::Zero()}));
  model.materials[0].fracture_strain = 0;
  EXPECT_FALSE(broken({9, 9, 9}, {9, 9, 9}, none));
}

// A clamped beam of realistic steel with a mass in its middle that is pushed far beyond collapse.
Simulation hit_beam(double fracture_strain, Integrator integrator, double time_step) {
  Model model = steel_model();
  model.materials[0].yield = 235e6;
  model.materials[0].fracture_strain = fracture_strain;
  FrameSpec spec;
  spec.name = "beam";
  spec.nodes = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
  spec.members = {{{0, 1}, 0, 0}, {{1, 2}, 0, 0}};
  spec.supports = {{0, k_clamped}, {2, k_guided}};
  spec.masses = {{1, 20.}};
  spec.loads = {{1, {0, 0, -4000}, Vec3::Zero(), {{0, 0}, {0.005, 1}, {0.03, 1}, {0.035, 0}}}};
  add_frame(model, spec);
  Parameters p;
  p.integrator = integrator;
  p.time_step = time_step;
  return Simulation(std::move(model), {BodyStart{}}, p);
}

int count(const State& state, Hinge hinge) {
  return static_cast<int>(std::count_if(state.elements.begin(), state.elements.end(),
                                        [&](const ElementState& e) { return e.hinge == hinge; }));
}

int hinged(const State& state) {
  return count(state, Hinge::first) + count(state, Hinge::second) + count(state, Hinge::both);
}

TEST(Hinges, hit_beam_flows_and_its_energy_is_accounted_for) {
  Simulation sim = hit_beam(0, Integrator::generalized_alpha, 2e-4);
  int most = 0;
  double last = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(sim.advance(1));
    most = std::max(most, hinged(sim.state));
    // by the trapezoidal rule a step that turns the flow round may book a little less than nothing
    EXPECT_GT(sim.state.energy.plastic, last - 1e-3 * sim.state.energy.largest);
    last = sim.state.energy.plastic;
  }
  EXPECT_GE(most, 3);
  EXPECT_GT(sim.state.energy.plastic, 0.5 * sim.state.energy.input);
  EXPECT_LT(sim.state.energy.balance_error(), 1e-4);
}

TEST(Hinges, central_difference_and_generalized_alpha_leave_the_same_dent) {
  Simulation implicit = hit_beam(0, Integrator::generalized_alpha, 1e-4);
  Simulation explicit_run = hit_beam(0, Integrator::central_difference, 5e-6);
  ASSERT_TRUE(implicit.advance(500));
  ASSERT_TRUE(explicit_run.advance(10000));
  const double dent = 1 - implicit.state.position[1].z();
  EXPECT_GT(dent, 0.05);
  // both are of first order where sections begin to flow
  EXPECT_NEAR(1 - explicit_run.state.position[1].z(), dent, 1e-2 * dent);
  EXPECT_NEAR(explicit_run.state.energy.plastic, implicit.state.energy.plastic,
              1e-2 * implicit.state.energy.plastic);
  EXPECT_LT(explicit_run.state.energy.balance_error(), 1e-4);
}

TEST(Hinges, checkpoint_with_hinges_goes_on_bit_for_bit) {
  Simulation sim = hit_beam(0, Integrator::generalized_alpha, 2e-4);
  ASSERT_TRUE(sim.advance(100));
  ASSERT_GT(hinged(sim.state), 0);
  State copy = unpack(sim.model, pack(sim.state));
  EXPECT_EQ(hash(copy), hash(sim.state));
  Workspace workspace(sim.model);
  resume(sim.model, copy, workspace);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(step(sim.model, sim.parameters, copy, workspace).ok());
  ASSERT_TRUE(sim.advance(100));
  EXPECT_EQ(hash(copy), hash(sim.state));
}

TEST(Hinges, broken_beam_lets_its_mass_fall_and_books_what_was_released) {
  for (Integrator integrator : {Integrator::generalized_alpha, Integrator::central_difference}) {
    const bool is_explicit = integrator == Integrator::central_difference;
    SCOPED_TRACE(is_explicit);
    const double h = is_explicit ? 5e-6 : 1e-4;
    Simulation sim = hit_beam(1e-3, integrator, h);
    ASSERT_TRUE(sim.advance(static_cast<int>(std::lround(0.1 / h))));
    EXPECT_GE(count(sim.state, Hinge::broken), 2);
    EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
    const Vec3 v0 = linear_momentum(sim.model, sim.state);
    const double z = sim.state.position[1].z();
    ASSERT_TRUE(sim.advance(static_cast<int>(std::lround(0.02 / h))));
    EXPECT_LT(sim.state.position[1].z(), z);
    EXPECT_LT(linear_momentum(sim.model, sim.state).z(), v0.z());
  }
}

TEST(Hinges, frame_that_falls_on_the_floor_forms_hinges_and_keeps_its_balance) {
  Model model = steel_model();
  model.materials[0].yield = 100e6;
  CabinetSpec spec = tall_cabinet();
  spec.tilt = 0.5;
  const BodyStart start = add_cabinet(model, spec);
  model.planes.push_back(ground());
  Simulation sim(model, {start}, Parameters{});
  const int steps = 1500;
  bool any = false;
  for (int i = 0; i < steps; ++i) {
    ASSERT_TRUE(sim.advance(1));
    any = any || hinged(sim.state) > 0;
  }
  EXPECT_TRUE(any);
  EXPECT_GT(sim.state.energy.plastic, 0);
  EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
}

}  // namespace
}  // namespace topple::test
