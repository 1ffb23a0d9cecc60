// Blows that make steel yield, and contacts that Newton's method does not like.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/io/scene/scene.h"
#include "solver/run/run.h"

namespace topple::io {
namespace {

// No section bears more than it can: a step that leads an elastic body beyond its yield surface is taken
// again with the body as a frame, and no energy comes in with the change of its model.
TEST(StiffFrames, a_blow_finds_a_frame_before_a_section_yields) {
  const Scene scene = parse_scene(R"(topple = 1
floor = {}
run = { duration = 0.6, settle = false, accuracy = 1 }
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

// A bookshelf falls on a desk of steel: it is a frame before it strikes. To change within the blow put 57 J
// into it.
TEST(StiffFrames, what_falls_on_another_body_brings_no_energy_of_its_model) {
  const Scene scene = parse_scene(R"(topple = 1
run = { duration = 1.25, settle = false }
floor = {}
furniture = [
  { kind = "bookshelf", size = [0.3, 0.9, 1.8], tilt = "12 deg" },
  { kind = "desk", at = [1.55, 0], yaw = "180 deg" },
]
)",
                                  "s.toml");
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
  for (const BodyOutcome& body : run.outcome().bodies()) EXPECT_EQ(body.level, ModelLevel::frame);
  const EnergyLedger& energy = run.energy();
  EXPECT_GT(energy.largest, 100);
  EXPECT_LT(std::abs(energy.model_switch), 1e-3 * energy.largest);
}

// It racks by decimetres as it lands: what explicit substeps of one length did not account for there was 8e-3
// of the largest energy.
TEST(StiffFrames, energy_adds_up_while_a_fallen_bookshelf_rings) {
  const Scene scene = parse_scene(R"(topple = 1
run = { duration = 2.5, settle = false }
floor = {}
furniture = [{ kind = "bookshelf", tilt = "12 deg" }]
)",
                                  "s.toml");
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
  ASSERT_EQ(run.outcome().bodies()[0].level, ModelLevel::frame);
  EXPECT_LT(run.energy().balance_error(), 2e-3);  // of 6,600 steps, each of which may leave 2e-5
}

// A cabinet that knocks on its wall becomes a frame within a step: what was looked at of it before, by who
// records it, must not count.
TEST(StiffFrames, a_run_that_is_looked_at_is_the_run_that_is_not) {
  const Scene scene = parse_scene(R"(topple = 1
run = { duration = 1.4 }
floor = {}
wall = [{ at = [-0.6, 0], normal = [1, 0, 0] }]
shake = [{ frequency = 1, amplitude = "463 gal", taper = 1 }]
furniture = [{ kind = "cabinet", against = "wall-1", offset = 1.5 }]
)",
                                  "s.toml");
  topple::Run alone(scene.setup), seen(scene.setup);
  while (!alone.over()) {
    ASSERT_TRUE(alone.advance().ok());
    ASSERT_TRUE(seen.advance().ok());
    seen.state();
  }
  ASSERT_EQ(alone.outcome().bodies()[0].level, ModelLevel::frame);
  EXPECT_EQ(alone.step(), seen.step());
  EXPECT_EQ(hash(alone.state()), hash(seen.state()));
}

}  // namespace
}  // namespace topple::io
