#include "solver/element/damping.h"

#include <gtest/gtest.h>

#include "solver/body/model_level.h"
#include "solver/element/plasticity.h"
#include "solver/frame/central_difference.h"
#include "solver/reduced/elastic_basis.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

// Strains of all elements, six numbers each.
Eigen::VectorXd strains(const Model& model, const BodyMotion& m) {
  Eigen::VectorXd all(6 * model.elements.size());
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const Element& element = model.elements[e];
    const int i = element.node[0], j = element.node[1];
    const BeamStrain strain =
        beam_strain(element, beam_ends(m.position[i], m.rotation[i], m.position[j], m.rotation[j]));
    all.segment<6>(6 * static_cast<int>(e)) << strain.gamma, strain.kappa;
  }
  return all;
}

// Each node `t` later.
BodyMotion moved(const BodyMotion& from, double t) {
  BodyMotion to = from;
  for (std::size_t i = 0; i < from.position.size(); ++i) {
    to.position[i] += t * from.velocity[i];
    to.rotation[i] = from.rotation[i] * exp_quaternion(Vec3(t * from.angular_velocity[i]));
  }
  return to;
}

// A clamped chain with a bend, its second member twisted against the first, in any motion.
BodyMotion any_motion(std::mt19937& rng, const Model& model, double angle) {
  BodyMotion motion = reference_motion(model);
  for (int i = 0; i < model.node_total(); ++i) {
    motion.position[i] += random_vector(rng, 0.05 * angle);
    motion.rotation[i] = exp_quaternion(random_vector(rng, angle));
    motion.velocity[i] = random_vector(rng);
    motion.angular_velocity[i] = random_vector(rng, 3);
  }
  return motion;
}

Model chain() {
  Material material = steel();
  material.yield = 235e6;
  Section section = plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6);
  section.zy = section.zz = section.zt = 2e-6;
  Model model = cantilever(section, material, 1, 2, Vec3::Zero(), Vec3::Zero());
  model.bodies[0].first_frequency = first_frequency(model, 0);
  return model;
}

Parameters damped(double ratio) {
  Parameters p = weightless();
  p.damping = {ratio};
  return p;
}

TEST(Damping, forces_are_those_of_a_times_the_rate_of_the_elastic_stresses) {
  std::mt19937 rng(51);
  const Model model = chain();
  const double a = damping_time(model, damped(0.03), 0);
  EXPECT_DOUBLE_EQ(a, 2 * 0.03 / first_frequency(model, 0));
  for (const double angle : {0., 0.01, 0.3}) {
    SCOPED_TRACE(angle);
    const BodyMotion motion = any_motion(rng, model, angle);
    BodySystem free(model, 0), system(model, 0);
    free.evaluate_free(weightless(), {weightless(), 0}, motion);
    system.evaluate_free(damped(0.03), {damped(0.03), 0}, motion);

    const double t = 1e-5;
    Eigen::VectorXd stress =
        a / (2 * t) * (strains(model, moved(motion, t)) - strains(model, moved(motion, -t)));
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
      const Element& element = model.elements[e];
      auto own = stress.segment<6>(6 * static_cast<int>(e)).array();
      own.head<3>() *= element.normal_stiffness.array();
      own.tail<3>() *= element.bending_stiffness.array();
      own *= element.length;
    }
    // virtual work: force on a node = -stress . d strain / d place
    Eigen::VectorXd found(6 * model.node_total()), expected(6 * model.node_total());
    for (int i = 0; i < model.node_total(); ++i)
      for (int k = 0; k < 6; ++k) {
        BodyMotion way = reference_motion(model);
        way.position = motion.position;
        way.rotation = motion.rotation;
        if (k < 3)
          way.velocity[i][k] = 1;
        else
          way.angular_velocity[i] = motion.rotation[i].conjugate() * Vec3(Vec3::Unit(k - 3));
        expected[6 * i + k] =
            -stress.dot(strains(model, moved(way, t)) - strains(model, moved(way, -t))) / (2 * t);
        found[6 * i + k] =
            k < 3 ? (system.force[i] - free.force[i])[k] : (system.moment[i] - free.moment[i])[k - 3];
      }
    // central differences over 1e-5 s
    EXPECT_LT((found - expected).norm(), 1e-7 * expected.norm());
  }
}

TEST(Damping, stiffens_the_tangent_by_a_times_the_velocity_factor) {
  const Model model = chain();
  const Parameters p = damped(0.2);
  const double a = damping_time(model, p, 0), factor = 1500;
  const auto tip_under_load = [&](double velocity_factor) {
    BodySystem system(model, 0);
    const BodyMotion motion = reference_motion(model);
    system.lu.set_zero();
    system.evaluate_with_tangent(p, {p, 0}, motion, {}, motion.position, velocity_factor);
    for (int i = 0; i < system.count; ++i)
      for (int k = 0; k < 6; ++k)
        if (system.fixed[i] >> k & 1) system.lu.fix(i, k);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(6 * system.count);
    b.tail<6>() << 10, 20, 30, 1, 2, 3;
    EXPECT_EQ(system.lu.factor(), -1);
    system.lu.solve(b.data());
    return Eigen::VectorXd(b.tail<6>());
  };
  EXPECT_LT((tip_under_load(factor) * (1 + a * factor) - tip_under_load(0)).norm(),
            1e-10 * tip_under_load(0).norm());
}

TEST(Damping, of_an_element_that_flowed_is_none) {
  std::mt19937 rng(52);
  const Model model = chain();
  const BodyMotion motion = any_motion(rng, model, 0.01);
  BodySystem free(model, 0), system(model, 0);
  for (BodySystem* s : {&free, &system})
    for (std::size_t e = 0; e < s->elements.size(); ++e) {
      if (e % 2 == 0) s->elements[e].hinge = Hinge::first;
      if (e % 2 == 1) s->elements[e].offset.kappa.y() = 1e-4;  // the hinge went
    }
  free.evaluate_free(weightless(), {weightless(), 0}, motion);
  system.evaluate_free(damped(0.03), {damped(0.03), 0}, motion);
  for (int i = 0; i < system.count; ++i) {
    EXPECT_EQ(system.force[i], free.force[i]);
    EXPECT_EQ(system.moment[i], free.moment[i]);
  }
}

// A section that has no hinge yet when a step begins is damped through it, also while it flows: the tangent
// is that of the forces where velocities are `factor` times the displacements.
TEST(Damping, of_a_section_that_begins_to_flow_is_in_the_tangent) {
  std::mt19937 rng(53);
  const Model model = chain();
  const Parameters p = damped(0.2);
  constexpr double k_factor = 1500, k_step = 1e-9;
  BodyMotion pose = reference_motion(model);
  pose.position.back() += Vec3(0.01, 0.04, 0.03);
  pose.rotation.back() = exp_quaternion(Vec3(0.02, 0.1, -0.1));
  BodySystem system(model, 0);
  system.lu.set_zero();
  system.evaluate_with_tangent(p, {p, 0}, pose, {}, pose.position, k_factor);
  int flowing = 0;
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const auto [i, j] = model.elements[e].node;
    const BeamStrain strain = beam_strain(
        model.elements[e], beam_ends(pose.position[i], pose.rotation[i], pose.position[j], pose.rotation[j]));
    flowing += respond(model.elements[e], system.elements[e], strain).flows() ? 1 : 0;
  }
  ASSERT_GT(flowing, 0);
  Eigen::VectorXd way = Eigen::VectorXd::Zero(6 * system.count), difference = way;
  for (int i = 0; i < system.count; ++i)
    for (int k = 0; k < 6; ++k) {
      if (system.is_fixed(i, k))
        system.lu.fix(i, k);
      else
        way[6 * i + k] = random_vector(rng)[0];
    }
  ASSERT_EQ(system.lu.factor(), -1);
  for (const double side : {k_step, -k_step}) {
    BodyMotion moved = pose;
    for (int i = 0; i < system.count; ++i) {
      const Vec3 shift = side * way.segment<3>(6 * i), spin = side * way.segment<3>(6 * i + 3);
      moved.position[i] += shift;
      moved.velocity[i] = k_factor * shift;
      moved.angular_velocity[i] = k_factor * (moved.rotation[i].conjugate() * spin);
      moved.rotation[i] = exp_quaternion(spin) * moved.rotation[i];
    }
    BodySystem there(model, 0);
    there.evaluate_free(p, {p, 0}, moved);
    for (int i = 0; i < system.count; ++i) {
      there.clear_fixed(i, there.force[i], there.moment[i]);
      difference.segment<3>(6 * i) -= there.force[i] / (2 * side);
      difference.segment<3>(6 * i + 3) -= there.moment[i] / (2 * side);
    }
  }
  system.lu.solve(difference.data());
  // central differences over 1e-9: forces are rounded to 1e-9 of what stiffness makes of that
  EXPECT_LT((difference - way).norm(), 1e-5 * way.norm());
}

// Greatest error in the tenth period of the free vibration from rest at x0, over x0.
double error_of(Integrator integrator, double ratio, int steps_of_a_period) {
  Model model = oscillator();
  model.bodies[0].first_frequency = first_frequency(model, 0);
  EXPECT_NEAR(model.bodies[0].first_frequency, k_oscillation, 1e-9);
  Parameters p = damped(ratio);
  p.integrator = integrator;
  p.spectral_radius = 1;
  const double period = 2 * k_pi / k_oscillation, x0 = 1e-3;
  p.time_step = period / steps_of_a_period;
  Simulation sim(model, {BodyStart{}}, p);
  sim.state.position[1].x() += x0;
  prepare(sim.model, sim.parameters, sim.state, sim.workspace());
  const double swing = k_oscillation * std::sqrt(1 - ratio * ratio);
  double error = 0;
  for (int i = 1; i <= 10 * steps_of_a_period; ++i) {
    sim.advance(1);
    const double t = i * p.time_step;
    const double exact = x0 * std::exp(-ratio * k_oscillation * t) *
                         (std::cos(swing * t) + ratio * k_oscillation / swing * std::sin(swing * t));
    if (i > 9 * steps_of_a_period) error = std::max(error, std::abs(sim.state.position[1].x() - 1 - exact));
  }
  // what the motion lost
  const EnergyLedger& e = sim.state.energy;
  EXPECT_NEAR(e.damping, e.start_total - e.strain - e.kinetic - e.numerical, 1e-3 * e.start_total);
  return error / x0;
}

TEST(Damping, decays_by_the_logarithmic_decrement) {
  for (const double ratio : {0.01, 0.1}) {
    SCOPED_TRACE(ratio);
    // 60 rad of a period error of (w h)^2/12, of second order
    const double coarse = error_of(Integrator::generalized_alpha, ratio, 100),
                 fine = error_of(Integrator::generalized_alpha, ratio, 200);
    EXPECT_LT(fine, 0.01);
    EXPECT_NEAR(coarse / fine, 4, 0.2);
    // the velocity half a step before: first order beside it
    const double explicit_coarse = error_of(Integrator::central_difference, ratio, 400),
                 explicit_fine = error_of(Integrator::central_difference, ratio, 800);
    EXPECT_LT(explicit_fine, 0.01);
    EXPECT_NEAR(explicit_coarse / explicit_fine, 2, 0.2);
  }
}

Setup flying(double ratio, BodyModel asked) {
  topple::Setup setup;
  setup.model = steel_model();
  setup.starts.push_back(add_cabinet(setup.model, tall_cabinet()));
  setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
  setup.model.bodies[0].first_frequency = first_frequency(setup.model, 0);
  setup.run.settle = false;
  setup.parameters = damped(ratio);
  setup.parameters.models = {asked};
  setup.parameters.time_step = 2e-4;
  return setup;
}

TEST(Damping, of_higher_modes_is_in_proportion_to_their_frequency_as_an_elastic_body_and_as_a_frame) {
  const double ratio = 0.02, amplitude = 1e-4;
  for (const int mode : {0, 1, 4}) {
    SCOPED_TRACE(mode);
    const topple::Setup setup = flying(ratio, BodyModel::elastic);
    const double w = setup.model.bodies[0].elastic->frequency[mode],
                 first = setup.model.bodies[0].elastic->frequency[0];
    const int steps = 300;
    const double t = steps * setup.parameters.time_step,
                 left = std::exp(-2 * (ratio * w / first) * w * t);  // of the energy, over whole swings
    Simulation sim(setup.model, setup.starts, setup.parameters);
    sim.state.bodies[0].amplitude[mode] = amplitude;
    State as_frame = sim.state;
    prepare(sim.model, sim.parameters, sim.state, sim.workspace());
    sim.advance(steps);
    const EnergyLedger& e = sim.state.energy;
    // the energy swings by the damping ratio about its exponential
    const double swing = 2 * ratio * w / first;
    EXPECT_NEAR((e.strain + e.kinetic) / e.start_total / left, 1, swing);
    EXPECT_LT(e.balance_error(), 1e-9);

    place_nodes(setup.model, as_frame);
    Simulation frame(setup.model, setup.starts, flying(ratio, BodyModel::frame).parameters);
    frame.state.position = as_frame.position;
    frame.state.rotation = as_frame.rotation;
    prepare(frame.model, frame.parameters, frame.state, frame.workspace());
    frame.advance(steps);
    const EnergyLedger& f = frame.state.energy;
    // generalized-alpha damps (w h)^3 of a swing on its own
    EXPECT_NEAR((f.strain + f.kinetic + f.numerical) / f.start_total / left, 1, 2 * swing + 0.02);
    EXPECT_LT(f.balance_error(), 1e-3);
  }
}

// Relative drift of the angular momentum of a turning cabinet in 1 s.
double drift(double ratio) {
  topple::Setup setup = flying(ratio, BodyModel::frame);
  setup.parameters.spectral_radius = 1;
  setup.parameters.time_step = 1e-3;
  setup.starts[0].angular_velocity = {0, 0, 6};
  setup.starts[0].velocity = {1, 2, 3};
  Simulation sim(setup.model, setup.starts, setup.parameters);
  const Vec3 momentum = linear_momentum(sim.model, sim.state), spin = angular_momentum(sim.model, sim.state);
  sim.advance(500);
  // the members stretch under the centrifugal force, and swing about that at first
  const double early = sim.state.energy.damping;
  sim.advance(500);
  EXPECT_LT(sim.state.energy.damping - early, 1e-9 * sim.state.energy.kinetic);
  EXPECT_LT((linear_momentum(sim.model, sim.state) - momentum).norm(), 1e-9 * momentum.norm());
  return (angular_momentum(sim.model, sim.state) - spin).norm() / spin.norm();
}

TEST(Damping, leaves_rigid_motion_and_momentum_alone) {
  // what the method does on its own, from a swing of the members that is damped or not
  EXPECT_NEAR(drift(0.1), drift(0), 0.05 * drift(0));
}

TEST(Damping, lowers_the_explicit_limit_to_where_the_motion_starts_to_grow) {
  Model model = oscillator();
  model.bodies[0].first_frequency = first_frequency(model, 0);
  const Parameters p = damped(0.3);
  const double a = damping_time(model, p, 0);
  BodySystem system(model, 0);
  const double limit = explicit_limit(system, nullptr, a);
  EXPECT_NEAR(limit, 2 / k_oscillation * (std::sqrt(1 + 0.09) - 0.3), 1e-6 * limit);
  for (const double share : {0.99, 1.01}) {
    State state = start_state(model, {BodyStart{}});
    state.position[1].x() += 1e-3;
    IntegratorScratch scratch;
    StepEnergy energy;
    const double h = share * limit;
    for (int i = 0; i < 1000; ++i) {
      const StepInputs start(p, i * h), end(p, start.time + h);
      ASSERT_TRUE(advance_central_difference(system, {p, start, end, h, 0}, state, scratch, energy).ok());
    }
    const double travel = std::abs(state.position[1].x() - 1);
    EXPECT_TRUE(share < 1 ? travel < 1e-3 : travel > 1) << travel;
  }
}

TEST(Damping, is_an_entry_of_the_energy_that_a_rocking_cabinet_keeps) {
  for (const BodyModel asked : {BodyModel::elastic, BodyModel::frame}) {
    topple::Setup setup = shaken(1, 0.05);
    setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
    setup.model.bodies[0].first_frequency = first_frequency(setup.model, 0);
    setup.parameters.models = {asked};
    setup.parameters.damping = {0.05};
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    EXPECT_GT(run.state().energy.damping, 1e-5);
    EXPECT_LT(run.state().energy.balance_error(), 2e-3);
  }
}

}  // namespace
}  // namespace topple::test
