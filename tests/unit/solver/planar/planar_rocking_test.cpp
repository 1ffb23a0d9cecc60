// Rocking against theory: exact integrals, Housner's impact, pulses that just overturn.
#include <gtest/gtest.h>

#include "unit/solver/planar/planar_blocks.h"
#include "verification/housner.h"

namespace topple::planar::test {
namespace {

double critical_angle(const Block& block) {
  return std::atan2(block.right, block.height);
}
double rate_parameter(const Block& block) {  // p
  const double radius2 = block.right * block.right + block.height * block.height;
  return std::sqrt(block.gravity * std::sqrt(radius2) / (block.inertia_over_mass() + radius2));
}

// From rest at tilt0 to the impact: t = integral of dth/|th'|, th'^2 = 2 p^2 (cos(a - th0) - cos(a - th)),
// with th = th0 - y^2 smooth; Simpson's rule.
double fall_time(const Block& block, double tilt0) {
  const double a = critical_angle(block), p = rate_parameter(block), last = std::sqrt(tilt0);
  const auto slowness = [&](double y) {
    const double half = y * y / 2, sine = y == 0 ? 0.5 : std::sin(half) / (y * y);
    return 1 / (p * std::sqrt(sine * std::sin(a - tilt0 + half)));
  };
  constexpr int k_cells = 2000;
  const double h = last / k_cells;
  double sum = 0;
  for (int i = 0; i < k_cells; ++i)
    sum += h / 6 * (slowness(i * h) + 4 * slowness((i + 0.5) * h) + slowness((i + 1) * h));
  return sum;
}

TEST(PlanarRocking, quarter_period_is_the_exact_integral) {
  for (const double half_base : {0.02, 0.19, 0.6})
    for (const double share : {0.01, 0.3, 0.7, 0.99}) {
      const Block block = uniform_block(half_base, 0.9, 1.5);
      const double tilt = share * critical_angle(block);
      const PlanarRun run = run_planar(block, floor_at_rest(), standing(tilt), 20, {}, 1);
      ASSERT_EQ(run.last, Event::impact) << half_base << ' ' << share;
      EXPECT_NEAR(run.state.time, fall_time(block, tilt), 1e-9) << half_base << ' ' << share;
    }
}

TEST(PlanarRocking, impact_keeps_the_share_of_the_rate_that_housner_states) {
  for (const double half_base : {0.05, 0.2, 0.6})
    for (const double restitution : {0., 0.7, 1.}) {
      Block block = uniform_block(half_base, 0.9, 1.5);
      block.restitution = restitution;
      const double a = critical_angle(block);
      const PlanarRun run = run_planar(block, floor_at_rest(), standing(a / 2), 20, {}, 1);
      const double kept = run.state.rate / run.events[0].before.rate;
      EXPECT_NEAR(kept, restitution * (1 - 1.5 * std::pow(std::sin(a), 2)), 1e-14) << half_base;
    }
}

// From either side, though the share of the rate differs.
TEST(PlanarRocking, greatest_restitution_keeps_the_energy_of_an_impact) {
  Block block = uniform_block(0.2, 0.9, 1.5);
  block.left = 0.3, block.right = 0.12;
  block.restitution = greatest_restitution(block);
  EXPECT_GT(block.restitution, 1);
  for (const int way : {1, -1}) {
    const PlanarRun run = run_planar(block, floor_at_rest(), standing(way * 0.05), 20, {}, 1);
    ASSERT_EQ(run.last, Event::impact);
    const double before = energy(block, run.events[0].before);
    EXPECT_NEAR(energy(block, run.state), before, 1e-12 * before);
  }
  EXPECT_EQ(greatest_restitution(uniform_block(1, 0.5, 1.5)), std::numeric_limits<double>::infinity());
}

// Whatever it falls from: with a factor above 1 no impact gains energy.
TEST(PlanarRocking, no_landing_gains_energy_by_restitution) {
  int landings = 0;
  for (const double friction : {0., 0.3, 1.5})
    for (const double rate : {-1., 0.2, 1., 3.})
      for (const double speed : {-1., 0., 0.5, 1., 2.}) {
        Block block = uniform_block(0.2, 0.9, friction);
        block.restitution = greatest_restitution(block);
        State state;
        state.mode = Mode::flight;
        state.z = block.height;
        state.x_velocity = speed, state.z_velocity = -1e-3, state.rate = rate;
        const State after = fallen_on_base({block, 0, block.gravity}, state, Side::right);
        EXPECT_LE(energy(block, after), energy(block, state) * (1 + 1e-9)) << friction << rate << speed;
        landings += after.rate != 0;
      }
  EXPECT_GT(landings, 10);
}

// About the new edge: k^2 + h^2 - l r over k^2 + h^2 + l^2 when the left one, at l, lands.
TEST(PlanarRocking, edges_at_different_distances_have_ratios_of_their_own) {
  Block block = uniform_block(0.2, 0.9, 1.5);
  block.left = 0.3, block.right = 0.12;
  const double of_centre = block.inertia_over_mass() + block.height * block.height;
  for (const int way : {1, -1}) {
    const PlanarRun run = run_planar(block, floor_at_rest(), standing(way * 0.05), 20, {}, 1);
    const double lands = way > 0 ? block.left : block.right;
    EXPECT_EQ(run.state.side, way > 0 ? Side::left : Side::right);
    EXPECT_NEAR(run.state.rate / run.events[0].before.rate,
                (of_centre - block.left * block.right) / (of_centre + lands * lands), 1e-14);
  }
}

TEST(PlanarRocking, a_broad_block_comes_to_rest_at_its_first_impact) {
  const Block block = uniform_block(0.5, 0.3, 1.2);
  const PlanarRun run = run_planar(block, floor_at_rest(), standing(0.3), 20, {}, 1);
  EXPECT_EQ(run.last, Event::settled);
  EXPECT_EQ(run.state.mode, Mode::rest);
}

TEST(PlanarRocking, mirrored_block_and_floor_give_the_mirrored_motion_bit_for_bit) {
  Block block = uniform_block(0.2, 0.9, 0.35), mirrored = block;
  block.left = mirrored.right = 0.26;
  const Shake there = sine_shake(6, 1.7), back = sine_shake(-6, 1.7);
  const ShakenPlane plane{{&there, 1}}, other{{&back, 1}};
  const PlanarRun a = run_planar(block, shaken(plane), standing(), 5);
  const PlanarRun b = run_planar(mirrored, shaken(other), standing(), 5);
  ASSERT_EQ(a.events.size(), b.events.size());
  EXPECT_GT(a.events.size(), 10U);
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].event, b.events[i].event);
    EXPECT_EQ(a.events[i].after.time, b.events[i].after.time);
    EXPECT_EQ(a.events[i].after.tilt, -b.events[i].after.tilt);
    EXPECT_EQ(a.events[i].after.rate, -b.events[i].after.rate);
    EXPECT_EQ(a.events[i].after.x, -b.events[i].after.x);
  }
}

// Runge-Kutta of fourth order with steps of 0.1 ms: errors of 1e-11 s before impacts magnify them.
TEST(PlanarRocking, shaken_block_lands_when_housners_does) {
  const Block block = uniform_block(0.19, 0.895, 5);
  const topple::test::Block housner{block.right, block.height, 4. / 3};
  const Shake shake = sine_shake(2.2, 1.3);
  const ShakenPlane plane{{&shake, 1}};
  const double tilt = housner.critical / 3;
  const PlanarRun run = run_planar(block, shaken(plane), standing(tilt), 6);
  const topple::test::Rocking other = topple::test::rock(
      housner, {tilt, 0},
      [&](double t) {
        return 2.2 * std::sin(2 * k_pi * 1.3 * t) / (k_standard_gravity * std::tan(housner.critical));
      },
      6, 1e-4);
  ASSERT_EQ(run.events.size(), other.impacts.size());
  ASSERT_GT(other.impacts.size(), 5U);
  for (std::size_t i = 0; i < other.impacts.size(); ++i)
    EXPECT_NEAR(run.events[i].after.time, other.impacts[i], 1e-9) << i;
}

double root_of(const std::function<double(double)>& f, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) < 0 ? low : high) = middle;
  }
  return low;
}

bool falls(const Block& block, const Shake& shake) {
  const ShakenPlane plane{{&shake, 1}};
  Controls controls;
  controls.last_tilt = 1.5 * critical_angle(block);
  return run_planar(block, shaken(plane), standing(), 60, controls).overturned();
}

// A block with a = 1e-4 differs from the linear one by a^2 = 1e-8 of its restoring moment.
TEST(PlanarRocking, least_half_sine_that_overturns_a_slender_block) {
  const Block block = uniform_block(1e-4, 1, 1.5);
  const double p = rate_parameter(block), a = critical_angle(block);
  for (const double w_over_p : {2., 4., 6.}) {
    const double limit = root_of(
        [&](double A) {
          return std::sqrt(A * A - 1) + A * std::exp(-(k_pi - std::asin(1 / A)) / w_over_p) - w_over_p;
        },
        1.0001, 20);
    Shake shake = sine_shake(0, 1);
    shake.kind = Shake::Kind::pulse, shake.shape = Shake::Shape::half_sine;
    shake.duration = k_pi / (w_over_p * p);
    for (const double share : {1 - 1e-7, 1 + 1e-7}) {
      shake.amplitude = share * limit * k_standard_gravity * a;
      EXPECT_EQ(falls(block, shake), share > 1) << w_over_p << ' ' << limit;
    }
  }
}

// cosh(p t) = 1 + 1/(2 A (A - 1))
TEST(PlanarRocking, least_rectangle_that_overturns_a_slender_block) {
  const Block block = uniform_block(1e-4, 1, 1.5);
  const double p = rate_parameter(block), a = critical_angle(block);
  for (const double A : {1.2, 2., 5.}) {
    Shake shake = sine_shake(A * k_standard_gravity * a, 1);
    shake.kind = Shake::Kind::pulse, shake.shape = Shake::Shape::rectangle;
    const double limit = std::acosh(1 + 1 / (2 * A * (A - 1))) / p;
    for (const double share : {1 - 1e-7, 1 + 1e-7}) {
      shake.duration = share * limit;
      EXPECT_EQ(falls(block, shake), share > 1) << A;
    }
  }
}

// Infinitely many impacts in finite time; the rates and the times between are a geometric sequence at last.
TEST(PlanarRocking, rocking_ends_within_the_stated_error) {
  const Block block = uniform_block(0.19, 0.895, 1.5);
  const PlanarRun run = run_planar(block, floor_at_rest(), standing(0.1), 60);
  const std::vector<PlanarEvent>& e = run.events;
  ASSERT_EQ(e.back().event, Event::settled);
  const double kept = 1 - 1.5 * std::pow(std::sin(critical_angle(block)), 2);
  const double pause = e.back().after.time - e[e.size() - 2].after.time;
  const double q = block.gravity * block.right /
                   (block.inertia_over_mass() + block.right * block.right + block.height * block.height);
  EXPECT_LT(pause * kept / (1 - kept), 1.01 * std::sqrt(8 * k_settled / q) / (1 - kept));
  EXPECT_LT(std::abs(e.back().before.rate) * kept, std::sqrt(2 * q * k_settled));
  EXPECT_EQ(run.state.mode, Mode::rest);
  EXPECT_EQ(run.state.time, 60);
}

TEST(PlanarRocking, block_whose_centre_of_gravity_lies_beside_its_base_falls_at_once) {
  for (const int way : {1, -1}) {
    Block block = uniform_block(0.2, 0.9, 0.8);
    (way > 0 ? block.right : block.left) = -0.01;
    const PlanarRun run = run_planar(block, floor_at_rest(), standing(), 20);
    EXPECT_TRUE(run.overturned());
    EXPECT_GT(way * run.state.tilt, 1.5);
    EXPECT_EQ(run.events.front().event == Event::uplift, false);  // no event: decided at the start
  }
}

TEST(PlanarRocking, edges_without_distance_stand_until_touched) {
  Block block = uniform_block(0.2, 0.9, 0.8);
  block.left = block.right = 0;
  EXPECT_EQ(run_planar(block, floor_at_rest(), standing(), 5).state.mode, Mode::rest);
  EXPECT_TRUE(run_planar(block, floor_at_rest(), standing(0, 1e-6), 60).overturned());
}

}  // namespace
}  // namespace topple::planar::test
