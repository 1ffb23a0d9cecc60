// Frames whose steps are too long for them, and frames on contacts that Newton's method does not like.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/io/scene/scene.h"
#include "solver/run/run.h"

namespace topple::io {
namespace {

/// A light cabinet at rest, held by a strap as stiff as its posts.
constexpr const char* k_held = R"(topple = 1
[run]
duration = 2
integrator = "newmark"
beta = 0.26914707764565704
gamma = 0.5438525567505486
time_step = 0.0010834857256693865
elements = "asi"
[contact]
alpha = 592.8637424819988
friction = 0.165640278144798
friction_static = 0.23187631878628256
[[material]]
name = "alloy"
young = 52898250534.918564
poisson = 0.38158114408309846
density = 1296.469409976794
[[section]]
name = "post"
shape = "box"
size = [0.019806671672976197, 0.019806671672976197]
thickness = 0.002239206903355902
[floor]
width = 0.0638104771647679
[[cabinet]]
section = "post"
material = "alloy"
name = "held"
size = [0.3388748782657476, 0.7234553633737332, 0.9152444318370749]
mass = 8.142677127956071
cg_height = 0.4053602728835417
[[anchor]]
body = "held"
point = [-0.1694374391328738, 0.3617276816868666, 0.33935642263387833]
to = [-0.5704886506791826, 0.022567950878061405, 0.7165882176457787]
type = "strap"
stiffness = 334948.50250192086
)";

// Newmark's method is stable for any step only from beta = (gamma + 1/2)^2/4 = 0.2724 on. Below, a body at
// rest gains energy from nothing, 2e5 J here within 0.6 s; steps that gain are taken in parts, and it stays
// at rest.
TEST(StiffFrames, a_step_that_gains_energy_is_taken_in_parts) {
  const Scene scene = parse_scene(k_held, "s.toml");
  topple::Run run(scene.setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
  int rejected = 0;
  while (!run.over()) {
    ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
    rejected += run.status().rejected;
  }
  EXPECT_GT(rejected, 0);
  EXPECT_LT(run.outcome().bodies()[0].peak_tilt, 1e-3);
  EXPECT_LT(run.state().energy.balance_error(), 1e-3);
}

// No section bears more than it can: a step that leads an elastic body beyond its yield surface is taken
// again with the body as a frame, and no energy comes in with the change of its model.
TEST(StiffFrames, a_blow_finds_a_frame_before_a_section_yields) {
  const Scene scene = parse_scene(R"(topple = 1
floor = {}
run = { duration = 0.6, settle = false }
[[cabinet]]
size = [0.38, 0.88, 1.79]
mass = 40
section = "box 30x1"
material = "steel"
tilt = "45 deg"
)",
                                  "s.toml");
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
  const BodyOutcome& body = run.outcome().bodies()[0];
  ASSERT_EQ(body.level_changes.size(), 2u);
  EXPECT_EQ(body.level_changes[1].reason, LevelReason::yield);
  EXPECT_NEAR(body.peak_yield_ratio.value(), 1, 1e-9);
  const EnergyLedger& energy = run.state().energy;
  EXPECT_LT(std::abs(energy.model_switch), 1e-3 * energy.dissipated());
}

// P = alpha (1 - l/L)^q is infinitely stiff where it begins when q < 1, and Newton's steps overshoot.
TEST(StiffFrames, a_stool_comes_to_rest_on_contacts_of_a_small_index) {
  const Scene scene = parse_scene(R"(topple = 1
[run]
duration = 0.01
[contact]
q = 0.7
friction = 0.08
[[section]]
name = "post"
shape = "box"
size = [0.0316, 0.0316]
thickness = 3.4e-3
[floor]
width = 0.0309
[[frame]]
name = "stool"
nodes = [[0.25, 0, 0.03], [-0.125, 0.2165, 0.03], [-0.125, -0.2165, 0.03], [0, 0, 0.623]]
members = [
  { nodes = [0, 3], section = "post", material = "steel" },
  { nodes = [1, 3], section = "post", material = "steel" },
  { nodes = [2, 3], section = "post", material = "steel" },
]
masses = [{ node = 3, mass = 9 }]
)",
                                  "s.toml");
  const topple::Run run(scene.setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
  double carried = 0;
  for (const ContactForce& contact : run.contacts()) carried += contact.force.z();
  const double weight = scene.setup.model.bodies[0].mass * k_standard_gravity;
  EXPECT_NEAR(carried, weight, 1e-6 * weight);
}

}  // namespace
}  // namespace topple::io
