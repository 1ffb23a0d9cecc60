// JMA seismic intensity against the agency's example and motions of which it is known in closed form.
#include "solver/study/common/intensity.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace topple::study {
namespace {

constexpr double k_interval = 0.005;  // s
constexpr double k_rise = 10;         // s of smooth rise and fall, so that nothing rings above the plateau
constexpr double k_plateau = 60;      // s

/// 1 for k_plateau between a rise and a fall.
double window(double t) {
  const auto rise = [](double x) { return (1 - std::cos(k_pi * std::clamp(x, 0., 1.))) / 2; };
  return rise(t / k_rise) * rise((2 * k_rise + k_plateau - t) / k_rise);
}

/// A sine along x, and a cosine along `second`, of `gal` and f Hz.
Motion steady(double gal, double f, const Vec3& second) {
  Motion motion{.interval = k_interval, .samples = {}};
  for (double t = 0; t < 2 * k_rise + k_plateau; t += k_interval)
    motion.samples.push_back(
        k_gal * gal * window(t) *
        (std::sin(2 * k_pi * f * t) * Vec3::UnitX() + std::cos(2 * k_pi * f * t) * second));
  return motion;
}

TEST(Intensity, filters_are_those_of_the_notice) {
  // worked out apart from the code, from the three formulas
  const double known[][2] = {{0.1, 0.282268}, {0.5, 1.123410}, {1, 0.996369}, {2, 0.697360},
                             {5, 0.410051},   {10, 0.223503},  {20, 0.056473}};
  for (const auto& [f, gain] : known) EXPECT_NEAR(intensity_filter(f), gain, 1e-6) << f;
  EXPECT_EQ(intensity_filter(0), 0);
  // f^-1/2 (f/0.5)^3/2 where it is low, f^-1/2 x^-6 where it is high
  EXPECT_NEAR(intensity_filter(1e-3) / (1e-3 / std::pow(0.5, 1.5)), 1, 1e-6);
  EXPECT_NEAR(intensity_filter(1e4) / (std::pow(1e4, -0.5) * std::pow(1e3, -6) / std::sqrt(0.000155)), 1,
              1e-4);
}

// A motion in a circle has one size all the time: a = A F(f). Tolerance: the window's rise moves its spectrum
// over 0.1 Hz about f, over which F bends by less than 1e-4 of itself; 5e-4 holds that and the padding.
TEST(Intensity, of_a_motion_in_a_circle_is_that_of_its_size) {
  for (const double f : {0.5, 1., 2., 5., 9.}) {
    const double a = 100 * intensity_filter(f);
    EXPECT_NEAR(intensity_acceleration(steady(100, f, Vec3::UnitY())) / a, 1, 5e-4) << f;
  }
}

// |sin| lies above sin(pi/2 (1 - x)) for the share x of the time: a = A F(f) cos(pi/2 0.3 s/60 s), which is
// 3e-5 below A F. Tolerance: that, and samples 1.8 degrees apart at 1 Hz, 5e-4 as above.
TEST(Intensity, of_a_sine_is_that_of_its_amplitude) {
  for (const double f : {0.5, 1., 2.}) {
    const double a = 190 * intensity_filter(f) * std::cos(k_pi / 2 * 0.3 / k_plateau);
    EXPECT_NEAR(intensity_acceleration(steady(190, f, Vec3::Zero())) / a, 1, 5e-4) << f;
  }
}

TEST(Intensity, does_not_depend_on_the_axes) {
  const Motion motion = steady(50, 1.5, Vec3::UnitY());
  Motion turned = motion;
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  for (Vec3& a : turned.samples) a = turn * a;
  EXPECT_NEAR(intensity_acceleration(turned) / intensity_acceleration(motion), 1, 1e-12);
}

TEST(Intensity, is_reached_for_three_tenths_of_a_second) {
  // two bursts of one size: 0.2 s each are 0.4 s in all, one alone is not enough
  Motion motion{.interval = k_interval, .samples = std::vector<Vec3>(8000, Vec3::Zero())};
  const auto burst = [&](double at) {
    for (int i = 0; i < 40; ++i) {
      const double t = i * k_interval, w = std::sin(k_pi * t / 0.2);
      motion.samples[static_cast<std::size_t>(at / k_interval) + static_cast<std::size_t>(i)].x() =
          w * w * std::sin(2 * k_pi * 20 * t);
    }
  };
  burst(10);
  const double one = intensity_acceleration(motion);
  burst(20);
  EXPECT_GT(intensity_acceleration(motion), 1.3 * one);
  EXPECT_EQ(intensity_acceleration({.interval = k_interval, .samples = std::vector<Vec3>(59, Vec3::UnitX())}),
            0);
}

TEST(Intensity, number_is_that_of_the_agency) {
  EXPECT_EQ(instrumental_intensity(127.85), 5.1);  // its example: Yonago, 6 October 2000
  EXPECT_EQ(intensity_scale(5.1), IntensityScale::five_upper);
  const auto rounded = [](double intensity) {
    return instrumental_intensity(std::pow(10, (intensity - 0.94) / 2));
  };
  EXPECT_EQ(rounded(4.994), 4.9);  // 4.99, cut
  EXPECT_EQ(rounded(4.996), 5.0);  // 5.00
  EXPECT_EQ(rounded(0.3), 0.3);
  EXPECT_EQ(rounded(-1), 0);
  EXPECT_EQ(instrumental_intensity(0), 0);
}

TEST(Intensity, degrees_begin_where_the_scale_says) {
  const std::pair<double, IntensityScale> begins[] = {
      {0, IntensityScale::zero},         {0.5, IntensityScale::one},       {1.5, IntensityScale::two},
      {2.5, IntensityScale::three},      {3.5, IntensityScale::four},      {4.5, IntensityScale::five_lower},
      {5.0, IntensityScale::five_upper}, {5.5, IntensityScale::six_lower}, {6.0, IntensityScale::six_upper},
      {6.5, IntensityScale::seven}};
  for (const auto& [from, degree] : begins) {
    EXPECT_EQ(intensity_scale(from), degree) << from;
    EXPECT_EQ(intensity_scale(from + 0.4), degree) << from;
  }
}

TEST(Intensity, the_floor_is_that_of_all_shakes) {
  Shake x, z;
  x.amplitude = 3, x.frequency = 1;
  z.amplitude = 4, z.frequency = 1, z.direction = Vec3::UnitZ();
  const Motion motion = floor_motion({x, z}, 2);
  EXPECT_EQ(motion.samples.size(), 401u);
  EXPECT_NEAR(peak(motion), 5, 1e-12);
  EXPECT_EQ(peak(floor_motion({}, 1)), 0);
}

}  // namespace
}  // namespace topple::study
