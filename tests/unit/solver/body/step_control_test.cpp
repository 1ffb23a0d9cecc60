#include "solver/body/step_control.h"

#include <gtest/gtest.h>

#include "solver/body/parts.h"
#include "solver/frame/central_difference.h"
#include "solver/run/run.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

double time_limit(const Model& model, const Parameters& parameters, const State& state) {
  Parts parts(model);
  parts.arrange(state);
  return parts.time_limit(parameters, state);
}

Simulation adaptive(const Model& model, const BodyStart& start, Parameters p, double tolerance) {
  p.adaptive = true;
  p.tolerance = tolerance;
  return Simulation(model, {start}, p);
}

// Steps up to time `until`. False, and a failure of the test, when a step fails.
bool advance_until(Simulation& sim, double until) {
  while (sim.state.time < until) {
    const StepStatus status = step(sim.model, sim.parameters, sim.state, sim.workspace(), until);
    if (!status.ok()) {
      ADD_FAILURE() << status.message(sim.model);
      return false;
    }
  }
  return true;
}

TEST(StepControl, error_is_proportional_to_the_tolerance) {
  for (Integrator integrator : {Integrator::generalized_alpha, Integrator::newmark}) {
    SCOPED_TRACE(static_cast<int>(integrator));
    double error[3];
    for (int k = 0; k < 3; ++k) {
      Parameters p = weightless();
      p.integrator = integrator;
      const Model model = oscillator();
      Simulation sim = adaptive(model, {}, p, 1e-2 * std::pow(0.1, k));
      sim.state.position[1].x() += 0.01;
      prepare(model, sim.parameters, sim.state, sim.workspace());
      ASSERT_TRUE(advance_until(sim, 0.5));
      const double angle = k_oscillation * 0.5;
      error[k] = std::hypot(sim.state.position[1].x() - 1 - 0.01 * std::cos(angle),
                            sim.state.velocity[1].x() / k_oscillation + 0.01 * std::sin(angle));
    }
    // each tenth of the tolerance a tenth of the error; steps vary, so within a factor of 2
    for (int k = 0; k < 2; ++k) {
      EXPECT_GT(error[k] / error[k + 1], 5);
      EXPECT_LT(error[k] / error[k + 1], 20);
    }
  }
}

Simulation rocking(double tolerance) {
  Model model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.tilt = 0.08;
  const BodyStart start = add_cabinet(model, spec);
  model.planes.push_back(ground());
  Parameters p;
  p.contact.alpha = 1250 * k_g;
  return adaptive(model, start, p, tolerance);
}

TEST(StepControl, continuing_from_a_checkpoint_gives_the_same_hashes) {
  Simulation sim = rocking(1e-3);
  ASSERT_TRUE(sim.advance(150));
  State other = unpack(sim.model, pack(sim.state));
  Workspace fresh(sim.model);
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(sim.advance(1));
    ASSERT_TRUE(step(sim.model, sim.parameters, other, fresh).ok());
    ASSERT_EQ(hash(other), hash(sim.state)) << "step " << i;
  }
  EXPECT_GT(sim.state.time, 0.5);  // through the first impact
}

TEST(StepControl, energy_of_a_rocking_cabinet_is_balanced_to_the_tolerance) {
  Simulation sim = rocking(1e-3);
  ASSERT_TRUE(advance_until(sim, 2));
  EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
}

TEST(StepControl, steps_land_on_the_end_and_on_every_kink) {
  Model model = oscillator();
  model.loads.push_back({1, {10, 0, 0}, Vec3::Zero(), {{0.0123, 0}, {0.05, 1}}});
  Simulation sim = adaptive(model, {}, weightless(), 1e-3);
  std::vector<double> times;
  while (sim.state.time < 0.1) {
    ASSERT_TRUE(step(sim.model, sim.parameters, sim.state, sim.workspace(), 0.1).ok());
    times.push_back(sim.state.time);
  }
  for (double kink : {0.0123, 0.05, 0.1})
    EXPECT_TRUE(std::any_of(times.begin(), times.end(), [&](double t) { return std::abs(t - kink) < 1e-12; }))
        << kink;
}

// At once, on nodes so light and so damped that no step would be short enough for an error that is measured
// by their speed. After five periods the first mode has 2e-3 of what it began with.
TEST(StepControl, a_load_that_jumps_on_a_damped_frame_at_rest_bends_it) {
  const double length = 1, side = 0.02, force = 10;
  const Section square = plain_section(side * side, std::pow(side, 4) / 12, std::pow(side, 4) / 12,
                                       0.141 * std::pow(side, 4), 5. / 6, 5. / 6);
  Model model = cantilever(square, steel(), length, 10, Vec3(0, 0, -force), Vec3::Zero());
  model.loads[0].history.clear();
  const double bending = steel().young * square.iy,
               first = 3.516 * std::sqrt(bending / (steel().density * square.area)) / (length * length);
  model.bodies[0].first_frequency = first;
  Parameters p = weightless();
  p.damping = {0.2};
  Simulation sim = adaptive(model, {}, p, 1e-3);
  ASSERT_TRUE(advance_until(sim, 5 * 2 * k_pi / first));
  const double tip = force * std::pow(length, 3) / (3 * bending);
  EXPECT_NEAR(-sim.state.position[10].z(), tip, 0.01 * tip);
}

TEST(StepControl, floor_that_jumps_does_so_once) {
  Model model = steel_model();
  const BodyStart start = add_cabinet(model, tall_cabinet());
  Parameters p = weightless();
  Shake shake;
  shake.amplitude = 1;
  shake.frequency = 0.5;
  shake.start = 0.05;
  shake.initial_velocity = Shake::Start::jump;
  p.shakes.push_back(shake);
  Simulation sim = adaptive(model, start, p, 1e-3);
  ASSERT_TRUE(advance_until(sim, 0.051));
  const double jump = 1 / (k_pi);  // A/w, the bodies stay behind
  const Vec3 momentum = linear_momentum(sim.model, sim.state);
  EXPECT_NEAR(momentum.x(), 40 * jump, 40 * 1e-3 * jump);
}

TEST(StepControl, step_that_never_converges_is_never_accepted) {
  Model model = steel_model();
  BodyBuilder builder(model, "loose");
  builder.line("bar", Vec3::Zero(), Vec3::UnitX(), 1, 2, 0, 0, Vec3::UnitZ());
  builder.node({0, 0, 5});  // neither mass nor member: singular at any step
  builder.add_material_mass();
  builder.close();
  Parameters p = weightless();
  p.adaptive = true;
  State state = start_state(model, {BodyStart{}});
  Workspace workspace(model);
  const std::uint64_t before = hash(state);
  const StepStatus status = step(model, p, state, workspace);
  EXPECT_EQ(status.kind, StepStatus::Kind::singular);
  EXPECT_GE(status.rejected, 10);  // from 1e-4 s to 1e-8 s by halves
  EXPECT_EQ(hash(state), before);
}

TEST(StepControl, closing_contact_is_met_within_a_quarter_of_its_width) {
  for (double speed : {0.5, 2., 8.}) {
    SCOPED_TRACE(speed);
    const double width = 0.06;
    const Model model = sled(10, width, width / 2 + 0.1);
    Parameters p = weightless();
    BodyStart start;
    start.velocity = {0, 0, -speed};
    Simulation sim = adaptive(model, start, p, 0.1);
    EXPECT_LE(time_limit(model, p, sim.state), std::max(0.1 / speed, width / (4 * speed)) * (1 + 1e-9));
    double before = 0;
    while (sim.contacts().empty()) {
      before = sim.state.position[0].z();
      ASSERT_TRUE(sim.advance(1));
      ASSERT_LT(sim.state.time, 1);
    }
    EXPECT_LT(before - sim.state.position[0].z(), 0.26 * width + 0.1);
    EXPECT_GT(sim.state.position[0].z(), width / 2 - 0.26 * width);
  }
}

TEST(StepControl, flying_body_turns_a_tenth_of_a_radian_per_step) {
  Model model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.angular_velocity = {0, 20, 0};
  const BodyStart start = add_cabinet(model, spec);
  Simulation sim = adaptive(model, start, weightless(), 1e-2);
  EXPECT_NEAR(time_limit(model, sim.parameters, sim.state), 0.1 / 20, 1e-12);
}

TEST(StepControl, central_difference_steps_nine_tenths_of_its_limit_contacts_included) {
  Simulation sim = rocking(1e-3);
  sim.parameters.integrator = Integrator::central_difference;
  EXPECT_FALSE(explicit_limit(sim.workspace()));
  ASSERT_TRUE(sim.advance(1));
  const double limit = explicit_limit(sim.workspace()).value();
  EXPECT_NEAR(sim.state.time, 0.9 * limit, 1e-15);
  BodySystem system(sim.model, 0);
  EXPECT_LT(limit, explicit_limit(system));
  ASSERT_TRUE(sim.advance(2000));
  EXPECT_TRUE(is_finite(sim.state));
}

TEST(StepControl, the_limit_during_a_ramp_is_that_of_the_stiffer_law) {
  // at q = 0.5 a shallow contact is stiffer than at q = 2
  const Simulation sim = rocking(1e-3);
  const auto limit = [&](double q, double q_before, double over) {
    Parameters p = sim.parameters;
    p.contact.kind = ContactLawKind::paper;  // no stick springs, which would hide it
    p.contact.alpha *= 1e4;                  // stiffer than the members
    p.contact_before = p.contact;
    p.contact.q = q;
    p.contact_before.q = q_before;
    p.contact_ramp = {.since = 0, .over = over};
    return Parts(sim.model).explicit_limit(p, sim.state).value().step;
  };
  const double shallow = limit(0.5, 0.5, 0);
  EXPECT_LT(shallow, 0.9 * limit(2, 2, 0));
  EXPECT_EQ(limit(2, 0.5, 1), shallow);
  EXPECT_EQ(limit(0.5, 2, 1), shallow);
}

TEST(StepControl, resting_frame_takes_a_twentieth_of_its_period_on_its_contacts) {
  Model model = steel_model();
  const BodyStart start = add_cabinet(model, tall_cabinet());
  model.planes.push_back(ground());
  Parameters p;
  p.contact.alpha = 1250 * k_g;
  Simulation sim(model, {start}, p, true);
  ASSERT_FALSE(sim.contacts().empty());
  double stiffness = 0;  // q = 1: alpha/L each
  for (const ContactForce& f : sim.contacts())
    stiffness += p.contact.alpha / ((model.contact_points[f.point].width + model.planes[0].width) / 2);
  const double period = 2 * k_pi * std::sqrt(model.bodies[0].mass / stiffness);
  EXPECT_NEAR(time_limit(model, p, sim.state), period / 20, 1e-12);
}

TEST(StepControl, members_that_close_are_met_in_time) {
  // a bar along x and, 40 mm above, one along y: crossing at unequal parts of their elements
  Model model = steel_model();
  const double height = 0.04;
  const Vec3 crossing(0.1, 0.05, 0);
  for (int k = 0; k < 2; ++k) {
    BodyBuilder builder(model, k == 0 ? "below" : "above");
    const Vec3 along = k == 0 ? Vec3::UnitX() : Vec3::UnitY(),
               middle(k * crossing.x(), (1 - k) * crossing.y(), 0);
    const Vec3 up = k * height * Vec3::UnitZ();
    builder.line("bar", middle + up - 0.3 * along, middle + up + 0.3 * along, 1, 2, 0, 0, Vec3::UnitZ());
    builder.add_material_mass();
    builder.close();
  }
  State state = start_state(model, {BodyStart{}, BodyStart{}});
  state.candidate_pairs = std::vector<ElementPair>{{1, 3}};
  const Parameters p = weightless();
  std::mt19937 rng(21);
  const double gap = height - model.sections[0].width, quarter = model.sections[0].width / 4;
  int closing_ones = 0;
  for (int trial = 0; trial < 40; ++trial) {
    // each turns about a point of its own, too slowly for that to count
    Vec3 at_crossing[2];
    for (int k = 0; k < 2; ++k) {
      const Vec3 pivot = crossing + random_vector(rng, 5), spin = random_vector(rng, 0.8);
      const auto velocity = [&](const Vec3& x) -> Vec3 { return spin.cross(x - pivot); };
      const Body& body = model.bodies[k];
      for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
        state.velocity[i] = velocity(state.position[i]);
        state.angular_velocity[i] = spin;
      }
      at_crossing[k] = velocity(crossing + k * height * Vec3::UnitZ());
    }
    const double closing = at_crossing[0].z() - at_crossing[1].z();
    const bool seen = closing * k_longest_step > gap;
    closing_ones += seen;
    EXPECT_NEAR(time_limit(model, p, state),
                seen ? std::min(k_longest_step, std::max(gap, quarter) / closing) : k_longest_step, 1e-12)
        << trial;
  }
  EXPECT_GT(closing_ones, 10);
}

}  // namespace
}  // namespace topple::test
