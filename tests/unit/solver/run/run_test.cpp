#include "solver/run/run.h"

#include <gtest/gtest.h>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

TEST(Run, lasts_as_long_as_asked) {
  for (double duration : {0.05, 0.0504, 0.1}) {
    const topple::Setup setup = shaken(duration);
    topple::Run run(setup);
    int steps = 0;
    while (!run.over()) {
      ASSERT_TRUE(run.advance().ok());
      ++steps;
    }
    EXPECT_EQ(steps, std::lround(duration / 1e-3)) << duration;
    EXPECT_FALSE(run.stopped_early());
    EXPECT_EQ(run.state().step, steps);
    EXPECT_GE(run.newton_iterations(), steps);
  }
}

TEST(Run, repeats_bit_for_bit) {
  topple::Setup setup = shaken(1);
  shake(setup, 1.9, 0.5);
  topple::Run a(setup), b(setup);
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(a.advance().ok());
    ASSERT_TRUE(b.advance().ok());
    ASSERT_EQ(hash(a.state()), hash(b.state())) << i;
  }
}

TEST(Run, continued_from_a_checkpoint_gives_the_same_hashes) {
  topple::Setup setup = shaken(1, 0.09);
  shake(setup, 1, 2);
  topple::Run whole(setup);
  for (int i = 0; i < 350; ++i) ASSERT_TRUE(whole.advance().ok());
  topple::Run rest(setup, unpack(setup.model, pack(whole.state())), setup.parameters);
  EXPECT_EQ(hash(rest.state()), hash(whole.state()));
  ASSERT_EQ(rest.contacts().size(), whole.contacts().size());
  for (int i = 0; i < 350; ++i) {
    ASSERT_TRUE(whole.advance().ok());
    ASSERT_TRUE(rest.advance().ok());
    ASSERT_EQ(hash(rest.state()), hash(whole.state())) << i;
  }
}

TEST(Run, stops_when_every_body_lies) {
  topple::Setup setup = shaken(10, 0.25);
  setup.run.stop_when = StopWhen::all_overturned;
  topple::Run run(setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  EXPECT_TRUE(run.stopped_early());
  const BodyOutcome& o = run.outcome().bodies()[0];
  ASSERT_TRUE(o.over_60_since);
  EXPECT_NEAR(run.state().time - *o.over_60_since, 0.5, 2e-3);
  EXPECT_GT(o.tilt, k_pi / 3);
}

TEST(Run, stops_at_rest_only_when_the_floor_is_still) {
  topple::Setup still = shaken(5);
  still.run.stop_when = StopWhen::at_rest;
  topple::Run run(still);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  EXPECT_TRUE(run.stopped_early());
  EXPECT_NEAR(run.state().time, 0.5, 2e-3);
  topple::Setup shaking = shaken(1);
  shaking.run.stop_when = StopWhen::at_rest;
  shake(shaking, 1e-3, 0.5);
  topple::Run other(shaking);
  while (!other.over()) ASSERT_TRUE(other.advance().ok());
  EXPECT_FALSE(other.stopped_early());
}

TEST(Run, that_cannot_settle_is_over_before_it_starts) {
  topple::Setup setup = shaken(1);
  setup.model.planes.clear();
  topple::Run run(setup);
  EXPECT_TRUE(run.over());
  EXPECT_EQ(run.status().kind, StepStatus::Kind::not_settled);
}

TEST(Run, ends_with_the_status_of_the_step_that_failed) {
  topple::Setup setup = shaken(1);
  shake(setup, 1e29, 0.5);
  topple::Run run(setup);
  ASSERT_FALSE(run.over());
  const std::uint64_t before = hash(run.state());
  EXPECT_FALSE(run.advance().ok());
  EXPECT_TRUE(run.over());
  EXPECT_EQ(run.status().kind, StepStatus::Kind::newton_diverged);
  EXPECT_EQ(hash(run.state()), before);
}

TEST(Run, probes_follow_a_node_and_a_body_and_keep_their_peaks) {
  topple::Setup setup = shaken(0.4);
  setup.model.planes.clear();
  setup.run.settle = false;
  setup.parameters.gravity = {0, 0, -2};
  setup.starts[0].velocity = {0.5, 0, 0.3};
  setup.probes = {{"node", 0, 4}, {"body", 0, -1}};
  topple::Run run(setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const Vec3 exact(0.2, 0, 0.3 * 0.4 - 0.16);
  for (const ProbeOutcome& probe : run.probes()) {
    EXPECT_LT((probe.displacement - exact).norm(), 1e-10);
    EXPECT_LT(probe.rotation.norm(), 1e-10);
    EXPECT_NEAR(probe.peak.z(), -0.04, 1e-10);  // deeper at the end than the 0.0225 m of the summit
    EXPECT_NEAR(probe.peak_time.z(), 0.4, 1e-12);
    EXPECT_NEAR(probe.peak.x(), 0.2, 1e-10);
  }
}

}  // namespace
}  // namespace topple::test
