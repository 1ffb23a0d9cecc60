// The floor's series are its acceleration, and roots of guards are found.
#include <gtest/gtest.h>

#include <random>

#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"
#include "unit/solver/planar/planar_blocks.h"

namespace topple::planar::test {
namespace {

// From kink to kink, aside of jumps.
void expect_series_of(const std::vector<Shake>& shakes, double until, int least_pieces) {
  const ShakenPlane plane{shakes, Vec3(0.6, 0.8, 0)};
  const Floor floor = shaken(plane);
  int pieces = 0;
  for (double t = 0; t < until;) {
    Series<double> horizontal, vertical;
    const double end = floor.series(floor.floor, t, horizontal, vertical);
    ASSERT_GT(end, t);
    ++pieces;
    const double span = std::min({end, until, t + 0.02}) - t;
    for (const double share : {1e-9, 0.3, 0.7, 1 - 1e-9}) {
      const Vec3 exact = floor_acceleration(shakes, t + share * span);
      EXPECT_NEAR(horizontal.at(share * span), exact.dot(plane.along), 1e-11) << t << ' ' << share;
      EXPECT_NEAR(vertical.at(share * span), exact.z(), 1e-11) << t << ' ' << share;
    }
    t = span == end - t ? end : t + span;
  }
  EXPECT_GE(pieces, least_pieces);
}

Shake slanted(Shake shake) {
  shake.direction = Vec3(0.5, -0.2, 0.4).normalized();
  return shake;
}

TEST(PlanarFloor, series_of_each_shake_are_its_acceleration) {
  const Shake sine = slanted(sine_shake(7, 2.3));
  Shake late = sine, tapered = sine, sweep = sine, ramped = sine;
  late.start = 0.37, late.cycles = 2.5;
  tapered.taper = 1.5, tapered.cycles = 5, tapered.start = 0.1;
  sweep.kind = Shake::Kind::sweep, sweep.duration = 1.7, sweep.last_frequency = 9, sweep.taper = 0.7;
  ramped.ramp = {.since = 0.4, .over = 0.3};
  ramped.amplitude_before = Vec3(1, 2, 3);
  for (const Shake& shake : {sine, late, tapered, sweep, ramped}) expect_series_of({shake}, 3, 30);
  expect_series_of({sine, tapered, sweep}, 3, 30);
  for (const PulseTraits& shape : pulse_shapes()) {
    Shake pulse = slanted(sine_shake(5, 1));
    pulse.kind = Shake::Kind::pulse, pulse.shape = shape.kind, pulse.duration = 0.4, pulse.start = 0.3;
    expect_series_of({pulse}, 1, 3);
  }
}

TEST(PlanarFloor, series_of_a_record_are_lines_between_its_samples) {
  std::mt19937 rng(5);
  std::vector<AccelerogramComponent> components(2);
  for (AccelerogramComponent& one : components)
    for (int i = 0; i < 300; ++i) one.samples.push_back(static_cast<double>(rng()) / 0x1p30 - 2);
  components[0].interval = 0.01, components[1].interval = 0.007, components[1].direction = Vec3::UnitZ();
  Shake shake;
  shake.kind = Shake::Kind::record, shake.record = make_accelerogram(components), shake.start = 0.123;
  expect_series_of({shake}, 3.5, 590);
  shake.ramp = {.since = 0.5, .over = 0.2};
  shake.scale_before = 0.3;
  expect_series_of({shake}, 3.5, 590);
}

TEST(PlanarFloor, first_fall_is_that_of_many_samples) {
  std::mt19937 rng(6);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng()) / 0x1p32;
  };
  int found = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double span = within(0.1, 3);
    Series<double> p(1);
    for (int roots = trial % 8; roots > 0; --roots) {  // times (1 - t/r)
      const double r = within(-0.5, 2) * span;
      p[p.degree + 1] = 0;
      for (int i = ++p.degree; i > 0; --i) p[i] -= p[i - 1] / r;
    }
    double sampled = k_never;
    constexpr int k_samples = 3000;
    for (int i = 1; i <= k_samples && sampled == k_never; ++i)
      if (p.at(span * i / k_samples) < 0) sampled = span * i / k_samples;
    const double fall = Falls<double>(span, p.degree).first(p, 1, 0);
    double size = 0;
    for (int i = p.degree; i >= 0; --i) size = std::abs(p[i]) + span * size;
    SCOPED_TRACE(trial);
    if (sampled < k_never) {
      ++found;
      EXPECT_LE(fall, sampled);
      EXPECT_NEAR(p.at(fall), 0, 1e-12 * size);
    } else if (fall < k_never) {  // two roots between samples
      EXPECT_LT(p.at(fall + 1e-9), 1e-9);
    }
  }
  EXPECT_GT(found, 1000);
}

TEST(PlanarFloor, two_roots_however_near_count_and_a_touch_does_not) {
  for (const double depth : {1e-4, 1e-8, 1e-12}) {
    Series<double> p(0.25 - depth);  // (t - 1/2)^2 - depth
    p[1] = -1, p[2] = 1, p.degree = 2;
    EXPECT_NEAR(Falls<double>(1, 2).first(p, 1, 0), 0.5 - std::sqrt(depth), 1e-9);
    EXPECT_EQ(Falls<double>(1, 2).first(p, 1, 1.5 * depth), k_never);
  }
  Series<double> rising(0);  // t, from a rounding error below zero
  rising[1] = 1, rising.degree = 1;
  EXPECT_EQ(Falls<double>(1, 1).first(rising, 1, -1e-16), k_never);
  EXPECT_EQ(Falls<double>(1, 1).first(rising, 1, -1e-3), 0);
  EXPECT_EQ(Falls<double>(1, 1).first(rising, -1, 0), 0);
  EXPECT_EQ(Falls<double>(1, 1).first(rising, 0, 0), k_never);
}

}  // namespace
}  // namespace topple::planar::test
