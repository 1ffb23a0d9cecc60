// A rigid block that rocks on its edges without slipping and lands after Housner (1963): where the references
// of the rocking scenes are from.
//   th'' = -p^2 (s sin(a - |th|) + a(t)/g cos(a - |th|)),  s the sign of th,  p^2 = m g R/I about the edge
//   at th = 0: th' -> (1 - 2 m R^2 sin^2 a/I) th'; from rest th'' by the first edge that |a(t)| > g tan a
//   lifts
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace topple::test {
namespace {

constexpr double k_g = 9.80665;  // m/s^2
constexpr double k_degree = std::numbers::pi / 180;

struct Block {
  double half_base, half_height;  // m
  double inertia;                 // about the edge over m R^2
  double radius = std::hypot(half_base, half_height);
  double critical = std::atan(half_base / half_height);
  double p = std::sqrt(k_g / (inertia * radius));
  double kept = 1 - 2 * std::pow(std::sin(critical), 2) / inertia;  // of the rate, by an impact
};

const Block k_uniform{0.19, 0.895, 4. / 3};
const Block k_corners{0.2, 1, 2};

/// Floor acceleration over g tan a at a time in s.
using Pulse = std::function<double(double)>;

struct Motion {
  double tilt, rate;
};

double acceleration(const Block& block, double side, double tilt, double floor) {
  const double left = block.critical - side * tilt;
  return -block.p * block.p * (side * std::sin(left) + floor * std::tan(block.critical) * std::cos(left));
}

// Runge-Kutta of fourth order on the edge of this side; beyond tilt 0 the same equation goes on.
Motion moved(const Block& block, double side, const Motion& m, double t, double h, const Pulse& pulse) {
  const auto at = [&](const Motion& x, double when) {
    return acceleration(block, side, x.tilt, pulse(when));
  };
  const double a = at(m, t);
  const Motion second{m.tilt + h / 2 * m.rate, m.rate + h / 2 * a};
  const double b = at(second, t + h / 2);
  const Motion third{m.tilt + h / 2 * second.rate, m.rate + h / 2 * b};
  const double c = at(third, t + h / 2);
  const Motion fourth{m.tilt + h * third.rate, m.rate + h * c};
  const double d = at(fourth, t + h);
  return {m.tilt + h / 6 * (m.rate + 2 * second.rate + 2 * third.rate + fourth.rate),
          m.rate + h / 6 * (a + 2 * b + 2 * c + d)};
}

struct Rocking {
  std::vector<double> impacts;  // s
  std::vector<double> peaks;    // rad, before the first impact, then after each
  bool overturned = false;
};

Rocking rock(const Block& block, Motion m, const Pulse& pulse, double duration, double h) {
  Rocking out{{}, {std::abs(m.tilt)}};
  double side = m.tilt > 0 ? 1 : m.tilt < 0 ? -1 : 0;
  for (double t = 0; t < duration;) {
    if (side == 0) {
      if (const double floor = pulse(t); std::abs(floor) > 1) side = floor > 0 ? -1 : 1;
      t += h;
      continue;
    }
    const Motion next = moved(block, side, m, t, h, pulse);
    if (side * next.tilt > 0 || side * next.rate > 0) {
      m = next;
      t += h;
      out.peaks.back() = std::max(out.peaks.back(), side * m.tilt);
      if (side * m.tilt > 1.5 * block.critical) return out.overturned = true, out;
      continue;
    }
    double low = 0, high = h;  // the impact lies between
    while (high - low > 1e-13) {
      const double middle = (low + high) / 2;
      (side * moved(block, side, m, t, middle, pulse).tilt > 0 ? low : high) = middle;
    }
    m = {0, block.kept * moved(block, side, m, t, high, pulse).rate};
    t += high;
    side = -side;
    out.impacts.push_back(t);
    out.peaks.push_back(0);
    if (std::abs(m.rate) < 1e-9) side = 0;
  }
  return out;
}

// Least amplitude over g tan a that overturns the block at rest.
double least(const Block& block, const Pulse& pulse) {
  constexpr double k_coarse = 5e-3, h = 5e-5, k_duration = 6;
  const auto overturns = [&](double amplitude) {
    return rock(
               block, {0, 0}, [&](double t) { return amplitude * pulse(t); }, k_duration, 20 * h)
        .overturned;
  };
  double high = 1;
  while (!overturns(high)) high += k_coarse;
  double low = high - k_coarse;
  const auto finely = [&](double amplitude) {
    return rock(
               block, {0, 0}, [&](double t) { return amplitude * pulse(t); }, k_duration, h)
        .overturned;
  };
  while (high - low > 1e-7) (finely((low + high) / 2) ? high : low) = (low + high) / 2;
  return high;
}

Pulse half_sine(double w) {
  return [w](double t) { return w * t < std::numbers::pi ? std::sin(w * t) : 0; };
}

Pulse one_sine(double w) {
  return [w](double t) { return w * t < 2 * std::numbers::pi ? std::sin(w * t) : 0; };
}

TEST(RockingBlock, free_rocking_of_the_uniform_block_is_the_reference_of_the_scenes) {
  const Rocking free = rock(
      k_uniform, {k_uniform.critical / 2, 0}, [](double) { return 0.; }, 3.2, 1e-4);
  const double impacts[] = {0.46508904, 1.26166455, 1.96212906, 2.58772990, 3.15221699};
  const double peaks[] = {5.99270706, 4.95920425, 4.16583240, 3.53228486, 3.01441960};
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(free.impacts.at(k), impacts[k], 2e-8) << k;
    EXPECT_NEAR(free.peaks.at(k) / k_degree, peaks[k], 2e-7) << k;
  }
}

TEST(RockingBlock, least_pulses_are_the_references_of_the_scenes) {
  for (const auto& [wp, corners_half, corners_one, uniform_half, uniform_one] :
       {std::array{2., 1.801223949, 1.217703476, 1.801270447, 1.220640488},
        std::array{4., 2.795034411, 1.698219757, 2.795538254, 1.737093353},
        std::array{6., 3.796725428, 3.829277267, 3.797761078, 4.198619003}}) {
    SCOPED_TRACE(wp);
    EXPECT_NEAR(least(k_corners, half_sine(wp * k_corners.p)), corners_half, 1e-5);
    EXPECT_NEAR(least(k_corners, one_sine(wp * k_corners.p)), corners_one, 1e-5);
    EXPECT_NEAR(least(k_uniform, half_sine(wp * k_uniform.p)), uniform_half, 1e-5);
    EXPECT_NEAR(least(k_uniform, one_sine(wp * k_uniform.p)), uniform_one, 1e-5);
  }
}

}  // namespace
}  // namespace topple::test
