#include "solver/model/excitation.h"

#include <gtest/gtest.h>

#include <numeric>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

Shake shake_of(double amplitude, double frequency) {
  Shake s;
  s.amplitude = amplitude;
  s.frequency = frequency;
  return s;
}

double along(const Shake& s, double t) {
  return shake_acceleration(s, t).dot(s.direction);
}

double derivative(const Shake& s, double t) {
  const double h = 1e-5;
  return (along(s, t + h) - along(s, t - h)) / (2 * h);
}

TEST(Excitation, sine_is_a_sin_of_2_pi_f_since_its_start) {
  Shake s = shake_of(3, 0.7);
  s.start = 1.3;
  EXPECT_EQ(along(s, 1.2999), 0);
  EXPECT_EQ(along(s, 1.3), 0);
  for (double tau : {0.01, 0.4, 1.7, 20.})
    EXPECT_NEAR(along(s, 1.3 + tau), 3 * std::sin(2 * k_pi * 0.7 * tau), 1e-13);
  // it starts rising with A w
  EXPECT_NEAR((along(s, 1.3 + 1e-6)) / 1e-6, 3 * 2 * k_pi * 0.7, 1e-6);
}

TEST(Excitation, cycles_end_the_sine_without_a_step) {
  Shake s = shake_of(3, 2);
  s.cycles = 5;
  EXPECT_EQ(along(s, 2.5), 0);
  EXPECT_EQ(along(s, 7), 0);
  EXPECT_NEAR(along(s, 2.5 - 1e-9), 0, 1e-6);
  EXPECT_NEAR(along(s, 2.375), -3, 1e-12);
}

TEST(Excitation, taper_rises_and_falls_smoothly) {
  Shake s = shake_of(3, 2);
  s.cycles = 10;
  s.taper = 2;  // cycles: 1 s
  // full in the middle
  EXPECT_NEAR(along(s, 2.125), 3, 1e-12);
  // envelope at a quarter of a cycle in: (1 - cos(pi/8))/2
  EXPECT_NEAR(along(s, 0.125), 3 * (1 - std::cos(k_pi / 8)) / 2, 1e-12);
  // mirrored at the end
  for (double t : {0.05, 0.3, 0.7, 1.2}) EXPECT_NEAR(along(s, t), -along(s, 5 - t), 1e-12) << t;
  // value and slope vanish at both ends, and the slope has no step where the taper meets the plateau
  for (double t : {1e-4, 5 - 1e-4}) {
    EXPECT_LT(std::abs(along(s, t)), 1e-8);
    EXPECT_LT(std::abs(derivative(s, t)), 1e-4);
  }
  for (double t : {1., 4.}) EXPECT_NEAR(derivative(s, t - 1e-4), derivative(s, t + 1e-4), 0.01);
}

TEST(Excitation, pulses_have_the_integrals_of_their_shapes) {
  Shake s;
  s.kind = Shake::Kind::pulse;
  s.amplitude = 2;
  s.duration = 0.8;
  s.start = 0.3;
  const auto integral = [&] {
    const int n = 8000;
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += along(s, (i + 0.5) * 2 / n) * 2 / n;
    return sum;
  };
  s.shape = Shake::Shape::half_sine;
  EXPECT_NEAR(integral(), 2 * 2 * 0.8 / k_pi, 1e-6);
  s.shape = Shake::Shape::full_sine;
  EXPECT_NEAR(integral(), 0, 1e-6);
  EXPECT_NEAR(along(s, 0.3 + 0.2), 2, 1e-12);
  s.shape = Shake::Shape::rectangle;
  EXPECT_NEAR(integral(), 2 * 0.8, 1e-6);
  for (auto shape : {Shake::Shape::half_sine, Shake::Shape::full_sine, Shake::Shape::rectangle}) {
    s.shape = shape;
    EXPECT_EQ(along(s, 0.2999), 0);
    EXPECT_EQ(along(s, 1.1001), 0);
  }
}

TEST(Excitation, shakes_add_up_along_their_directions) {
  Shake a = shake_of(1, 1), b = shake_of(2, 3);
  b.direction = Vec3(0, 0.6, 0.8);
  const Vec3 sum = floor_acceleration({a, b}, 0.1);
  const Vec3 exact = std::sin(0.2 * k_pi) * Vec3::UnitX() + 2 * std::sin(0.6 * k_pi) * b.direction;
  EXPECT_LT((sum - exact).norm(), 1e-14);
  EXPECT_EQ(floor_acceleration({}, 1), Vec3(Vec3::Zero()));
}

TEST(Excitation, the_greatest_acceleration_is_a_bound_that_one_shake_reaches) {
  std::vector<Shake> shakes{shake_of(3, 2)};
  shakes[0].direction = Vec3(0.6, 0.8, 0);
  EXPECT_EQ(greatest_acceleration(shakes), 3);
  EXPECT_NEAR(floor_acceleration(shakes, 0.125).norm(), 3, 1e-12);
  for (const PulseTraits& shape : pulse_shapes()) {
    Shake pulse = shake_of(-2, 1);
    pulse.kind = Shake::Kind::pulse;
    pulse.shape = shape.kind;
    pulse.duration = 0.5;
    std::vector<Shake> all{shakes[0], pulse};
    EXPECT_DOUBLE_EQ(greatest_acceleration(all), 5) << shape.word;
    double reached = 0;
    for (int i = 0; i <= 1000; ++i) {
      EXPECT_LE(floor_acceleration(all, 1e-3 * i).norm(), 5 + 1e-12);
      reached = std::max(reached, shake_acceleration(pulse, 1e-3 * i).norm());
    }
    EXPECT_NEAR(reached, 2, 1e-3) << shape.word;
    all[0].on = all[1].on = false;
    EXPECT_EQ(greatest_acceleration(all), 0);
  }
}

TEST(Excitation, jump_makes_the_floors_displacement_a_pure_sine) {
  // speed a/w and travel a/w^2
  for (const auto& [gal, f, speed, travel] :
       {std::tuple{190., 0.5, 0.605, 0.193}, std::tuple{700., 2., 0.557, 0.0443}}) {
    SCOPED_TRACE(f);
    Shake s = shake_of(gal * k_gal, f);
    s.initial_velocity = Shake::Start::jump;
    double v = floor_velocity_jump({s}, -1e-9, 1e-9).x(), x = 0, greatest = 0;
    EXPECT_NEAR(v, -speed, 5e-4);
    const int n = 20000;
    const double w = 2 * k_pi * f, h = 2 / f / n;
    for (int i = 0; i < n; ++i) {
      const double a = along(s, (i + 0.5) * h);
      x += h * (v + h / 2 * a);
      v += h * a;
      ASSERT_NEAR(x, -gal * k_gal / (w * w) * std::sin(w * (i + 1) * h), 1e-6);
      greatest = std::max(greatest, std::abs(x));
    }
    EXPECT_NEAR(greatest, travel, 5e-4);
    s.initial_velocity = Shake::Start::rest;
    EXPECT_EQ(floor_velocity_jump({s}, -1, 1), Vec3(Vec3::Zero()));
  }
}

TEST(Excitation, a_floating_body_stays_where_it_is_while_the_floor_jumps_into_a_sine) {
  // in the floor's frame it moves as the floor's displacement with the other sign
  for (double start : {0., 0.3, 0.1 * 3, 0.12345}) {
    SCOPED_TRACE(start);
    Parameters p = weightless();
    Shake s = shake_of(1.9, 0.5);
    s.initial_velocity = Shake::Start::jump;
    s.direction = Vec3(0.6, 0.8, 0);
    s.start = start;
    p.shakes.push_back(s);
    p.time_step = 5e-4;
    Simulation sim(sled(1, 0.06, 1), {BodyStart{}}, p);
    const Vec3 x0 = sim.state.position[1];
    ASSERT_TRUE(sim.advance(3000));
    const double w = k_pi, tau = 1.5 - start;
    const Vec3 exact = 1.9 / (w * w) * std::sin(w * tau) * s.direction;
    // second order in h, and a start between two steps is moved to the earlier one
    const double off_grid = start - 5e-4 * std::floor(start / 5e-4 + 1e-6);
    EXPECT_LT((sim.state.position[1] - x0 - exact).norm(), 1e-6 + 1.3 * 0.605 * off_grid);
    EXPECT_LT(sim.state.energy.balance_error(), 1e-6);
  }
}

TEST(Excitation, a_floor_jumps_once_however_the_time_step_is_edited) {
  for (const double first : {1e-4, 1e-3}) {
    SCOPED_TRACE(first);
    Parameters p = weightless();
    Shake s = shake_of(1.9, 0.5);
    s.initial_velocity = Shake::Start::jump;
    s.start = 0.01;
    p.shakes.push_back(s);
    p.time_step = 1e-3;
    Simulation sim(sled(1, 0.06, 1), {BodyStart{}}, p);
    ASSERT_TRUE(sim.advance(9));
    sim.parameters.time_step = first;
    while (sim.state.time < 0.01 - 1e-9) ASSERT_TRUE(sim.advance(1));
    ASSERT_TRUE(sim.advance(1));
    sim.parameters.time_step = 1.1e-3 - first;
    ASSERT_TRUE(sim.advance(3));
    const double jump = 1.9 / (2 * k_pi * 0.5);
    // the floor goes on at the rate of its acceleration: 1.9 pi (t - start) at most
    EXPECT_NEAR(sim.state.velocity[1].x(), jump, 1.9 * k_pi * 1e-4);
  }
}

TEST(Excitation, floor_filter_reaches_the_closed_form_of_its_steady_state) {
  const double c = std::sqrt(2.) * 2 * k_pi * k_floor_corner, k = std::pow(2 * k_pi * k_floor_corner, 2);
  for (double f : {0.02, 0.05, 0.5, 2.}) {
    SCOPED_TRACE(f);
    const double w = 2 * k_pi * f, h = std::min(1e-2, 1 / (400 * f));
    Vec3 d = Vec3::Zero(), v = Vec3::Zero();
    // 100 s: the free part decays with exp(-c t/2), to 2e-10
    int i = 0;
    const Vec3 along(1, -2, 0.5);
    for (; i * h < 100; ++i)
      advance_floor(d, v, std::sin(w * i * h) * along, std::sin(w * (i + 1) * h) * along, h);
    const double t = i * h, real = k - w * w, imaginary = c * w, size2 = real * real + imaginary * imaginary;
    const double exact = (real * std::sin(w * t) - imaginary * std::cos(w * t)) / size2;
    const double speed = w * (real * std::cos(w * t) + imaginary * std::sin(w * t)) / size2;
    // trapezoidal rule: (w h)^2/12 of the amplitude
    const double tolerance = (w * h) * (w * h) / 6 + 1e-6;
    EXPECT_LT((d - exact * along).norm(), tolerance / std::sqrt(size2) * along.norm());
    EXPECT_LT((v - speed * along).norm(), tolerance * w / std::sqrt(size2) * along.norm());
  }
  // far above the corner the displacement is that of the bare double integral: 0.193 m at 190 gal, 0.5 Hz
  const double w = k_pi;
  EXPECT_NEAR(1.9 / std::hypot(k - w * w, c * w), 0.193, 1e-3);
}

TEST(Excitation, floor_filter_forgets_a_constant_and_is_linear) {
  Vec3 d = Vec3::Zero(), v(0.1, 0, 0);
  for (int i = 0; i < 10000; ++i) advance_floor(d, v, Vec3::Zero(), Vec3::Zero(), 1e-2);
  EXPECT_LT(d.norm() + v.norm(), 1e-8);
}

Shake sweep(double first, double last, double duration) {
  Shake s = shake_of(3, first);
  s.kind = Shake::Kind::sweep;
  s.last_frequency = last;
  s.duration = duration;
  s.start = 1;
  return s;
}

Shake rectangle(double amplitude, double start, double duration) {
  Shake s;
  s.kind = Shake::Kind::pulse;
  s.shape = Shake::Shape::rectangle;
  s.amplitude = amplitude, s.start = start, s.duration = duration;
  return s;
}

// 0.02 + 0.04 - 0.02 and 0.1 + 0.2 are rounded below and above what they stand for.
TEST(Excitation, a_rectangle_jumps_at_its_ends_however_times_are_rounded) {
  for (const auto& [start, duration] : {std::pair(0.02, 0.04), {0.1, 0.2}, {0., 0.3}}) {
    const std::vector<Shake> shakes{rectangle(5, start, duration)};
    for (const double rounded : {-1e-12, 0., 1e-12}) {
      const double begins = start + rounded, ends = start + duration + rounded;
      EXPECT_TRUE(acceleration_jumps(shakes, begins) && acceleration_jumps(shakes, ends)) << start;
      EXPECT_EQ(acceleration_until(shakes, begins).x(), 0) << start;
      EXPECT_EQ(acceleration_from(shakes, begins).x(), 5) << start;
      EXPECT_EQ(acceleration_until(shakes, ends).x(), 5) << start;
      EXPECT_EQ(acceleration_from(shakes, ends).x(), 0) << start;
    }
    EXPECT_FALSE(acceleration_jumps(shakes, start + duration / 2)) << start;
  }
  Shake sine = shake_of(3, 2);
  sine.start = 0.5, sine.cycles = 4;
  EXPECT_FALSE(acceleration_jumps({sine}, 0.5) || acceleration_jumps({sine}, 2.5));
}

TEST(Excitation, a_rectangle_that_follows_another_takes_over_from_it) {
  const Shake first = rectangle(5, 0.1, 0.2), second = rectangle(2, 0.3, 0.2);
  for (const std::vector<Shake>& shakes : {std::vector{first, second}, {second, first}}) {
    EXPECT_EQ(acceleration_until(shakes, 0.3).x(), 5);
    EXPECT_EQ(acceleration_from(shakes, 0.3).x(), 2);
  }
}

TEST(Excitation, sweep_takes_as_long_for_each_octave) {
  const Shake s = sweep(0.25, 8, 10);  // five octaves, 2 s each
  for (int octave = 0; octave <= 5; ++octave)
    EXPECT_NEAR(shake_frequency(s, 1 + 2 * octave), 0.25 * std::pow(2, octave), 1e-12);
  const Shake down = sweep(8, 0.25, 10);
  EXPECT_NEAR(shake_frequency(down, 3), 4, 1e-12);
}

TEST(Excitation, sweep_is_the_sine_of_the_integral_of_its_frequency) {
  for (const Shake& s : {sweep(0.2, 5, 8), sweep(5, 0.2, 8)}) {
    double turns = 0;
    constexpr int steps = 4000;
    constexpr double h = 8. / steps;
    for (int i = 0; i < steps; ++i) {
      const double t = 1 + i * h;
      // Simpson
      turns +=
          h / 6 * (shake_frequency(s, t) + 4 * shake_frequency(s, t + h / 2) + shake_frequency(s, t + h));
      if (i + 1 == steps) break;
      ASSERT_NEAR(along(s, t + h), 3 * std::sin(2 * k_pi * turns), 1e-9) << t;
    }
    EXPECT_EQ(along(s, 0.999), 0);
    EXPECT_EQ(along(s, 9), 0);
    EXPECT_EQ(shake_end(s), 9);
  }
}

TEST(Excitation, taper_of_a_sweep_counts_its_own_cycles) {
  Shake plain = sweep(1, 4, 6), s = plain;
  s.taper = 2;
  const double cycles = shake_turns(s, 7);
  for (double t = 1.01; t < 7; t += 0.01) {
    const double turns = shake_turns(s, t);
    const auto rise = [](double x) { return x >= 1 ? 1 : (1 - std::cos(k_pi * x)) / 2; };
    ASSERT_NEAR(along(s, t), along(plain, t) * rise(turns / 2) * rise((cycles - turns) / 2), 1e-12) << t;
  }
}

}  // namespace
}  // namespace topple::test
