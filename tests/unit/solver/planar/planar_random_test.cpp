// Random blocks, floors and starts: Newton's laws and Coulomb's at all times, no event missed, no energy
// made.
#include <gtest/gtest.h>

#include <random>

#include "unit/solver/planar/planar_blocks.h"

namespace topple::planar::test {
namespace {

struct RandomCase {
  Block block;
  std::vector<Shake> shakes;
  State start;
};

RandomCase random_case(unsigned seed, bool shaken = true) {
  std::mt19937 rng(seed);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng()) / 0x1p32;
  };
  const auto chance = [&](double share) { return within(0, 1) < share; };
  // one draw a statement: compilers order arguments as they like
  const double half_base = within(0.05, 0.5), half_height = within(0.2, 1.2);
  RandomCase of{uniform_block(half_base, half_height, 0), {}, {}};
  Block& block = of.block;
  block.inertia *= within(0.5, 1.5);
  if (chance(0.5)) block.left = within(0.05, 0.5);
  block.kinetic_friction = chance(0.1) ? 0 : chance(0.1) ? 1.5 : within(0, 1.2);
  block.static_friction = block.kinetic_friction * (chance(0.5) ? 1 : within(1, 1.5));
  if (chance(0.3)) block.restitution = within(0, 1);
  if (shaken) {
    const double across = within(0, 12), frequency = within(0.3, 5);
    of.shakes.push_back(sine_shake(across, frequency));
    const double up = within(0, 14), frequency_up = within(0.3, 5);
    if (chance(0.5)) of.shakes.push_back(sine_shake(up, frequency_up, Vec3::UnitZ()));
    if (chance(0.3)) of.shakes[0].kind = Shake::Kind::pulse, of.shakes[0].duration = within(0.1, 0.8);
  }
  const double tilt = chance(0.5) ? within(-0.3, 0.3) : 0;
  // without friction it slides from the start: from rest the floor would pass it with the speed 0 again and
  // again
  const bool slides = block.kinetic_friction == 0 || chance(0.3);
  of.start = standing(tilt, 0, slides ? within(-2, 2) : 0);
  if (chance(0.2)) {
    of.start = referred(block, of.start, Mode::flight, Side::right);
    of.start.z += within(0.01, 0.5), of.start.rate = within(-2, 2);
  }
  return of;
}

PlanarRun run_case(const RandomCase& of, double until, const Controls& controls = {}, std::size_t most = 1000,
                   const SeenStep& seen = nullptr) {
  const ShakenPlane plane{of.shakes};
  return run_planar(of.block, shaken(plane), of.start, until, controls, most, seen);
}

// Forces by differences of the centre of gravity's velocity, so from nothing but the motion.
void expect_laws(const Block& block, const Step& step, double share) {
  constexpr double k_apart = 2e-6, k_exact = 1e-6;
  if (step.length < 1e-4) return;
  const double since = k_apart + share * (step.length - 2 * k_apart), t = step.start.time + since;
  const State s = state_within(step, t), before = state_within(step, t - k_apart),
              after = state_within(step, t + k_apart);
  const Motion v0 = centre_of_gravity(block, before), v1 = centre_of_gravity(block, after);
  const double f = (v1.x_velocity - v0.x_velocity) / (2 * k_apart) + step.solution.horizontal.at(since);
  const double n = (v1.z_velocity - v0.z_velocity) / (2 * k_apart) + step.solution.vertical.at(since);
  const double scale = k_exact * (10 + std::abs(n) + s.rate * s.rate * s.rate * s.rate);
  const double torque = block.inertia_over_mass() * (after.rate - before.rate) / (2 * k_apart);
  for (const Side side : {Side::left, Side::right}) {
    const State edge = referred(block, s, Mode::rock, side);
    EXPECT_GT(edge.z, -1e-9);
  }
  EXPECT_GT(n, -scale);
  if (s.mode == Mode::flight) {
    EXPECT_NEAR(f, 0, scale);
    EXPECT_NEAR(n, 0, scale);
    EXPECT_NEAR(torque, 0, scale);
    return;
  }
  const bool flat = s.mode == Mode::rest || s.mode == Mode::slide;
  if (flat) {
    EXPECT_LE(-block.height * f, block.right * n + scale);
    EXPECT_LE(block.height * f, block.left * n + scale);
  } else {
    const Lever r = lever(block, s.side, s.tilt);
    EXPECT_NEAR(torque, r.z * f - r.x * n, scale);
  }
  if (s.slip != 0) {
    EXPECT_GE(s.slip * s.x_velocity, -1e-9);
    EXPECT_NEAR(f, -s.slip * block.kinetic_friction * n, scale);
  } else {
    EXPECT_EQ(s.x_velocity, 0);
    EXPECT_LE(std::abs(f), block.static_friction * n + scale);
  }
}

// The forces by which modes are chosen are those of the series.
void expect_forces_of_series(const Block& block, const Step& step) {
  const Solution<double>& s = step.solution;
  if (step.start.mode != Mode::rock && step.start.mode != Mode::slide_rock) return;
  const EdgeForces f = edge_forces({block, s.horizontal[0], s.vertical[0]}, step.start, step.start.slip);
  EXPECT_NEAR(f.normal, s.normal[0], 1e-9 * (1 + std::abs(f.normal)));
  EXPECT_NEAR(f.acceleration, s.rate.or_zero(1), 1e-9 * (1 + std::abs(f.acceleration)));
  if (step.start.slip == 0) {
    EXPECT_NEAR(f.tangential, s.tangential[0], 1e-9 * (1 + std::abs(f.tangential)));
  }
}

TEST(PlanarRandom, forces_keep_newtons_and_coulombs_laws) {
  std::array<int, 5> steps{};
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    const RandomCase of = random_case(seed);
    const PlanarRun run = run_case(of, 4, {}, 1000, [&](const Step& step) {
      ++steps[static_cast<std::size_t>(step.start.mode)];
      expect_forces_of_series(of.block, step);
      for (const double share : {0.03, 0.3, 0.5, 0.8, 0.99}) expect_laws(of.block, step, share);
    });
    EXPECT_NE(run.last, Event::stalled);
    if (HasFailure()) break;
  }
  for (const int count : steps) EXPECT_GT(count, 1000);
}

// Steps of 1 ms, a hundredth of what the series hold. Impacts magnify differences: the first twelve events.
TEST(PlanarRandom, no_event_is_missed) {
  std::size_t events = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    const RandomCase of = random_case(seed);
    Controls fine;
    fine.longest = 1e-3;
    const PlanarRun run = run_case(of, 4, {}, 12), other = run_case(of, 4, fine, 12);
    ASSERT_EQ(run.events.size(), other.events.size());
    for (std::size_t i = 0; i < run.events.size(); ++i) {
      ASSERT_EQ(run.events[i].event, other.events[i].event)
          << i << ' ' << word(run.events[i].event) << ' ' << run.events[i].after.time << ' '
          << word(other.events[i].event) << ' ' << other.events[i].after.time;
      ASSERT_NEAR(run.events[i].after.time, other.events[i].after.time, 1e-9) << i;
    }
    events += run.events.size();
  }
  EXPECT_GT(events, 5000U);
}

TEST(PlanarRandom, energy_is_kept_between_events_and_never_made) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    const RandomCase of = random_case(seed, false);
    double left = energy(of.block, of.start);
    run_case(of, 4, {}, 1000, [&](const Step& step) {
      const double begin = energy(of.block, step.start);
      const double end = energy(of.block, state_within(step, step.start.time + step.length));
      EXPECT_LE(begin, left + 1e-10);
      if (step.start.slip == 0 || of.block.kinetic_friction == 0)
        EXPECT_NEAR(end, begin, 1e-10);
      else
        EXPECT_LE(end, begin + 1e-10);
      left = end;
    });
    if (HasFailure()) break;
  }
}

// A fall without events; the term of order n is the last of the accelerations: error h^(n+1).
TEST(PlanarRandom, order_of_convergence_is_that_of_the_series) {
  const Block block = uniform_block(0.19, 0.895, 1.5);
  const Shake shake = sine_shake(1, 2);
  const ShakenPlane plane{{&shake, 1}};
  const auto tilt = [&](double step, int order) {
    Controls controls;
    controls.tolerance = 0, controls.longest = step, controls.order = order;
    return run_planar(block, shaken(plane), standing(0.15), 0.8, controls).state.tilt;
  };
  const double exact = tilt(0.005, 16);
  for (const int order : {3, 5, 7, 9, 10, 12}) {
    const double coarse = std::abs(tilt(0.16, order) - exact), fine = std::abs(tilt(0.08, order) - exact);
    EXPECT_GT(std::log2(coarse / fine), order + 0.5) << order << ' ' << coarse << ' ' << fine;
  }
}

TEST(PlanarRandom, copied_state_goes_on_with_the_same_bits) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const RandomCase of = random_case(seed);
    const ShakenPlane plane{of.shakes};
    const Floor floor = shaken(plane);
    State whole = of.start, parts = of.start;
    Step step;
    for (int i = 0; i < 30 && whole.time < 4; ++i) {
      Step fresh;
      advance(of.block, floor, {}, 4, whole, step);
      advance(of.block, floor, {}, 4, parts, fresh);
      EXPECT_EQ(whole.tilt, parts.tilt);
      EXPECT_EQ(whole.x, parts.x);
      EXPECT_EQ(whole.time, parts.time);
    }
  }
}

}  // namespace
}  // namespace topple::planar::test
