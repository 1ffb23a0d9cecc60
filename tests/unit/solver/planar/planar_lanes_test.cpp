// Runs in lanes end with the bits that they have alone, whatever their neighbours do.
#include "solver/planar/planar_lanes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>

#include "solver/model/accelerogram.h"
#include "unit/solver/planar/planar_blocks.h"

namespace topple::planar {
namespace {

using test::sine_shake;
using test::uniform_block;

constexpr double k_duration = 6;  // s
constexpr auto k_never_give_up = [] { return false; };

struct Member {
  PlanarCase of;
  std::vector<Shake> shakes;
};

std::shared_ptr<const Accelerogram> noise(unsigned seed) {
  std::mt19937 rng(seed);
  std::vector<AccelerogramComponent> components;
  for (const Vec3& direction : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
    AccelerogramComponent one;
    one.direction = direction, one.interval = 0.01;
    const double size = direction.x() > 0 ? 1 : 0.3;
    double value = 0;
    for (int i = 0; i < 400; ++i)
      one.samples.push_back(value = 0.9 * value + size * (static_cast<double>(rng()) / 0x1p31 - 1));
    components.push_back(std::move(one));
  }
  return make_accelerogram(std::move(components));
}

/// Blocks of all sizes and kinds of friction, shaken in all ways, that rest, slide, rock and fly; some come
/// within reach of something, some fail.
Member random_member(unsigned seed) {
  std::mt19937 rng(seed);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng()) / 0x1p32;
  };
  const auto chance = [&](double share) { return within(0, 1) < share; };
  const double half_base = within(0.05, 0.5), half_height = within(0.2, 1.2);
  Member member;
  PlanarCase& of = member.of;
  of.block = uniform_block(half_base, half_height, chance(0.4) ? within(0, 0.3) : within(0.3, 1.5));
  if (chance(0.3)) of.block.left = within(0.05, 0.5);
  if (chance(0.3)) of.block.kinetic_friction *= within(0.5, 1);
  if (chance(0.3)) of.block.restitution = within(0, 1);
  of.along = Vec3::UnitX(), of.across = Vec3::UnitY(), of.origin = Vec3::Zero();
  of.farthest = chance(0.1) ? 0.1 : 1e9;
  of.start = standing(chance(0.4) ? within(-0.2, 0.2) : 0, 0, chance(0.2) ? within(-2, 2) : 0);
  if (chance(0.1)) {
    of.start = referred(of.block, of.start, Mode::flight, Side::right);
    of.start.z += within(0.01, 0.5), of.start.rate = within(-2, 2);
  }
  if (chance(0.1)) of.controls.order = 8;
  if (chance(0.9)) {
    const double amplitude = within(0, 8), frequency = within(0.3, 5);
    Shake shake = sine_shake(amplitude, frequency);
    const double kind = within(0, 1);
    if (kind < 0.2) {
      shake.kind = Shake::Kind::pulse, shake.duration = within(0.1, 0.8);
    } else if (kind < 0.4) {
      shake.kind = Shake::Kind::sweep, shake.duration = within(2, 5), shake.last_frequency = 2 * frequency;
    } else if (kind < 0.7) {
      shake.kind = Shake::Kind::record, shake.record = noise(seed), shake.scale = within(0.5, 2);
    } else if (chance(0.3)) {
      shake.taper = 2, shake.cycles = 8;
    } else if (chance(0.3)) {
      shake.initial_velocity = Shake::Start::jump, shake.start = within(0, 1);
    }
    member.shakes.push_back(shake);
  }
  if (chance(0.2)) member.shakes.push_back(sine_shake(14, within(0.3, 5), Vec3::UnitZ()));
  if (chance(0.05)) of.start.rate = std::nan("");
  const bool recorded = !member.shakes.empty() && member.shakes[0].kind == Shake::Kind::record;
  if (chance(0.1) && !recorded) of.start.time = std::nan("");
  return member;
}

std::unique_ptr<PlanarRun> run_of(const Member& member) {
  return std::make_unique<PlanarRun>(member.of, member.shakes, k_duration);
}

/// Numbers as bits, but those that are none.
std::vector<std::uint64_t> outcome(const PlanarRun& run) {
  const State& s = run.state();
  std::vector<std::uint64_t> out;
  for (const double value : {s.time, s.x, s.z, s.tilt, s.x_velocity, s.z_velocity, s.rate, run.peak_slide(),
                             run.lifted().value_or(-1), run.beyond_since().value_or(-1)})
    out.push_back(std::isnan(value) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(value));
  for (const int value : {int(s.mode), int(s.side), s.slip, int(run.left()), int(run.stuck())})
    out.push_back(static_cast<std::uint64_t>(value));
  return out;
}

class PlanarLanes : public testing::Test {
 protected:
  PlanarLanes() {
    for (unsigned seed = 0; seed < 800; ++seed) members_.push_back(random_member(seed));
  }
  int count() const { return static_cast<int>(members_.size()); }
  const Member& at(int i) const { return members_[static_cast<std::size_t>(i)]; }

  std::vector<Member> members_;
};

TEST_F(PlanarLanes, runs_have_the_bits_that_they_have_alone_and_those_that_fail_disturb_none) {
  int left = 0, stuck = 0, fell = 0, ended = 0;
  std::array<int, 5> modes{};
  std::vector<std::vector<std::uint64_t>> alone;
  for (const Member& member : members_) {
    const std::unique_ptr<PlanarRun> run = run_of(member);
    while (!run->over()) {
      run->advance();
      ++modes[static_cast<std::size_t>(run->step().start.mode)];
    }
    left += run->left(), stuck += run->stuck(), fell += run->beyond_since().has_value();
    alone.push_back(outcome(*run));
  }
  run_in_lanes(
      count(), [&](int i) { return run_of(at(i)); },
      [&](int i, const PlanarRun& run) {
        ++ended;
        EXPECT_EQ(outcome(run), alone[static_cast<std::size_t>(i)]) << i;
      },
      k_never_give_up);
  EXPECT_EQ(ended, count());
  EXPECT_GT(left, 20);
  EXPECT_GT(stuck, 20);
  EXPECT_GT(fell, 100);
  for (const int steps : modes) EXPECT_GT(steps, 1000);
}

TEST_F(PlanarLanes, runs_do_not_depend_on_which_others_there_are) {
  std::vector<std::vector<std::uint64_t>> forth(members_.size()), back(members_.size());
  run_in_lanes(
      count(), [&](int i) { return run_of(at(i)); },
      [&](int i, const PlanarRun& run) { forth[static_cast<std::size_t>(i)] = outcome(run); },
      k_never_give_up);
  int ended = 0;
  run_in_lanes(
      count(), [&](int i) { return i % 3 == 0 ? nullptr : run_of(at(count() - 1 - i)); },
      [&](int i, const PlanarRun& run) {
        ++ended;
        back[static_cast<std::size_t>(count() - 1 - i)] = outcome(run);
      },
      k_never_give_up);
  EXPECT_EQ(ended, count() - (count() + 2) / 3);
  for (std::size_t i = 0; i < back.size(); ++i)
    if (!back[i].empty()) {
      EXPECT_EQ(back[i], forth[i]) << i;
    }
}

// Some are slow and some quick, and they come in no order: the lanes of those that end are filled.
TEST_F(PlanarLanes, lanes_are_busy) {
  const LaneUse use = run_in_lanes(
      count(), [&](int i) { return run_of(at(i)); }, [](int, const PlanarRun&) {}, k_never_give_up);
  EXPECT_GT(use.share(), 0.7);
  EXPECT_LE(use.share(), 1);
}

TEST_F(PlanarLanes, giving_up_ends_them) {
  int asked = 0, ended = 0;
  run_in_lanes(
      count(), [&](int i) { return run_of(at(i)); }, [&](int, const PlanarRun&) { ++ended; },
      [&] { return ++asked == 100; });
  EXPECT_EQ(asked, 100);
  EXPECT_LT(ended, count());
}

}  // namespace
}  // namespace topple::planar
