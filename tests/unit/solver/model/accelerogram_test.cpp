#include "solver/model/accelerogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "solver/body/step_control.h"
#include "solver/model/excitation.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

/// Samples of no pattern, m/s^2.
std::vector<double> rough_samples(std::size_t count, unsigned seed) {
  std::mt19937 twister(seed);
  std::vector<double> samples;
  for (std::size_t i = 0; i < count; ++i)
    samples.push_back(static_cast<double>(twister()) / 0x1p31 - 1 + (i % 7 == 3 ? 2 : 0));
  return samples;
}

/// Trapezoidal rule from rest, over the interval of 1 s.
std::vector<double> velocities(const std::vector<double>& samples) {
  std::vector<double> v{0};
  for (std::size_t i = 1; i < samples.size(); ++i) v.push_back(v.back() + (samples[i - 1] + samples[i]) / 2);
  return v;
}

double square_sum(const std::vector<double>& values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.);
}

TEST(Accelerogram, is_straight_between_its_samples_and_zero_outside) {
  const auto record = make_accelerogram({{Vec3::UnitY(), 0.5, {2, -4, 6}}});
  const auto along = [&](double tau) { return acceleration(*record, tau).y(); };
  EXPECT_EQ(along(-1e-9), 0);
  EXPECT_EQ(along(0), 2);
  EXPECT_EQ(along(0.125), 0.5);
  EXPECT_EQ(along(0.5), -4);
  EXPECT_EQ(along(0.75), 1);
  EXPECT_EQ(along(1), 6);
  EXPECT_EQ(along(1 + 1e-9), 0);
  EXPECT_EQ(acceleration(*record, 0.75).x(), 0);
  EXPECT_EQ(record->duration, 1);
  EXPECT_EQ(record->interval, 0.5);
  EXPECT_EQ(record->peak, 6);
}

TEST(Accelerogram, components_add_up_each_with_its_own_interval) {
  const Vec3 slant = Vec3(3, 0, 4) / 5;
  const auto record =
      make_accelerogram({{slant, 0.25, {0, 1, 2, 3, 4}}, {Vec3::UnitY(), 0.5, {10, 20, -30}}});
  for (const double tau : {0., 0.1, 0.6, 1.}) {
    const double second = tau < 0.5 ? 10 + 20 * tau : 20 - 100 * (tau - 0.5);
    EXPECT_LT((acceleration(*record, tau) - 4 * tau * slant - second * Vec3::UnitY()).norm(), 1e-13) << tau;
  }
  EXPECT_EQ(record->interval, 0.25);
  EXPECT_EQ(record->strongest, Vec3::UnitY());
  EXPECT_NEAR(record->peak, std::hypot(4, 30), 1e-13);
}

TEST(Accelerogram, removing_the_mean_leaves_none) {
  std::vector<double> samples = rough_samples(1000, 1);
  remove_mean(samples);
  EXPECT_NEAR(std::accumulate(samples.begin(), samples.end(), 0.), 0, 1e-10);
}

TEST(Accelerogram, a_parabola_in_the_record_is_subtracted_whole) {
  const std::vector<double> plain = rough_samples(2000, 2);
  std::vector<double> corrected = plain, drifting, parabola;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const double x = static_cast<double>(i) / 2000;
    parabola.push_back(0.3 - 2 * x + 1.7 * x * x);
    drifting.push_back(plain[i] + parabola.back());
  }
  subtract_parabola(corrected);
  subtract_parabola(drifting);
  subtract_parabola(parabola);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(parabola[i], 0, 1e-11);
    EXPECT_NEAR(drifting[i], corrected[i], 1e-11);
  }
}

TEST(Accelerogram, no_other_parabola_leaves_a_smaller_mean_square_velocity) {
  std::vector<double> corrected = rough_samples(500, 3);
  const double before = square_sum(velocities(corrected));
  subtract_parabola(corrected);
  const double least = square_sum(velocities(corrected));
  EXPECT_LT(least, before / 10);
  for (int power = 0; power < 3; ++power)
    for (const double change : {-1e-4, 1e-4}) {
      std::vector<double> other = corrected;
      for (std::size_t i = 0; i < other.size(); ++i)
        other[i] += change * std::pow(static_cast<double>(i) / 499, power);
      EXPECT_GT(square_sum(velocities(other)), least) << power << " " << change;
    }
}

TEST(Accelerogram, velocity_of_a_drifting_record_ends_near_zero) {
  // 20 cycles that come and go, at rest before and after, on a base line that is off by a hundredth of their
  // peak
  std::vector<double> samples;
  for (int i = 0; i <= 1000; ++i)
    samples.push_back(0.01 + std::sin(k_pi * i / 1000) * std::sin(2 * k_pi * 20 * i / 1000.));
  const double peak = 1000 / (2 * k_pi * 20);  // of their own velocity
  EXPECT_GT(velocities(samples).back(), peak);
  subtract_parabola(samples);
  EXPECT_LT(std::abs(velocities(samples).back()), 0.05 * peak);
}

Shake record_shake(std::vector<double> samples, double interval, double start) {
  Shake shake;
  shake.kind = Shake::Kind::record;
  shake.start = start;
  shake.record = make_accelerogram({{Vec3::UnitX(), interval, std::move(samples)}});
  return shake;
}

TEST(Accelerogram, shakes_the_floor_from_its_start_times_its_scale) {
  Shake shake = record_shake({1, 3}, 2, 5);
  shake.scale = -0.5;
  EXPECT_EQ(shake_acceleration(shake, 4.999), Vec3::Zero());
  EXPECT_EQ(shake_acceleration(shake, 6), Vec3(-1, 0, 0));
  EXPECT_EQ(shake_acceleration(shake, 7.001), Vec3::Zero());
  EXPECT_EQ(shake_end(shake), 7);
}

TEST(Accelerogram, is_shared_by_copies_of_the_parameters) {
  Parameters p;
  p.shakes.push_back(record_shake({1, 2}, 1, 0));
  const Parameters copy = p;
  EXPECT_EQ(copy.shakes[0].record.get(), p.shakes[0].record.get());
}

TEST(Accelerogram, bounds_the_adaptive_step_where_it_shakes_and_has_kinks_at_its_ends) {
  Parameters p = weightless();
  p.shakes = {record_shake({1, 2, 3}, 0.02, 1), record_shake({1, 2, 3, 4, 5}, 0.005, 1.03)};
  EXPECT_EQ(sample_interval(p.shakes, 0.99), std::numeric_limits<double>::infinity());
  EXPECT_EQ(sample_interval(p.shakes, 1), 0.02);
  EXPECT_EQ(sample_interval(p.shakes, 1.035), 0.005);
  EXPECT_EQ(sample_interval(p.shakes, 1.06), std::numeric_limits<double>::infinity());
  const Model model = oscillator();
  std::vector<double> kinks;
  for (double t = 0; (t = next_kink(model, p, t)) < 100;) kinks.push_back(t);
  ASSERT_EQ(kinks.size(), 4u);
  for (const double expected : {1., 1.03, 1.04, 1.05})
    EXPECT_TRUE(std::any_of(kinks.begin(), kinks.end(), [&](double t) {
      return std::abs(t - expected) < 1e-12;
    })) << expected;
  State state = start_state(model, {BodyStart{}});
  state.time = 1.01;
  EXPECT_LE(look_ahead(model, p, state), 0.02);
  state.time = 1.035;
  EXPECT_LE(look_ahead(model, p, state), 0.005);
  state.time = 2;
  EXPECT_GT(look_ahead(model, p, state), 0.02);
}

/// Displacement and velocity of x'' + w^2 x = -a(t), a straight between its samples: exact from sample to
/// sample (N. C. Nigam, P. C. Jennings, Calculation of response spectra from strong-motion earthquake
/// records, Bull. Seismol. Soc. Am. 59, 1969, 909-922), without damping.
std::pair<double, double> exact_response(const std::vector<double>& samples, double interval, double w) {
  double x = 0, v = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    // x_p = c + s t solves the equation
    const double slope = (samples[i] - samples[i - 1]) / interval;
    const double c = -samples[i - 1] / (w * w), s = -slope / (w * w);
    const double a = x - c, b = (v - s) / w, angle = w * interval;
    x = c + s * interval + a * std::cos(angle) + b * std::sin(angle);
    v = s + w * (b * std::cos(angle) - a * std::sin(angle));
  }
  return {x, v};
}

/// Error of adaptive steps through a record over the size of the exact response at its end.
double adaptive_error(const std::vector<double>& samples, double interval, double tolerance) {
  const auto [x, v] = exact_response(samples, interval, k_oscillation);
  Parameters p = weightless();
  p.adaptive = true;
  p.tolerance = tolerance;
  p.shakes = {record_shake(samples, interval, 0)};
  const Model model = oscillator();
  Simulation sim(model, {BodyStart{}}, p);
  const double end = p.shakes[0].record->duration;
  while (sim.state.time < end - 1e-9) {
    const StepStatus status = step(sim.model, sim.parameters, sim.state, sim.workspace(), end);
    if (!status.ok()) {
      ADD_FAILURE() << status.message(sim.model);
      break;
    }
  }
  return std::hypot(sim.state.position[1].x() - 1 - x, (sim.state.velocity[1].x() - v) / k_oscillation) /
         std::hypot(x, v / k_oscillation);
}

TEST(Accelerogram, adaptive_steps_follow_every_sample) {
  std::vector<double> samples(50, 0);
  for (const double a : rough_samples(40, 4)) samples.push_back(1e-2 * a);
  samples.push_back(0);
  // the local error is bounded by the tolerance of the travel; over 3 periods it adds up to less than ten
  // times
  EXPECT_LT(adaptive_error(samples, 0.01, 1e-2), 0.1);
  EXPECT_LT(adaptive_error(samples, 0.01, 1e-3), 0.01);
}

TEST(Accelerogram, adaptive_steps_do_not_pass_over_a_spike_after_a_long_quiet) {
  for (const int spike : {120, 121, 122, 123, 124}) {
    std::vector<double> samples(140, 0);
    samples[static_cast<std::size_t>(spike)] = 0.01;
    EXPECT_LT(adaptive_error(samples, 0.01, 1e-3), 0.01) << spike;
  }
}

}  // namespace
}  // namespace topple::test
