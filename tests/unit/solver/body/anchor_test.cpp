// Anchors against theory, on every level and with every integrator.
#include "solver/contact/anchor.h"

#include "solver/body/anchors.h"
#include "solver/body/body_pose.h"
#include "solver/body/step_control.h"
#include "solver/frame/central_difference.h"
#include "solver/reduced/elastic_basis.h"
#include "unit/solver/body_models.h"
#include "unit/solver/two_threads.h"

namespace topple::test {
namespace {

constexpr double k_mass = 4, k_stiffness = 1e4, k_omega = 50;  // kg, N/m, rad/s
constexpr double k_speed = 0.5;                                // m/s

struct Way {
  const char* name;
  BodyModel model;
  Integrator integrator;
  double time_step;
};
// The bar's own stretching, at 6000 rad/s, sets the explicit step.
const Way k_ways[] = {{"generalized-alpha", BodyModel::frame, Integrator::generalized_alpha, 1e-3},
                      {"newmark", BodyModel::frame, Integrator::newmark, 1e-3},
                      {"central-difference", BodyModel::frame, Integrator::central_difference, 1e-5},
                      {"rigid", BodyModel::rigid, Integrator::generalized_alpha, 1e-3},
                      {"elastic", BodyModel::elastic, Integrator::generalized_alpha, 1e-3}};

Anchor anchor(const Model& model, int node, const Vec3& to, Anchor::Type type,
              double stiffness = k_stiffness) {
  Anchor a;
  a.name = "anchor";
  a.body = model.node_body[node];
  a.node = node;
  a.arm.setZero();
  a.to = to;
  a.type = type;
  a.stiffness = stiffness;
  a.length = (model.node_position[node] - to).norm();
  return a;
}

/// A bar of 4 kg along x, its ends at -0.1 and 0.1, without gravity or a floor, tied to (-1, 0, 0) and thrown
/// away from there: m x'' = -k x.
topple::Setup tied_bar(const Way& way, Anchor::Type type, double speed = k_speed) {
  topple::Setup setup;
  setup.model = sled(k_mass, 0.03, 0);
  setup.model.planes.clear();
  setup.model.anchors.push_back(anchor(setup.model, 0, {-1, 0, 0}, type));
  setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
  setup.starts.push_back({.velocity = Vec3(speed, 0, 0)});
  setup.parameters = weightless();
  setup.parameters.models = {way.model};
  setup.parameters.integrator = way.integrator;
  setup.parameters.time_step = way.time_step;
  setup.parameters.anchors = {true};
  setup.run.settle = false;
  setup.run.duration = 10;
  return setup;
}

int steps_to(double time, const Way& way) {
  return static_cast<int>(std::lround(time / way.time_step));
}

double position(const Simulation& sim) {
  return body_pose(sim.model, sim.state, 0).centre.x();
}

double velocity(const Simulation& sim) {
  return body_momentum(sim.model, sim.state, 0).velocity.x();
}

// Central differences of second order in a step of 1e-6 of the lengths: 1e-9 by rounding, of the stiffness.
TEST(Anchor, force_is_the_gradient_of_its_energy_and_the_tangent_that_of_the_force) {
  std::mt19937 rng(7);
  constexpr double k_step = 1e-6;
  for (const auto type : {Anchor::Type::strap, Anchor::Type::bracket, Anchor::Type::pole})
    for (const double stretch : {-0.2, 0.2}) {
      Anchor a;
      a.to = random_vector(rng);
      a.type = type;
      a.stiffness = 1000;
      const AnchorState state{.length = 0.7};
      const Vec3 arm = random_vector(rng, 0.3), node = a.to + (0.7 + stretch) * random_direction(rng) - arm;
      const bool holds = type == Anchor::Type::bracket || (type == Anchor::Type::strap) == (stretch > 0);
      const AnchorForce now = anchor_force(a, state, node + arm);
      EXPECT_NEAR(now.tension, holds ? 1000 * stretch : 0, 1e-9);
      EXPECT_NEAR(now.energy, holds ? 500 * stretch * stretch : 0, 1e-9);
      const Mat6 slope = anchor_slope(anchor_tangent(a, state, node + arm), arm, now.force);
      for (int k = 0; k < 6; ++k) {
        const auto at = [&](double h) {
          Vec3 turn = Vec3::Zero(), gamma_dt = arm, x = node;
          if (k < 3)
            x[k] += h;
          else
            turn[k - 3] = h;
          gamma_dt = exp_quaternion(turn) * arm;
          const AnchorForce f = anchor_force(a, state, x + gamma_dt);
          Vec6 both;
          both << f.force, gamma_dt.cross(f.force);
          return std::pair(both, f.energy);
        };
        const auto [ahead, more] = at(k_step);
        const auto [behind, less] = at(-k_step);
        EXPECT_LT(((ahead - behind) / (2 * k_step) - slope.col(k)).norm(), 1e-9 * 1000 + 1e-6);
        const double gradient = k < 3 ? now.force[k] : arm.cross(now.force)[k - 3];
        EXPECT_NEAR(-(more - less) / (2 * k_step), gradient, 1e-6);
      }
    }
}

// The bar gives by its own stretching, 1e-4 of the anchor: over the 4.5 rad of this, 2e-4. The period errs by
// (omega h)^2/10 at most (generalized-alpha; the others by 1/12 and 1/24), over 4.5 rad by half of (omega
// h)^2.
TEST(Anchor, a_body_on_a_bracket_swings_as_m_and_k_say) {
  for (const Way& way : k_ways) {
    SCOPED_TRACE(way.name);
    Simulation sim = simulate(tied_bar(way, Anchor::Type::bracket));
    const double amplitude = k_speed / k_omega, tolerance = 2e-4 + 0.5 * std::pow(k_omega * way.time_step, 2);
    for (const double time : {0.03, 0.06, 0.09}) {
      ASSERT_TRUE(sim.advance(steps_to(time - sim.state.time, way)));
      EXPECT_NEAR(position(sim), amplitude * std::sin(k_omega * time), tolerance * amplitude) << time;
      EXPECT_NEAR(velocity(sim), k_speed * std::cos(k_omega * time), tolerance * k_speed) << time;
    }
    EXPECT_LT(sim.state.energy.balance_error(), 1e-6);
  }
}

// Taut over half a period, then free. The instant is found to a step.
TEST(Anchor, a_strap_is_slack_for_one_half_and_a_pole_for_the_other) {
  for (const Way& way : k_ways)
    for (const bool strap : {true, false}) {
      SCOPED_TRACE(std::string(way.name) + (strap ? ", strap" : ", pole"));
      const double speed = strap ? k_speed : -k_speed;
      Simulation sim = simulate(tied_bar(way, strap ? Anchor::Type::strap : Anchor::Type::pole, speed));
      ASSERT_TRUE(sim.advance(steps_to(0.03, way)));
      EXPECT_NEAR(anchor_forces(sim.model, sim.state)[0].tension,
                  k_stiffness * speed / k_omega * std::sin(k_omega * 0.03),
                  1e-3 * k_stiffness * k_speed / k_omega);
      ASSERT_TRUE(sim.advance(steps_to(0.1 - sim.state.time, way)));
      const double free = sim.state.time - k_pi / k_omega;
      EXPECT_EQ(anchor_forces(sim.model, sim.state)[0].tension, 0);
      EXPECT_NEAR(velocity(sim), -speed, 1e-3 * k_speed);
      EXPECT_NEAR(position(sim), -speed * free, way.time_step * k_speed);
      // no rule of quadrature finds the end of a spring within its step: (k/2) (v h)^2 of m v^2/2
      EXPECT_LT(sim.state.energy.balance_error(), std::pow(k_omega * way.time_step, 2));
    }
}

// What is left of the speed says what went with the anchor.
TEST(Anchor, breaks_above_its_strength_and_takes_what_it_held) {
  const double strength = 0.6 * k_speed * std::sqrt(k_stiffness * k_mass);
  for (const Way& way : k_ways) {
    SCOPED_TRACE(way.name);
    topple::Setup setup = tied_bar(way, Anchor::Type::strap);
    setup.model.anchors[0].strength = strength;
    topple::Run run(setup);
    while (run.time() < 0.05) ASSERT_TRUE(run.advance().ok());
    ASSERT_FALSE(run.events().empty());
    const Event& event = run.events().back();
    EXPECT_EQ(event.kind, Event::Kind::anchor);
    EXPECT_EQ(std::ranges::count(run.events(), Event::Kind::anchor, &Event::kind), 1);
    EXPECT_EQ(event.anchor, 0);
    EXPECT_NEAR(event.time, std::asin(0.6) / k_omega, 1.01 * way.time_step);
    // one step of the greatest growth beyond it
    EXPECT_GT(event.value, strength);
    EXPECT_LT(event.value, strength + 1.01 * k_stiffness * k_speed * way.time_step);
    const AnchorOutcome& outcome = run.outcome().anchors()[0];
    EXPECT_EQ(outcome.peak_force, event.value);
    EXPECT_EQ(outcome.broke, event.time);
    EXPECT_EQ(outcome.tension, 0);
    EXPECT_EQ(run.state().anchors[0].hold, AnchorHold::broken);

    const EnergyLedger& e = run.state().energy;
    const double went = event.value * event.value / (2 * k_stiffness);
    EXPECT_NEAR(e.released, went, 1e-9 * went);
    EXPECT_EQ(e.anchor, 0);
    // the bar is left ringing with what it was stretched by: 1e-4 of the anchor's energy
    EXPECT_NEAR(body_momentum(setup.model, run.state(), 0).velocity.x(),
                std::sqrt(k_speed * k_speed - 2 * went / k_mass), 1e-3 * k_speed);
    EXPECT_LT(e.balance_error(), 1e-4);
  }
}

TEST(Anchor, stays_broken_until_it_is_replaced) {
  topple::Setup setup = tied_bar(k_ways[3], Anchor::Type::bracket);
  setup.model.anchors[0].strength = 10;
  topple::Run run(setup);
  while (run.time() < 0.2) ASSERT_TRUE(run.advance().ok());
  EXPECT_EQ(run.state().anchors[0].hold, AnchorHold::broken);
  EXPECT_EQ(run.events().size(), 1u);
  run.edit({Edit::Key::anchor, 0, Vec3(0, 0, 0)});
  ASSERT_TRUE(run.advance().ok());
  EXPECT_EQ(run.state().anchors[0].hold, AnchorHold::away);
  run.edit({Edit::Key::anchor, 0, Vec3(1, 0, 0)});
  ASSERT_TRUE(run.advance().ok());
  EXPECT_NE(run.outcome().anchors()[0].tension, 0);
}

// Taken away while it pulls, then put in place where the body is.
TEST(Anchor, switching_leaves_no_energy_unbooked) {
  for (const Way& way : k_ways) {
    SCOPED_TRACE(way.name);
    const topple::Setup setup = tied_bar(way, Anchor::Type::bracket);
    topple::Run run(setup);
    const auto until = [&](double time) {
      while (run.time() < time - way.time_step / 2) ASSERT_TRUE(run.advance().ok());
    };
    until(0.02);
    const double held = run.state().energy.anchor;
    EXPECT_NEAR(held, k_mass / 2 * std::pow(k_speed * std::sin(1), 2), 1e-3 * held);
    run.edit({Edit::Key::anchor, 0, Vec3(0, 0, 0)});
    ASSERT_TRUE(run.advance().ok());
    EXPECT_NEAR(run.state().energy.released, held, 1e-12);
    EXPECT_EQ(run.state().energy.anchor, 0);
    EXPECT_EQ(run.outcome().anchors()[0].tension, 0);
    until(0.1);
    const double speed = body_momentum(setup.model, run.state(), 0).velocity.x();
    EXPECT_NEAR(speed, k_speed * std::cos(1), 1e-3 * k_speed);
    const double from = run.state().position[0].x();
    run.edit({Edit::Key::anchor, 0, Vec3(1, 0, 0)});
    ASSERT_TRUE(run.advance().ok());
    EXPECT_NEAR(run.state().anchors[0].length, from + 1, 1e-12);
    // one step of stretching
    EXPECT_LT(run.outcome().anchors()[0].tension, 1.01 * k_stiffness * k_speed * way.time_step);
    until(0.1 + k_pi / k_omega);
    EXPECT_NEAR(body_momentum(setup.model, run.state(), 0).velocity.x(), -speed, 5e-3 * k_speed);
    EXPECT_LT(run.state().energy.balance_error(), 1e-4);
  }
}

TEST(Anchor, one_that_is_away_at_the_start_does_nothing) {
  for (const Way& way : k_ways) {
    SCOPED_TRACE(way.name);
    topple::Setup setup = tied_bar(way, Anchor::Type::bracket);
    setup.parameters.anchors = {false};
    Simulation sim = simulate(setup);
    ASSERT_TRUE(sim.advance(steps_to(0.1, way)));
    EXPECT_NEAR(velocity(sim), k_speed, 1e-9);
    EXPECT_EQ(sim.state.energy.released, 0);
  }
}

/// A bar that hangs by its ends.
topple::Setup hanging_bar(BodyModel model, Anchor::Type type, double side) {
  topple::Setup setup;
  setup.model = sled(k_mass, 0.03, 1);
  setup.model.planes.clear();
  for (const int node : {0, 2}) {
    Vec3 to = setup.model.node_position[node];
    to.z() += side;
    setup.model.anchors.push_back(anchor(setup.model, node, to, type));
  }
  setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
  setup.starts.push_back({});
  setup.parameters.models = {model};
  setup.run.duration = 1;
  return setup;
}

// Newton's rest is balanced to 1e-10 of the weight.
TEST(Anchor, a_hanging_body_pulls_by_its_weight) {
  for (const BodyModel model : {BodyModel::frame, BodyModel::rigid, BodyModel::elastic}) {
    SCOPED_TRACE(static_cast<int>(model));
    const topple::Setup setup = hanging_bar(model, Anchor::Type::strap, 1);
    topple::Run run(setup);
    ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
    const double weight = k_mass * k_g;
    for (const AnchorForce& force : anchor_forces(setup.model, run.state()))
      EXPECT_NEAR(force.tension, weight / 2, 1e-8 * weight);
    EXPECT_NEAR(run.state().position[0].z(), 1 - weight / 2 / k_stiffness, 1e-10);
    while (run.time() < 0.3) ASSERT_TRUE(run.advance().ok());
    EXPECT_NEAR(run.outcome().anchors()[1].tension, weight / 2, 1e-6 * weight);
  }
}

TEST(Anchor, nothing_hangs_on_poles_or_stands_on_straps) {
  for (const BodyModel model : {BodyModel::frame, BodyModel::rigid, BodyModel::elastic})
    for (const bool pole : {true, false}) {
      const topple::Setup setup =
          hanging_bar(model, pole ? Anchor::Type::pole : Anchor::Type::strap, pole ? 1 : -1);
      const topple::Run run(setup);
      EXPECT_EQ(run.status().kind, StepStatus::Kind::not_settled);
    }
}

// Springs side by side: F = (k_beam + k) delta. A load that deflects it by 1e-6 of its length leaves it
// linear to 1e-9.
TEST(Anchor, carries_its_part_of_a_static_load) {
  const auto deflection = [](bool tied) {
    topple::Setup setup;
    setup.model =
        cantilever(plain_section(1e-4, 1e-8, 1e-8, 2e-8, 1, 1), steel(), 1, 1, {0, 0, -0.01}, Vec3::Zero());
    for (Load& load : setup.model.loads) load.history.clear();
    const int tip = setup.model.loads[0].node;
    if (tied) setup.model.anchors.push_back(anchor(setup.model, tip, {1, 0, 1}, Anchor::Type::bracket));
    setup.starts.push_back({});
    setup.parameters = weightless();
    setup.run.analysis = Analysis::statics;
    setup.run.settle = false;
    topple::Run run(setup);
    while (!run.over()) run.advance();
    EXPECT_TRUE(run.status().ok());
    return -run.state().position[static_cast<std::size_t>(tip)].z();
  };
  const double beam = 0.01 / deflection(false);
  EXPECT_NEAR(0.01 / deflection(true), beam + k_stiffness, 1e-6 * k_stiffness);
}

// Power iteration gives the highest frequency to 1e-6.
TEST(Anchor, stiffens_what_the_explicit_step_may_be) {
  Model model = oscillator();
  const double mass = model.node_mass[1], own = k_oscillation * k_oscillation * mass;
  model.anchors.push_back(anchor(model, 1, {2, 0, 0}, Anchor::Type::strap, 3 * own));
  BodySystem system(model, 0);
  EXPECT_NEAR(explicit_limit(system), 2 / (2 * k_oscillation), 1e-6);
}

// A body that flies into a strap at a tolerance that lets it fly far.
TEST(Anchor, the_adaptive_step_sees_it_come) {
  for (const BodyModel model : {BodyModel::frame, BodyModel::rigid, BodyModel::elastic}) {
    SCOPED_TRACE(static_cast<int>(model));
    topple::Setup setup = tied_bar({"", model, Integrator::generalized_alpha, 0}, Anchor::Type::strap);
    setup.parameters.adaptive = true;
    setup.model.anchors[0].length += 0.25;
    topple::Run run(setup);
    while (run.time() < 0.8) ASSERT_TRUE(run.advance().ok());
    // the tolerance, 1e-3, times what a twentieth of a period makes of a half-wave: (2 pi/20)^2/24
    EXPECT_NEAR(run.outcome().anchors()[0].peak_force, k_speed * std::sqrt(k_stiffness * k_mass), 0.5);
    EXPECT_NEAR(body_momentum(setup.model, run.state(), 0).velocity.x(), -k_speed, 5e-3 * k_speed);
    EXPECT_LT(run.state().step, 500);
  }
}

/// A cabinet before a wall, shaken, on two straps that are not attached to nodes.
topple::Setup strapped(BodyModel model, double strength = std::numeric_limits<double>::infinity()) {
  topple::Setup setup = shaken(3);
  setup.model.planes.push_back({"wall", Vec3(-0.26, 0, 0), Vec3::UnitX(), 0.09});
  for (const double y : {-0.35, 0.35}) {
    const Vec3 point(-0.19, y, 1.8);
    int nearest = 0;
    for (int i = 0; i < setup.model.node_total(); ++i)
      if ((setup.model.node_position[i] - point).norm() < (setup.model.node_position[nearest] - point).norm())
        nearest = i;
    const Vec3 to(-0.265, y, 1.9);
    Anchor a = anchor(setup.model, nearest, to, Anchor::Type::strap, 5e4);
    a.arm = point - setup.model.node_position[nearest];
    a.length = (point - to).norm();
    a.strength = strength;
    setup.model.anchors.push_back(a);
  }
  EXPECT_GT(setup.model.anchors[0].arm.norm(), 0.01);
  setup.parameters.anchors = {true, true};
  setup.parameters.contact.restitution = 0.5;
  setup.model.bodies[0].elastic = elastic_basis(setup.model, 0);
  setup.parameters.models = {model};
  shake(setup, 1.9, 0.5);
  return setup;
}

// The straps are thirty times softer than the cabinet where they hold it, and their force in series with it;
// impacts on the floor between them make the rest.
TEST(Anchor, models_agree_on_a_strapped_cabinet) {
  double peak[3], tilt[3];
  int k = 0;
  for (const BodyModel model : {BodyModel::frame, BodyModel::elastic, BodyModel::rigid}) {
    const topple::Setup setup = strapped(model);
    topple::Run run(setup);
    while (!run.over()) ASSERT_TRUE(run.advance().ok());
    EXPECT_FALSE(run.outcome().bodies()[0].beyond_since);
    peak[k] = run.outcome().anchors()[0].peak_force;
    tilt[k++] = run.outcome().bodies()[0].peak_tilt;
    EXPECT_LT(run.state().energy.balance_error(), 1e-3);
  }
  EXPECT_GT(peak[0], 50);
  EXPECT_NEAR(peak[1], peak[0], 0.02 * peak[0]);
  EXPECT_NEAR(tilt[1], tilt[0], 0.01 * tilt[0]);
  EXPECT_NEAR(peak[2], peak[0], 0.05 * peak[0]);
  EXPECT_NEAR(tilt[2], tilt[0], 0.02 * tilt[0]);
}

// Two millimetres too short: the cabinet leans on its contacts until little is left in each. What settling
// leaves, 1e-10 of the weight, moves nothing faster than 1e-8 m/s.
TEST(Anchor, a_cabinet_under_taut_straps_rests) {
  for (const BodyModel model : {BodyModel::frame, BodyModel::elastic, BodyModel::rigid}) {
    SCOPED_TRACE(static_cast<int>(model));
    topple::Setup setup = strapped(model);
    setup.parameters.shakes.clear();
    for (Anchor& a : setup.model.anchors) a.length -= 0.002;
    topple::Run run(setup);
    ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(run.advance().ok());
    EXPECT_GT(run.outcome().anchors()[0].tension, 1);
    EXPECT_LT(body_momentum(setup.model, run.state(), 0).velocity.norm(), 1e-7);
    EXPECT_LT(run.outcome().bodies()[0].peak_slide - run.outcome().bodies()[0].slide, 1e-8);
  }
}

TEST(Anchor, what_it_breaks_at_lets_the_cabinet_fall) {
  const topple::Setup setup = strapped(BodyModel::automatic, 60);
  topple::Run run(setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  EXPECT_TRUE(run.outcome().bodies()[0].beyond_since);
  for (const AnchorOutcome& anchor : run.outcome().anchors()) EXPECT_TRUE(anchor.broke);
  EXPECT_LT(run.state().energy.balance_error(), 1e-3);
}

// A checkpoint amid the run, one of two anchors broken, the other taken away and put in place again.
TEST(Anchor, a_checkpoint_continues_to_the_bit) {
  for (const BodyModel model : {BodyModel::frame, BodyModel::elastic, BodyModel::rigid}) {
    SCOPED_TRACE(static_cast<int>(model));
    topple::Setup setup = strapped(model);
    setup.model.anchors[0].strength = 60;
    topple::Run run(setup);
    while (!run.outcome().anchors()[0].broke) {
      ASSERT_TRUE(run.advance().ok());
      ASSERT_FALSE(run.over());
    }
    run.edit({Edit::Key::anchor, 1, Vec3(0, 0, 0)});
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(run.advance().ok());
    run.edit({Edit::Key::anchor, 1, Vec3(1, 0, 0)});
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(run.advance().ok());
    topple::Run other(setup, unpack(setup.model, pack(run.state())), run.parameters());
    EXPECT_EQ(other.state().anchors[0].hold, AnchorHold::broken);
    EXPECT_NE(other.state().anchors[1].length, setup.model.anchors[1].length);
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(run.advance().ok());
      ASSERT_TRUE(other.advance().ok());
      ASSERT_EQ(hash(run.state()), hash(other.state())) << i;
    }
  }
}

TEST(Anchor, threads_change_no_bit) {
  const auto hash_with = [](int workers) {
    topple::Setup setup = strapped(BodyModel::frame, 60);
    CabinetSpec spec = tall_cabinet();
    spec.name = "other";
    spec.at = Vec3(0, 3, 0);
    setup.starts.push_back(add_cabinet(setup.model, spec));
    Anchor a = setup.model.anchors[0];
    a.body = 1;
    a.node += setup.model.bodies[1].first_node;
    a.to.y() += 3;
    setup.model.anchors.push_back(a);
    setup.parameters.anchors.push_back(true);
    setup.parameters.models.push_back(BodyModel::frame);
    topple::Run run(setup);
    share(run, workers);
    while (run.time() < 1.6) EXPECT_TRUE(run.advance().ok());
    EXPECT_TRUE(run.outcome().anchors()[2].broke);
    return hash(run.state());
  };
  EXPECT_EQ(hash_with(1), hash_with(2));
}

}  // namespace
}  // namespace topple::test
