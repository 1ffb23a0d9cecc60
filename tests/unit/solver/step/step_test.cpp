#include "solver/step/step.h"

#include <gtest/gtest.h>

#include <functional>

#include "solver/contact/contact_law.h"
#include "solver/model/excitation.h"
#include "solver/state/sections.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

const Integrator k_integrators[] = {Integrator::generalized_alpha, Integrator::central_difference};

struct Scene {
  double tilt = 0, amplitude = 0, friction = 0.6;
  ContactLawKind law = ContactLawKind::coulomb;
  Integrator integrator = Integrator::generalized_alpha;
  bool settled = false;
};

Simulation on_the_floor(const Scene& scene) {
  Model model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.tilt = scene.tilt;
  const BodyStart start = add_cabinet(model, spec);
  model.planes.push_back(ground());
  Parameters p;
  p.contact.kind = scene.law;
  p.contact.friction = scene.friction;
  p.integrator = scene.integrator;
  p.time_step = scene.integrator == Integrator::central_difference ? 3e-5 : 1e-3;
  if (scene.amplitude != 0) {
    Shake shake;
    shake.amplitude = scene.amplitude;
    shake.frequency = 2;
    p.shakes.push_back(shake);
  }
  return Simulation(model, {start}, p, scene.settled);
}

// What the ledger says, added up by other means.
struct OwnSums {
  double kinetic, strain, gravity, contact;
};

OwnSums own_sums(Simulation& sim, double start_height) {
  OwnSums sums{kinetic_energy(sim.model, sim.state), 0, 0, 0};
  std::vector<SectionForces> forces;
  section_forces(sim.model, sim.state, forces);
  for (std::size_t e = 0; e < forces.size(); ++e) {
    const Element& element = sim.model.elements[e];
    const Vec3 &n = forces[e].normal, &m = forces[e].moment;
    sums.strain += element.length / 2 *
                   (n.cwiseProduct(n).cwiseQuotient(element.normal_stiffness).sum() +
                    m.cwiseProduct(m).cwiseQuotient(element.bending_stiffness).sum());
  }
  sums.gravity = 40 * k_g * (centre_of_mass(sim.model, sim.state).z() - start_height);
  const ContactLaw& law = sim.parameters.contact;
  for (const ContactForce& f : sim.contacts()) {
    const double L = (sim.model.contact_points[f.point].width + sim.model.planes[f.plane].width) / 2;
    sums.contact += law.alpha * L / (law.q + 1) * std::pow(f.depth, law.q + 1);
    const Vec3 stick = sim.state.stick[static_cast<std::size_t>(f.point) * sim.model.planes.size() + f.plane];
    if (law.kind == ContactLawKind::coulomb)
      sums.contact += 0.5 * k_stick_stiffness * law.alpha / L * stick.squaredNorm();
  }
  return sums;
}

// Runs, comparing as it goes; the greatest balance error seen.
double audited(Simulation& sim, double seconds, bool printed = false) {
  const double height = centre_of_mass(sim.model, sim.state).z();
  const EnergyLedger& e = sim.state.energy;
  double worst = 0, input = 0, friction = 0;
  for (int chunk = 0; chunk < 20; ++chunk) {
    const int steps = static_cast<int>(std::lround(seconds / 20 / sim.parameters.time_step));
    for (int i = 0; i < steps; ++i) {
      const Vec3 before = centre_of_mass(sim.model, sim.state);
      const double t = sim.state.time;
      if (!sim.advance(1)) return 1;
      const Vec3 floor = 0.5 * (floor_acceleration(sim.parameters.shakes, t) +
                                floor_acceleration(sim.parameters.shakes, sim.state.time));
      input -= 40 * floor.dot(centre_of_mass(sim.model, sim.state) - before);
      worst = std::max(worst, e.balance_error());
    }
    const OwnSums own = own_sums(sim, height);
    // sums of 1e4 steps over 400 J
    EXPECT_NEAR(e.kinetic, own.kinetic, 1e-9 * e.largest);
    EXPECT_NEAR(e.strain, own.strain, 1e-7 * e.largest);
    EXPECT_NEAR(e.gravity, own.gravity, 1e-7 * e.largest);
    if (!printed) {
      EXPECT_NEAR(e.contact, own.contact, 1e-9 * e.largest);
    }
    EXPECT_NEAR(e.input, input, 1e-7 * e.largest);
    EXPECT_GE(e.friction, friction - 1e-4 * e.largest);
    friction = e.friction;
    EXPECT_DOUBLE_EQ(e.dissipated(), e.friction + e.normal_damping + e.numerical);
    EXPECT_NEAR(e.unexplained(),
                e.kinetic + e.strain + e.gravity + e.contact - e.start_total - e.input + e.dissipated(),
                1e-12 * e.largest);
  }
  return worst;
}

TEST(Step, energy_balances_in_a_rocking_run) {
  for (auto law : {ContactLawKind::coulomb, ContactLawKind::paper}) {
    SCOPED_TRACE(static_cast<int>(law));
    Scene scene;
    scene.tilt = 0.09;
    scene.law = law;
    Simulation sim = on_the_floor(scene);
    EXPECT_LE(audited(sim, 3), 1e-3);
    EXPECT_GT(sim.state.energy.largest, 1);
    EXPECT_GT(sim.state.energy.normal_damping, 0.1);
  }
}

TEST(Step, energy_balances_in_a_fall) {
  for (Integrator integrator : k_integrators) {
    SCOPED_TRACE(static_cast<int>(integrator));
    Scene scene;
    scene.tilt = 0.3;
    scene.integrator = integrator;
    Simulation sim = on_the_floor(scene);
    EXPECT_LE(audited(sim, integrator == Integrator::central_difference ? 1.2 : 3), 1e-3);
    // it has fallen: most of m g (height - half depth) came free
    EXPECT_LT(sim.state.energy.gravity, -200);
  }
}

TEST(Step, energy_balances_in_a_slide) {
  for (Integrator integrator : k_integrators) {
    SCOPED_TRACE(static_cast<int>(integrator));
    Scene scene;
    scene.amplitude = 7;
    scene.friction = 0.15;
    scene.settled = true;
    scene.integrator = integrator;
    Simulation sim = on_the_floor(scene);
    EXPECT_LE(audited(sim, integrator == Integrator::central_difference ? 0.5 : 2), 1e-3);
    EXPECT_GT(sim.state.energy.friction, 1);
    EXPECT_GT(sim.state.energy.input, 1);
  }
}

// Thrown down at 10 m/s in steps of 4 ms, each of which takes a point past the whole width of its contact.
TEST(Step, one_that_is_too_long_for_a_contact_is_taken_in_parts) {
  Model model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.at.z() += 0.05;
  BodyStart start = add_cabinet(model, spec);
  start.velocity = {0, 0, -10};
  model.planes.push_back(ground());
  Parameters p;
  p.contact.alpha = 20000 * k_g;
  p.time_step = 4e-3;
  for (const bool resolves : {true, false}) {
    p.resolves_contacts = resolves;
    Simulation sim(model, {start}, p, false);
    StepStatus status;
    while (status.ok() && sim.state.time < 0.5) status = sim.advance();
    EXPECT_EQ(status.ok(), resolves) << status.message(model);
    if (resolves)
      EXPECT_LE(sim.state.energy.balance_error(), 2e-3);  // 1e-3 of each step that is taken as a whole
    else
      EXPECT_EQ(status.kind, StepStatus::Kind::energy_lost);
  }
}

// Puts `bad` into one field and steps: the step is refused with the state as it was, or the field played no
// part and what is accepted is finite.
void expect_never_accepted(const Scene& scene, const std::function<void(Simulation&, double)>& poison,
                           bool must_refuse) {
  for (double bad : {std::nan(""), HUGE_VAL}) {
    Simulation sim = on_the_floor(scene);
    ASSERT_TRUE(sim.advance(3));
    poison(sim, bad);
    const std::uint64_t before = hash(sim.state);
    const StepStatus status = sim.advance();
    SCOPED_TRACE(bad);
    if (must_refuse) {
      EXPECT_FALSE(status.ok());
    }
    if (status.ok()) {
      EXPECT_TRUE(is_finite(sim.state));
    } else {
      EXPECT_EQ(hash(sim.state), before);
      // not "singular": that would send the reader looking for a loose part
      EXPECT_TRUE(status.kind == StepStatus::Kind::not_finite ||
                  status.kind == StepStatus::Kind::newton_diverged)
          << static_cast<int>(status.kind);
      EXPECT_FALSE(status.message(sim.model).empty());
    }
  }
}

TEST(Step, nan_or_infinity_in_the_state_is_never_accepted) {
  for (Integrator integrator : k_integrators) {
    SCOPED_TRACE(static_cast<int>(integrator));
    Scene scene;
    scene.settled = true;
    scene.integrator = integrator;
    const bool implicit = integrator == Integrator::generalized_alpha;
    const auto check = [&](const char* name, std::vector<Vec3> State::*field, bool must_refuse) {
      SCOPED_TRACE(name);
      expect_never_accepted(
          scene, [&](Simulation& sim, double bad) { (sim.state.*field)[0][1] = bad; }, must_refuse);
    };
    check("position", &State::position, true);
    check("velocity", &State::velocity, true);
    check("angular_velocity", &State::angular_velocity, true);
    check("acceleration", &State::acceleration, true);
    check("angular_acceleration", &State::angular_acceleration, true);
    // the explicit step does not read these two, and replaces them
    check("algorithmic_acceleration", &State::algorithmic_acceleration, implicit);
    check("algorithmic_angular_acceleration", &State::algorithmic_angular_acceleration, implicit);
    expect_never_accepted(
        scene, [](Simulation& s, double bad) { s.state.stick[0].x() = bad; }, true);
    expect_never_accepted(
        scene, [](Simulation& s, double bad) { s.state.rotation[0].x() = bad; }, true);
    expect_never_accepted(
        scene, [](Simulation& s, double bad) { s.state.floor_displacement.x() = bad; }, true);
    expect_never_accepted(
        scene, [](Simulation& s, double bad) { s.state.floor_velocity.x() = bad; }, true);
    expect_never_accepted(
        scene, [](Simulation& s, double bad) { s.state.energy.input = bad; }, true);
    expect_never_accepted(
        scene, [](Simulation& s, double bad) { s.state.energy.start_total = bad; }, true);
    expect_never_accepted(
        scene, [](Simulation& s, double bad) { s.state.time = bad; }, true);
  }
}

TEST(Step, nan_in_the_parameters_is_never_accepted) {
  for (Integrator integrator : k_integrators) {
    Scene scene;
    scene.settled = true;
    scene.amplitude = 1;
    scene.integrator = integrator;
    const bool implicit = integrator == Integrator::generalized_alpha;
    const auto check = [&](const char* name, bool must_refuse,
                           const std::function<void(Parameters&, double)>& poison) {
      SCOPED_TRACE(testing::Message() << name << ", integrator " << static_cast<int>(integrator));
      Simulation sim = on_the_floor(scene);
      ASSERT_TRUE(sim.advance(3));
      poison(sim.parameters, std::nan(""));
      const std::uint64_t before = hash(sim.state);
      const StepStatus status = sim.advance();
      if (must_refuse) {
        EXPECT_FALSE(status.ok());
      }
      if (status.ok())
        EXPECT_TRUE(is_finite(sim.state));
      else
        EXPECT_EQ(hash(sim.state), before);
    };
    check("alpha", true, [](Parameters& p, double x) { p.contact.alpha = x; });
    check("q", true, [](Parameters& p, double x) { p.contact.q = x; });
    check("friction", true, [](Parameters& p, double x) { p.contact.friction = x; });
    check("restitution", true, [](Parameters& p, double x) { p.contact.restitution = x; });
    check("normal_speed", true, [](Parameters& p, double x) { p.contact.normal_speed = x; });
    check("gravity", true, [](Parameters& p, double x) { p.gravity.z() = x; });
    check("time_step", true, [](Parameters& p, double x) { p.time_step = x; });
    check("amplitude", true, [](Parameters& p, double x) { p.shakes[0].amplitude = x; });
    check("frequency", true, [](Parameters& p, double x) { p.shakes[0].frequency = x; });
    check("direction", true, [](Parameters& p, double x) { p.shakes[0].direction.x() = x; });
    check("spectral_radius", implicit, [](Parameters& p, double x) { p.spectral_radius = x; });
    check("slip_speed", false, [](Parameters& p, double x) { p.contact.slip_speed = x; });
  }
}

TEST(Step, time_and_count_advance_and_contacts_are_ordered) {
  Scene scene;
  scene.settled = true;
  Simulation sim = on_the_floor(scene);
  EXPECT_EQ(sim.state.step, 0);
  ASSERT_TRUE(sim.advance(7));
  EXPECT_EQ(sim.state.step, 7);
  EXPECT_NEAR(sim.state.time, 7e-3, 1e-17);
  double carried = 0;
  int last = -1;
  for (const ContactForce& f : sim.contacts()) {
    EXPECT_GT(f.point, last);
    last = f.point;
    EXPECT_GT(f.depth, 0);
    EXPECT_NEAR(f.force.z(), f.normal, 1e-12 * f.normal);
    carried += f.normal;
  }
  EXPECT_NEAR(carried, 40 * k_g, 1e-4);
}

TEST(Step, section_forces_of_a_cantilever_follow_from_equilibrium) {
  const Vec3 p(20, 10, -6);
  const double l = 1.2, mx = 3;
  const Model model =
      cantilever(plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6), steel(), l, 1, 1e-3 * p, {1e-3 * mx, 0, 0});
  BodySystem system(model, 0);
  BodyMotion motion = reference_motion(model);
  ASSERT_GT(solve_statics(system, weightless(), 1, motion), 0);
  State state = start_state(model, {BodyStart{}});
  state.position = motion.position;
  state.rotation = motion.rotation;
  std::vector<SectionForces> forces;
  section_forces(model, state, forces);
  ASSERT_EQ(forces.size(), 2u);
  for (int e = 0; e < 2; ++e)
    for (double xi : {-1., -model.elements[e].s, 0.3, 1.}) {
      SCOPED_TRACE(testing::Message() << "element " << e << ", xi " << xi);
      const SectionForces f = forces_along(forces[e], model.elements[e].length, model.elements[e].s, xi);
      const double arm = l - (e + (1 + xi) / 2) * l / 2;
      // a thousandth of a newton bends by 1e-6: that much of the force turns
      const double tolerance = 2e-5 * 1e-3 * 20;
      EXPECT_LT((f.normal - 1e-3 * p).norm(), tolerance);
      EXPECT_NEAR(f.moment.z(), 1e-3 * p.y() * arm, tolerance);
      EXPECT_NEAR(f.moment.y(), -1e-3 * p.z() * arm, tolerance);
      EXPECT_NEAR(f.moment.x(), 1e-3 * mx, tolerance);
    }
}

TEST(Step, equivalent_stress_adds_fibre_stresses_and_torsion_after_von_mises) {
  Section s = plain_section(2e-4, 3e-8, 5e-8, 4e-8, 1, 1);
  s.size_y = 0.04;
  s.size_z = 0.06;
  const SectionForces f{{-1000, 77, 88}, {20, -30, 50}};
  const double normal = 1000 / 2e-4 + 30 * 0.03 / 3e-8 + 50 * 0.02 / 5e-8, shear = 20 * 0.03 / 4e-8;
  EXPECT_NEAR(equivalent_stress(s, f), std::sqrt(normal * normal + 3 * shear * shear), 1e-4);
}

TEST(Step, every_failure_has_a_sentence_that_names_the_body) {
  const Scene scene;
  const Simulation sim = on_the_floor(scene);
  using Kind = StepStatus::Kind;
  for (Kind kind : {Kind::newton_diverged, Kind::not_accurate, Kind::not_finite, Kind::singular,
                    Kind::not_settled, Kind::step_too_long}) {
    StepStatus status;
    status.kind = kind;
    status.body = 0;
    status.element = kind == Kind::newton_diverged ? 0 : -1;
    status.time = 1.25;
    status.limit = 3e-5;
    const std::string text = status.message(sim.model);
    EXPECT_NE(text.find("\"cabinet\""), std::string::npos) << text;
    if (kind == Kind::newton_diverged) {
      EXPECT_NE(text.find("\"post-1\""), std::string::npos) << text;
    }
    EXPECT_NE(text.find("1.25 s"), std::string::npos) << text;
    if (kind == Kind::step_too_long) {
      EXPECT_NE(text.find("3e-05"), std::string::npos) << text;
    }
  }
  EXPECT_EQ(StepStatus{}.message(sim.model), "ok");
}

}  // namespace
}  // namespace topple::test
