// Friction: closed forms of the sliding block, where Shenton's modes meet, flight.
#include <gtest/gtest.h>

#include "unit/solver/planar/planar_blocks.h"

namespace topple::planar::test {
namespace {

Block slab(double friction) {
  return uniform_block(0.5, 0.01, friction);
}

// Slips from phi = asin(eta) until cos phi - cos t = eta (t - phi), in phases of the floor.
struct SlipStop {
  double begins, ends, slip;  // rad, rad, over a0/w^2
};
SlipStop slip_stop(double eta) {
  const double phi = std::asin(eta);
  double low = phi + 0.1, high = phi + k_pi;
  for (int i = 0; i < 100; ++i) {
    const double t = (low + high) / 2;
    (std::cos(phi) - std::cos(t) - eta * (t - phi) > 0 ? low : high) = t;
  }
  const double t = low - phi;
  return {phi, low, t * std::cos(phi) - (std::sin(low) - std::sin(phi)) - eta * t * t / 2};
}

TEST(PlanarSliding, slip_with_stops_is_the_closed_form) {
  const double a0 = 7, w = 2 * k_pi * 2;
  for (const double friction : {0.45, 0.5, 0.6, 0.7}) {
    const Block block = slab(friction);
    const Shake shake = sine_shake(a0, 2);
    const ShakenPlane plane{{&shake, 1}};
    const SlipStop exact = slip_stop(friction * k_standard_gravity / a0);
    const PlanarRun run = run_planar(block, shaken(plane), standing(), 4, {}, 16);
    ASSERT_EQ(run.events.size(), 16U) << friction;
    double x = 0;
    for (std::size_t half = 0; half < 8; ++half) {
      const PlanarEvent &begin = run.events[2 * half], &end = run.events[2 * half + 1];
      const double since = static_cast<double>(half) * k_pi;
      EXPECT_EQ(begin.event, Event::slip);
      EXPECT_EQ(end.event, Event::stick);
      EXPECT_NEAR(begin.after.time, (since + exact.begins) / w, 1e-9) << friction << ' ' << half;
      EXPECT_NEAR(end.after.time, (since + exact.ends) / w, 1e-9) << friction << ' ' << half;
      EXPECT_NEAR(std::abs(end.after.x - x), a0 / (w * w) * exact.slip, 1e-9) << friction << ' ' << half;
      x = end.after.x;
    }
  }
}

TEST(PlanarSliding, slip_without_stops_has_the_closed_peak_to_peak) {
  const double a0 = 7, w = 2 * k_pi * 2;
  for (const double friction : {0., 0.1, 0.3}) {
    const Block block = slab(friction);
    const Shake shake = sine_shake(a0, 2);
    const ShakenPlane plane{{&shake, 1}};
    // without friction the floor moves on beneath: x = (a0/w^2)(sin wt - w t)
    const State start = standing(0, 0, friction == 0 ? a0 / w : 0);
    const PlanarRun run = run_planar(block, shaken(plane), start, 60);
    const double eta = friction * k_standard_gravity / a0;
    const double exact = 2 * a0 / (w * w) * std::sqrt(1 - std::pow(k_pi * eta / 2, 2));
    ASSERT_GT(run.events.size(), 200U);
    const PlanarEvent &last = run.events.back(), &before = run.events[run.events.size() - 2];
    EXPECT_EQ(last.event, Event::reversal);
    EXPECT_NEAR(std::abs(last.after.x - before.after.x), exact, 1e-9) << friction;
  }
}

TEST(PlanarSliding, static_friction_holds_until_it_is_exceeded) {
  Block block = slab(0.3);
  block.static_friction = 0.5;
  const Shake shake = sine_shake(7, 2);
  const ShakenPlane plane{{&shake, 1}};
  const PlanarRun run = run_planar(block, shaken(plane), standing(), 2);
  EXPECT_NEAR(run.events[0].after.time, std::asin(0.5 * k_standard_gravity / 7) / (4 * k_pi), 1e-9);
  const Block weak = slab(0.3);
  EXPECT_NEAR(run_planar(weak, shaken(plane), standing(), 2).events[0].after.time,
              std::asin(0.3 * k_standard_gravity / 7) / (4 * k_pi), 1e-9);
}

Mode mode_under(const Block& block, const SteadyFloor& floor) {
  State state = standing();
  Step step;
  advance(block, moved(floor), {}, 1e-9, state, step);
  return step.start.mode;
}

// Shenton (1996): with a = a_p/g, s = h/b, a block that a push finds at rest
//   rests for a < mu, a < 1/s; slides for mu < a, mu < 1/s; rocks for a > 1/s and
//   mu > ((4 + s^2) a + 3 s)/(1 + 4 s^2 + 3 s a); slides and rocks in between
TEST(PlanarSliding, modes_meet_where_shenton_states) {
  const double half_base = 0.25;
  constexpr double k_aside = 1e-12;
  for (const double s : {1.5, 3., 8.})
    for (const double vertical : {0., -3., 4.}) {
      const double g = k_standard_gravity + vertical;
      const auto mode = [&](double a, double friction) {
        return mode_under(uniform_block(half_base, s * half_base, friction), {a * g, vertical});
      };
      EXPECT_EQ(mode(1 / s - k_aside, 1 / s), Mode::rest) << s;
      EXPECT_EQ(mode(0.5 / s, 0.5 / s + k_aside), Mode::rest) << s;
      EXPECT_EQ(mode(0.5 / s, 0.5 / s - k_aside), Mode::slide) << s;
      for (const double a : {1.01 / s, 1.5 / s, 1.2}) {
        const double least = ((4 + s * s) * a + 3 * s) / (1 + 4 * s * s + 3 * s * a);
        SCOPED_TRACE(testing::Message() << s << ' ' << a << ' ' << least);
        EXPECT_EQ(mode(a, least + k_aside), Mode::rock);
        EXPECT_EQ(mode(a, least - k_aside), Mode::slide_rock);
        EXPECT_EQ(mode(a, 1 / s + k_aside), Mode::slide_rock);
        EXPECT_EQ(mode(a, 1 / s - k_aside), Mode::slide);
      }
    }
}

TEST(PlanarSliding, without_friction_the_centre_of_gravity_of_a_tilted_block_falls_straight) {
  const Block block = uniform_block(0.19, 0.895, 0);
  const State start = standing(0.1);
  const double x = centre_of_gravity(block, start).x;
  const PlanarRun run = run_planar(block, floor_at_rest(), start, 5);
  ASSERT_GT(run.events.size(), 3U);
  for (const PlanarEvent& one : run.events) EXPECT_NEAR(centre_of_gravity(block, one.after).x, x, 1e-11);
}

TEST(PlanarSliding, a_floor_that_falls_faster_than_bodies_do_loses_the_block) {
  const Block block = uniform_block(0.19, 0.895, 0.5);
  const double a0 = 15, w = 2 * k_pi * 1.5;
  const Shake shake = sine_shake(-a0, 1.5, Vec3::UnitZ());
  const ShakenPlane plane{{&shake, 1}};
  const PlanarRun run = run_planar(block, shaken(plane), standing(), 3, {}, 2);
  ASSERT_EQ(run.events.size(), 2U);
  EXPECT_EQ(run.events[0].event, Event::take_off);
  const double leaves = std::asin(k_standard_gravity / a0);
  EXPECT_NEAR(run.events[0].after.time, leaves / w, 1e-9);
  // gap = -g t^2/2 + (a0/w^2)(cos phi t w - (sin(phi + w t) - sin phi))
  const double t = run.events[1].after.time - leaves / w;
  const double gap =
      -k_standard_gravity * t * t / 2 +
      a0 / (w * w) * (std::cos(leaves) * w * t - (std::sin(leaves + w * t) - std::sin(leaves)));
  EXPECT_GT(t, 0.1);
  EXPECT_NEAR(gap, 0, 1e-9);
  EXPECT_EQ(run.events[1].event, Event::landing);
  EXPECT_EQ(run.state.mode, Mode::rest);
}

TEST(PlanarSliding, a_thrown_block_flies_a_parabola_until_an_edge_lands) {
  const Block block = uniform_block(0.19, 0.895, 0.5);
  State start;
  start.mode = Mode::flight;
  start.z = 2, start.tilt = 0.3, start.x_velocity = 1.1, start.z_velocity = 2, start.rate = 0.7;
  const PlanarRun run = run_planar(block, floor_at_rest(), start, 3, {}, 1);
  ASSERT_EQ(run.last, Event::landing);
  const State& hit = run.events[0].before;
  EXPECT_NEAR(hit.x, 1.1 * hit.time, 1e-12);
  EXPECT_NEAR(hit.z, 2 + 2 * hit.time - k_standard_gravity / 2 * hit.time * hit.time, 1e-12);
  EXPECT_NEAR(hit.tilt, 0.3 + 0.7 * hit.time, 1e-12);
  EXPECT_NEAR(hit.z, block.right * std::sin(hit.tilt) + block.height * std::cos(hit.tilt), 1e-12);
}

// A rod that slips forward on its edge, mu X Z beyond k^2 + X^2: no force that friction allows keeps the edge
// out of the floor (Painleve), so it stops at once, about the edge with the angular momentum that it had
// there.
TEST(PlanarSliding, a_slip_that_would_press_the_edge_into_the_floor_stops_at_once) {
  const Block block = uniform_block(0.02, 1, 1.6);
  const double tilt = -0.6, speed = 0.5;  // on the left edge, the centre of gravity beyond it
  State state = standing(tilt, 0, speed);
  const Lever r = lever(block, Side::left, tilt);
  ASSERT_LT(1 + r.x * (r.x + block.kinetic_friction * r.z) / block.inertia_over_mass(), 0);
  Step step;
  advance(block, floor_at_rest(), {}, 1e-6, state, step);
  EXPECT_EQ(step.start.mode, Mode::rock);
  EXPECT_NEAR(step.start.rate, -r.z * speed / (block.inertia_over_mass() + r.x * r.x + r.z * r.z), 1e-14);
}

// Nothing drags it along: seen from the floor it goes as the floor does the other way,
//   x = -(A/w) (t - sin(w t)/w), from rest and through every instant at which its velocity is zero.
TEST(PlanarSliding, without_friction_it_stays_where_it_is_in_space) {
  const double amplitude = 6, frequency = 0.7, w = 2 * k_pi * frequency;
  const std::vector<Shake> shakes{sine_shake(amplitude, frequency)};
  const ShakenPlane plane{shakes};
  const PlanarRun run = run_planar(uniform_block(0.1, 0.9, 0), shaken(plane), standing(), 7);
  EXPECT_EQ(run.state.time, 7);
  EXPECT_EQ(run.state.mode, Mode::slide);
  EXPECT_NEAR(run.state.x, -amplitude / w * (7 - std::sin(w * 7) / w), 1e-9);
}

TEST(PlanarSliding, a_floor_whose_velocity_jumps_leaves_the_block_behind) {
  const Block block = slab(0.3);
  const PlanarRun run = run_planar(block, floor_at_rest(), left_behind(standing(), 1.2), 3);
  const double decelerates = 0.3 * k_standard_gravity;
  EXPECT_NEAR(run.first(Event::stick).after.time, 1.2 / decelerates, 1e-12);
  EXPECT_NEAR(run.state.x, -1.2 * 1.2 / (2 * decelerates), 1e-12);
  EXPECT_EQ(run.state.mode, Mode::rest);
}

// The impulse of an impact beyond the cone of friction: momentum along the floor by kinetic friction alone.
TEST(PlanarSliding, an_impact_beyond_the_cone_of_friction_slips) {
  Block block = uniform_block(0.3, 0.8, 1.5);
  const double tilt = 0.1;
  const State start = referred(block, standing(tilt), Mode::flight, Side::right);
  for (const double friction : {0.05, 0.1, 1.5}) {
    block.static_friction = block.kinetic_friction = friction;
    State high = start;
    high.z += 0.1;
    const PlanarRun run = run_planar(block, floor_at_rest(), high, 3, {}, 1);
    ASSERT_EQ(run.last, Event::landing);
    const Motion before = centre_of_gravity(block, run.events[0].before),
                 after = centre_of_gravity(block, run.state);
    const double push = after.z_velocity - before.z_velocity, drag = after.x_velocity - before.x_velocity;
    EXPECT_EQ(run.state.mode, friction < 1 ? Mode::slide_rock : Mode::rock);
    if (friction < 1)
      EXPECT_NEAR(drag, -run.state.slip * friction * push, 1e-14);
    else
      EXPECT_LT(std::abs(drag), friction * push);
    const Lever r = lever(block, run.state.side, run.state.tilt);
    EXPECT_NEAR(block.inertia_over_mass() * (run.state.rate - run.events[0].before.rate),
                r.z * drag - r.x * push, 1e-14);
  }
}

}  // namespace
}  // namespace topple::planar::test
