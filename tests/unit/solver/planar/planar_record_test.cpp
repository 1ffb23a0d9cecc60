// Records: what a block at rest passes at once changes nothing.
#include <gtest/gtest.h>

#include <random>

#include "solver/model/accelerogram.h"
#include "unit/solver/planar/planar_blocks.h"

namespace topple::planar::test {
namespace {

Shake random_record(std::mt19937& rng, double peak, bool vertical) {
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng()) / 0x1p32;
  };
  std::vector<AccelerogramComponent> components;
  for (const Vec3& direction : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
    if (direction.z() != 0 && !vertical) break;
    AccelerogramComponent one{direction, 0.01, {}};
    double smooth = 0;
    for (int i = 0; i < 1000; ++i) {
      smooth = 0.9 * smooth + within(-0.3, 0.3);
      one.samples.push_back(peak * smooth * std::sin(0.003 * i));
    }
    components.push_back(std::move(one));
  }
  Shake shake;
  shake.kind = Shake::Kind::record;
  shake.record = make_accelerogram(std::move(components));
  shake.start = within(0, 0.5), shake.scale = within(0.5, 2);
  return shake;
}

TEST(PlanarRecord, passing_lines_that_cannot_wake_a_block_leaves_every_bit) {
  std::mt19937 rng(7);
  long steps = 0, steps_one_by_one = 0;
  int woken = 0, still = 0;
  for (int n = 0; n < 200; ++n) {
    Block block = uniform_block(0.1 + 0.002 * n, 0.9, 0.1 + 0.003 * n);
    if (n % 3 == 0) block.left *= 1.3;
    const std::vector<Shake> shakes{random_record(rng, 1 + 0.04 * n, n % 2 == 0)};
    const ShakenPlane plane{shakes};
    Floor slow = shaken(plane);
    slow.quiet = nullptr;
    const auto count = [](long& of) { return [&of](const Step&) { ++of; }; };
    const PlanarRun fast = run_planar(block, shaken(plane), standing(), 12, {}, 1000, count(steps));
    const PlanarRun each = run_planar(block, slow, standing(), 12, {}, 1000, count(steps_one_by_one));
    ASSERT_EQ(fast.events.size(), each.events.size()) << n;
    for (std::size_t k = 0; k < each.events.size(); ++k) {
      EXPECT_EQ(fast.events[k].event, each.events[k].event) << n;
      EXPECT_EQ(fast.events[k].after.time, each.events[k].after.time) << n;
      EXPECT_EQ(fast.events[k].after.rate, each.events[k].after.rate) << n;
    }
    EXPECT_EQ(fast.state.x, each.state.x) << n;
    EXPECT_EQ(fast.state.tilt, each.state.tilt) << n;
    EXPECT_EQ(fast.state.mode, each.state.mode) << n;
    (each.events.empty() ? still : woken) += 1;
  }
  EXPECT_GT(woken, 50);
  EXPECT_GT(still, 20);
  EXPECT_LT(2 * steps, steps_one_by_one);
}

// A step over many lines is one at rest: the motion within it is the start's.
TEST(PlanarRecord, what_is_passed_at_once_is_rest) {
  std::mt19937 rng(1);
  const std::vector<Shake> shakes{random_record(rng, 0.01, true)};
  const ShakenPlane plane{shakes};
  const Block block = uniform_block(0.2, 0.9, 0.6);
  double longest = 0;
  run_planar(block, shaken(plane), standing(), 12, {}, 10, [&](const Step& step) {
    longest = std::max(longest, step.length);
    const State within = state_within(step, step.start.time + 0.37 * step.length);
    EXPECT_EQ(within.mode, Mode::rest);
    EXPECT_EQ(within.x, 0);
    EXPECT_EQ(within.tilt, 0);
  });
  EXPECT_GT(longest, 5);  // not cut at Controls::longest, nor at each of the 1,000 samples
}

}  // namespace
}  // namespace topple::planar::test
