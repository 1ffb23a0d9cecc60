// A rigid block on penalty contacts, integrated apart from the solver: what contacts of finite stiffness owe
// to theory. The scenes verify/rocking-* state these figures as reasons of their tolerances.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace topple::test {
namespace {

constexpr double k_g = 9.80665;      // m/s^2
constexpr double k_half_base = 0.2;  // m
constexpr double k_half_height = 1;  // m
constexpr double k_width = 0.06;     // m, of a contact
constexpr double k_friction = 1.5;
constexpr double k_normal_speed = 1e-3;   // m/s
constexpr double k_stick_stiffness = 10;  // over alpha/L
constexpr double k_stick_damping = 0.2;
constexpr int k_contacts_of_a_side = 3;
constexpr int k_contacts = 19;  // of the whole block, share its mass

const double k_radius = std::hypot(k_half_base, k_half_height);
const double k_critical = std::atan(k_half_base / k_half_height);

struct Block {
  double mass;     // kg
  double inertia;  // kg m^2 about the edge, over mass R^2
  double alpha;    // N, of one contact
};

struct Motion {
  double x = 0, z = k_half_height, tilt = 0, vx = 0, vz = 0, rate = 0;
  std::array<double, 2> stick{};  // m, of each side
};

struct Rates {
  double x, z, tilt;  // accelerations
};

/// Floor acceleration along x at a time.
using Floor = std::function<double(double)>;

// Accelerations at `now`; `stick` travels from `start` on and, when kept, is cut to what friction holds.
Rates accelerations(const Block& block, const Motion& now, const Motion& start, double floor,
                    std::array<double, 2>* kept = nullptr) {
  const double alpha = k_contacts_of_a_side * block.alpha;
  const double k = k_stick_stiffness * alpha / k_width;
  const double c = 2 * k_stick_damping * k_contacts_of_a_side *
                   std::sqrt(k / k_contacts_of_a_side * block.mass / k_contacts);
  double fx = -block.mass * floor, fz = -block.mass * k_g, moment = 0;
  for (int side = 0; side < 2; ++side) {
    const double px = side == 0 ? -k_half_base : k_half_base;
    const auto arm_x = [px](const Motion& m) {
      return px * std::cos(m.tilt) - k_half_height * std::sin(m.tilt);
    };
    const double rx = arm_x(now), rz = -px * std::sin(now.tilt) - k_half_height * std::cos(now.tilt);
    const double depth = -(now.z + rz) / k_width;
    if (depth <= 0) {
      if (kept) (*kept)[side] = 0;
      continue;
    }
    const double vx = now.vx + now.rate * rz, vz = now.vz - now.rate * rx;
    const double normal = alpha * depth * (1 - vz / std::hypot(vz, k_normal_speed));
    const double limit = k_friction * normal;
    const double stick = start.stick[side] + now.x + rx - start.x - arm_x(start);
    const double tangential = -std::clamp(k * stick + c * vx, -limit, limit);
    if (kept) (*kept)[side] = std::clamp(stick, -limit / k, limit / k);
    fx += tangential;
    fz += normal;
    moment += rz * tangential - rx * normal;
  }
  return {fx / block.mass, fz / block.mass,
          moment / (block.mass * k_radius * k_radius * (block.inertia - 1))};
}

Motion moved(const Motion& from, const Motion& speeds, const Rates& a, double h) {
  Motion to = from;
  to.x += h * speeds.vx;
  to.z += h * speeds.vz;
  to.tilt += h * speeds.rate;
  to.vx += h * a.x;
  to.vz += h * a.z;
  to.rate += h * a.tilt;
  return to;
}

// Runge-Kutta of fourth order.
Motion step(const Block& block, const Motion& m, const Floor& floor, double t, double h) {
  const auto rates = [&](const Motion& at, double when) { return accelerations(block, at, m, floor(when)); };
  const Rates a = rates(m, t);
  const Motion second = moved(m, m, a, h / 2);
  const Rates b = rates(second, t + h / 2);
  const Motion third = moved(m, second, b, h / 2);
  const Rates c = rates(third, t + h / 2);
  const Motion fourth = moved(m, third, c, h);
  const Rates d = rates(fourth, t + h);
  Motion next =
      moved(moved(moved(moved(m, m, a, h / 6), second, b, h / 3), third, c, h / 3), fourth, d, h / 6);
  accelerations(block, next, m, floor(t + h), &next.stick);
  return next;
}

struct Rocking {
  double peak, half_period, rebound;  // over those of a rigid block on an edge, less 1
};

double tilt_reached(double rate, double inertia) {
  return k_critical - std::acos(std::cos(k_critical) + inertia * k_radius * rate * rate / (2 * k_g));
}

// Thrown so that it reaches `share` of the critical angle. `half_period`: s, of a rigid block on an edge.
Rocking rocking(const Block& block, double share, double half_period) {
  const double rate = std::sqrt(2 * k_g * (std::cos(k_critical * (1 - share)) - std::cos(k_critical)) /
                                (block.inertia * k_radius));
  const double after = rate * (1 - 2 * std::pow(std::sin(k_critical), 2) / block.inertia);
  Motion m;
  m.vx = rate * k_half_height;
  m.vz = rate * k_half_base;
  m.rate = rate;
  constexpr double h = 1e-5;
  double peak = 0, back = 0, rebound = 0;
  for (double t = 0; t < 1.75 * half_period; t += h) {
    const double before = m.tilt;
    m = step(
        block, m, [](double) { return 0.; }, t, h);
    if (back == 0) peak = std::max(peak, m.tilt);
    if (back == 0 && before > 0 && m.tilt <= 0) back = t + h * before / (before - m.tilt);
    if (back > 0) rebound = std::max(rebound, -m.tilt);
  }
  return {peak / (share * k_critical) - 1, back / half_period - 1,
          rebound / tilt_reached(after, block.inertia) - 1};
}

TEST(PlanarBlock, contacts_of_finite_stiffness_move_free_rocking_as_stated) {
  const double alpha = 1e5 * k_g;
  const Rocking half = rocking({100, 2, alpha}, 0.5, 1.202572804);
  EXPECT_NEAR(half.peak, 6.5e-5, 1e-6);
  EXPECT_NEAR(half.half_period, 5.3e-5, 5e-6);
  EXPECT_NEAR(half.rebound, -1e-5, 1e-5);
  const Rocking most = rocking({100, 2, alpha}, 0.8, 2.0918592);
  EXPECT_NEAR(most.peak, 1.14e-4, 1e-6);
  EXPECT_NEAR(most.half_period, 2.0e-4, 5e-6);
  EXPECT_NEAR(most.rebound, 1.4e-4, 1e-5);
  const Rocking uniform = rocking({100, 4. / 3, alpha}, 0.5, 0.9818965831);
  EXPECT_NEAR(uniform.peak, 9.5e-5, 1e-6);
  EXPECT_NEAR(uniform.half_period, 7.7e-5, 5e-6);
  EXPECT_NEAR(uniform.rebound, 4.3e-4, 1e-5);
}

// A pulse of this amplitude over g tan a.
bool overturns(const Floor& pulse, double amplitude) {
  const Block block{10, 2, 1e6 * k_g};
  constexpr double h = 2e-5;
  Motion m;
  m.z -= block.mass * k_g / (2 * k_contacts_of_a_side * block.alpha) * k_width;
  const double size = amplitude * k_g * std::tan(k_critical);
  for (double t = 0; t < 6; t += h) {
    m = step(
        block, m, [&](double s) { return size * pulse(s); }, t, h);
    if (std::abs(m.tilt) > 1.1 * k_critical) return true;
    if (t > 1 && m.tilt * m.rate < 0) return false;
  }
  return false;
}

// Least amplitude that overturns, over that of a rigid block on an edge, less 1.
double shift(const Floor& pulse, double rigid) {
  double low = -2e-3, high = 1e-3;
  while (high - low > 4e-6)
    (overturns(pulse, rigid * (1 + (low + high) / 2)) ? high : low) = (low + high) / 2;
  return (low + high) / 2;
}

TEST(PlanarBlock, contacts_of_finite_stiffness_lower_the_least_pulse_as_stated) {
  const double p = std::sqrt(k_g / (2 * k_radius));
  const auto rectangle = [p](double pt) { return [=](double t) { return t < pt / p ? 1. : 0.; }; };
  const auto half_sine = [p](double wp) {
    return [=](double t) { return t < std::numbers::pi / (wp * p) ? std::sin(wp * p * t) : 0; };
  };
  EXPECT_NEAR(shift(rectangle(0.5), 2.545846008), -8.3e-4, 2e-5);
  EXPECT_NEAR(shift(rectangle(1), 1.582333755), -1.10e-3, 2e-5);
  EXPECT_NEAR(shift(half_sine(2), 1.801223949), -1.5e-5, 5e-6);
  EXPECT_NEAR(shift(half_sine(4), 2.795034411), -3e-5, 5e-6);
  EXPECT_NEAR(shift(half_sine(6), 3.796725428), -7e-5, 5e-6);
}

}  // namespace
}  // namespace topple::test
