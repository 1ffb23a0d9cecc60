// The floor of a building against closed forms and against integrations of the whole structure.
#include "solver/model/building.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"
#include "solver/planar/floor.h"
#include "solver/run/edit.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

Shake sine(double amplitude, double frequency) {
  Shake s;
  s.amplitude = amplitude;
  s.frequency = frequency;
  return s;
}

Shake within(Shake shake, std::vector<BuildingMode> modes) {
  EXPECT_TRUE(put_in_building(std::move(modes), 0, 0, shake));
  return shake;
}

/// Absolute acceleration of an oscillator from rest on a ground A sin(p t), by the closed form of the
/// relative displacement: steady part and free vibration.
double on_sine(const BuildingMode& mode, double amplitude, double frequency, double t) {
  const double w = 2 * k_pi / mode.period, z = mode.damping, p = 2 * k_pi * frequency,
               wd = w * std::sqrt(1 - z * z);
  const double real = w * w - p * p, imaginary = 2 * z * w * p, square = real * real + imaginary * imaginary;
  // x = S sin + C cos + exp(-z w t) (a cos wd t + b sin wd t)
  const double S = -amplitude * real / square, C = amplitude * imaginary / square;
  const double a = -C, b = (-z * w * C - S * p) / wd;
  const double e = std::exp(-z * w * t), c = std::cos(wd * t), s = std::sin(wd * t);
  const double x = S * std::sin(p * t) + C * std::cos(p * t) + e * (a * c + b * s);
  const double v =
      p * (S * std::cos(p * t) - C * std::sin(p * t)) + e * (-z * w * (a * c + b * s) + wd * (b * c - a * s));
  return -2 * z * w * v - w * w * x;
}

/// Absolute acceleration of floor `storey` of a chain of equal masses and springs, damped in every mode
/// alike, by the classical Runge-Kutta method on all its masses, from rest; the ground may jump at the ends
/// of steps.
std::vector<double> chain_on(const std::function<double(double)>& ground, int storey, int of, double period,
                             double damping, double h, int steps) {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(of, of);
  for (int i = 0; i < of; ++i) {
    k(i, i) = i + 1 < of ? 2 : 1;
    if (i > 0) k(i, i - 1) = k(i - 1, i) = -1;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(k);
  const double scale = std::pow(2 * k_pi / period, 2) / modes.eigenvalues()[0];
  const Eigen::MatrixXd stiffness = scale * k;
  const Eigen::MatrixXd viscous = modes.eigenvectors() *
                                  (2 * damping * (scale * modes.eigenvalues()).cwiseSqrt()).asDiagonal() *
                                  modes.eigenvectors().transpose();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(of), v = x;
  const auto gain = [&](double t, const Eigen::VectorXd& at, const Eigen::VectorXd& rate) {
    return Eigen::VectorXd(-viscous * rate - stiffness * at - Eigen::VectorXd::Constant(of, ground(t)));
  };
  std::vector<double> out;
  for (int i = 0; i <= steps; ++i) {
    const double t = i * h;
    out.push_back((gain(t, x, v))[storey - 1] + ground(t));
    const Eigen::VectorXd v1 = v, a1 = gain(t, x, v), v2 = v + h / 2 * a1,
                          a2 = gain(t + h / 2, x + h / 2 * v1, v2), v3 = v + h / 2 * a2,
                          a3 = gain(t + h / 2, x + h / 2 * v2, v3), v4 = v + h * a3,
                          a4 = gain(t + (1 - 1e-9) * h, x + h * v3, v4);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return out;
}

// 48 intervals in the shorter period: of each vibration the cubic errs by (2 pi/48)^4/384 = 8e-7, the
// ground's line by less.
TEST(Building, floor_on_a_sine_from_rest_is_the_closed_form) {
  for (const double period : {0.2, 0.5, 1., 3.})
    for (const double damping : {0.02, 0.3}) {
      const BuildingMode mode{period, damping, 1};
      const Shake floor = within(sine(2, 1.6), {mode});
      double peak = 0;
      for (double t = 0; t < 12; t += 0.0113) peak = std::max(peak, std::abs(on_sine(mode, 2, 1.6, t)));
      for (double t = 0; t < 12; t += 0.0113)
        ASSERT_NEAR(shake_acceleration(floor, t).x(), on_sine(mode, 2, 1.6, t), 1e-5 * peak)
            << period << " " << damping << " " << t;
      // and for ever: what repeats has no end
      ASSERT_NEAR(shake_acceleration(floor, 3000.017).x(), on_sine(mode, 2, 1.6, 3000.017), 1e-5 * peak);
      EXPECT_EQ(shake_end(floor), std::numeric_limits<double>::infinity());
    }
}

TEST(Building, modes_of_a_shear_building_are_those_of_its_matrices) {
  for (const int of : {1, 2, 10})
    for (const int storey : {1, (of + 1) / 2, of}) {
      Eigen::MatrixXd k = Eigen::MatrixXd::Zero(of, of);
      for (int i = 0; i < of; ++i) {
        k(i, i) = i + 1 < of ? 2 : 1;
        if (i > 0) k(i, i - 1) = k(i - 1, i) = -1;
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k);
      const std::vector<BuildingMode> modes = shear_building(storey, of, 1.5, 0.03);
      ASSERT_EQ(static_cast<int>(modes.size()), of);
      double sum = 0;
      for (int r = 0; r < of; ++r) {
        const Eigen::VectorXd shape = solver.eigenvectors().col(r);
        EXPECT_NEAR(modes[r].period, 1.5 * std::sqrt(solver.eigenvalues()[0] / solver.eigenvalues()[r]),
                    1e-12);
        EXPECT_NEAR(modes[r].factor, shape.sum() * shape[storey - 1], 1e-12);
        sum += modes[r].factor;
      }
      EXPECT_NEAR(sum, 1, 1e-12);  // all modes together are the whole ground
    }
}

// The reference takes 1 ms, of which the shortest period, 76 ms, has as many: an error of 1e-6.
TEST(Building, floor_of_ten_storeys_is_that_of_all_its_masses) {
  const auto at = [](const Shake& shake) {
    return [&](double t) { return shake_acceleration(shake, t).x(); };
  };
  Shake sweep = sine(3, 0.5);
  sweep.kind = Shake::Kind::sweep, sweep.last_frequency = 8, sweep.duration = 5;
  Shake pulse = sine(3, 1);
  pulse.kind = Shake::Kind::pulse, pulse.shape = Shake::Shape::rectangle, pulse.duration = 0.4;
  Shake tapered = sine(3, 1.3);
  tapered.cycles = 6, tapered.taper = 1.5;
  for (const Shake& ground : {sine(3, 1.1), sweep, pulse, tapered})
    for (const int storey : {1, 7, 10}) {
      const Shake floor = within(ground, shear_building(storey, 10, 1, 0.05));
      const std::vector<double> whole = chain_on(at(ground), storey, 10, 1, 0.05, 1e-3, 8000);
      double peak = 0;
      for (const double a : whole) peak = std::max(peak, std::abs(a));
      for (int i = 0; i <= 8000; i += 7)
        ASSERT_NEAR(shake_acceleration(floor, i * 1e-3).x(), whole[i], 3e-5 * peak) << storey << " " << i;
    }
}

// Linear between its samples, so that the states at them are exact: an integration with 50 steps between two
// of them differs by its own error, 1e-8, and between them the cubic by its.
TEST(Building, floor_on_a_record_is_exact_and_dies_away) {
  std::mt19937 rng(3);
  std::vector<double> samples(200);
  for (double& a : samples) a = random_vector(rng).x();
  Shake ground;
  ground.kind = Shake::Kind::record;
  ground.record = make_accelerogram({{Vec3(1, 0, 0), 0.02, samples}, {Vec3(0, 0, 1), 0.02, samples}});
  ground.scale = 1.5;
  const BuildingMode mode{0.6, 0.04, 1.2};
  const Shake floor = within(ground, {mode});
  double peak = 0;
  std::vector<double> whole =
      chain_on([&](double t) { return shake_acceleration(ground, t).x(); }, 1, 1, 0.6, 0.04, 4e-4, 20000);
  for (const double a : whole) peak = std::max(peak, std::abs(a));
  for (int i = 0; i < 9950; i += 50) {  // up to its end, where it jumps
    const double t = i * 4e-4;
    const Vec3 g = shake_acceleration(ground, t), a = shake_acceleration(floor, t);
    // the mode's share moves as the oscillator, the rest of the ground stays with it
    ASSERT_NEAR(a.x(), g.x() + 1.2 * (whole[i] - g.x()), 1e-5 * peak) << t;
    ASSERT_EQ(a.z(), g.z());
  }
  const double end = shake_end(floor);
  EXPECT_GT(end, 3.98);
  EXPECT_EQ(shake_acceleration(floor, end + 1e-9), Vec3(Vec3::Zero()));
  EXPECT_LT(shake_acceleration(floor, end - 1e-9).norm(), 3e-6 * peak);
}

// A jump of the ground's velocity leaves the floor where it is, and the oscillator goes against it.
TEST(Building, a_jump_of_the_ground_is_an_impulse_on_the_modes) {
  Shake ground = sine(2, 1);
  ground.initial_velocity = Shake::Start::jump;
  const BuildingMode mode{0.8, 0.05, 1};
  const Shake floor = within(ground, {mode});
  EXPECT_EQ(floor_velocity_jump({floor}, 0, 1e-9), Vec3(Vec3::Zero()));
  const double w = 2 * k_pi / mode.period, v = 2 / (2 * k_pi);
  EXPECT_NEAR(shake_acceleration(floor, 0).x(), -2 * 0.05 * w * v, 1e-12);
  const Shake half = within(ground, {{0.8, 0.05, 0.5}});
  EXPECT_NEAR(floor_velocity_jump({half}, 0, 1e-9).x(), -v / 2, 1e-12);
}

TEST(Building, amplitude_direction_and_off_are_factors_on_the_floor) {
  topple::Setup setup;
  const BuildingMode mode{0.8, 0.05, 1};
  Parameters& p = setup.parameters;
  p.shakes = {within(sine(2, 1), {mode})};
  const Shake before = p.shakes[0];
  apply({.key = Edit::Key::amplitude, .value = Vec3(4, 0, 0)}, setup.model, 3, p);
  for (const double t : {3.3, 5., 9.})
    EXPECT_NEAR(shake_acceleration(p.shakes[0], t).x(), 2 * shake_acceleration(before, t).x(), 1e-12);
  EXPECT_NEAR(shake_acceleration(p.shakes[0], 3).x(), shake_acceleration(before, 3).x(), 1e-12);
  for (const Edit::Key key : {Edit::Key::frequency, Edit::Key::type, Edit::Key::duration})
    EXPECT_FALSE(traits(key).exists(setup.model, p, 0));
  EXPECT_TRUE(traits(Edit::Key::amplitude).exists(setup.model, p, 0));
}

// Planar blocks read the floor as power series: these are the same floor.
TEST(Building, series_of_planar_blocks_are_the_same_floor) {
  Shake pulse = sine(3, 1);
  pulse.kind = Shake::Kind::pulse, pulse.duration = 0.4;
  Shake late = sine(2, 1.5);
  late.start = 0.7, late.direction = Vec3(0.6, 0, 0.8);
  std::vector<double> samples(60);
  std::mt19937 rng(3);
  for (double& a : samples) a = random_vector(rng).x();
  Shake record;
  record.kind = Shake::Kind::record;
  record.record = make_accelerogram({{Vec3(1, 0, 0), 0.02, samples}, {Vec3(0, 0, 1), 0.02, samples}});
  for (const Shake& ground : {sine(2, 1.5), pulse, late, record}) {
    const std::vector<Shake> shakes{within(ground, {{0.6, 0.05, 0.7}, {0.1, 0.05, 0.1}})};
    const planar::ShakenPlane plane{shakes};
    const planar::Floor floor = planar::shaken(plane);
    double t = 0;
    for (int i = 0; i < 3000 && t < 4; ++i) {
      planar::Series<double> along, up;
      const double end = floor.series(floor.floor, t, along, up);
      ASSERT_GT(end, t);
      for (const double share : {1e-3, 0.3, 0.99}) {
        const double x = share * (std::min(end, t + 0.05) - t);
        double a = 0, b = 0;
        for (int k = along.degree; k >= 0; --k) a = a * x + along[k];
        for (int k = up.degree; k >= 0; --k) b = b * x + up[k];
        const Vec3 own = shake_acceleration(shakes[0], t + x);
        ASSERT_NEAR(a, own.x(), 1e-9) << t;
        ASSERT_NEAR(b, own.z(), 1e-9) << t;
      }
      t = std::min(end, t + 0.05);
    }
  }
}

}  // namespace
}  // namespace topple::test
