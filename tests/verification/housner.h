// A rigid block that rocks on its edges without slipping and lands after Housner (1963).
//   th'' = -p^2 (s sin(a - |th|) + a(t)/g cos(a - |th|)),  s the sign of th,  p^2 = m g R/I about the edge
//   at th = 0: th' -> (1 - 2 m R^2 sin^2 a/I) th'; from rest th'' by the first edge that |a(t)| > g tan a
//   lifts
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace topple::test {

struct Block {
  double half_base, half_height;  ///< m
  double inertia;                 ///< about the edge over m R^2
  double gravity = 9.80665;       ///< m/s^2
  double radius = std::hypot(half_base, half_height);
  double critical = std::atan(half_base / half_height);
  double p = std::sqrt(gravity / (inertia * radius));
  double kept = 1 - 2 * std::pow(std::sin(critical), 2) / inertia;  ///< of the rate, by an impact
};

/// Floor acceleration over g tan a at a time in s.
using Pulse = std::function<double(double)>;

struct Motion {
  double tilt, rate;
};

inline double acceleration(const Block& block, double side, double tilt, double floor) {
  const double left = block.critical - side * tilt;
  return -block.p * block.p * (side * std::sin(left) + floor * std::tan(block.critical) * std::cos(left));
}

/// Runge-Kutta of fourth order on the edge of this side; beyond tilt 0 the same equation goes on.
inline Motion moved(const Block& block, double side, const Motion& m, double t, double h,
                    const Pulse& pulse) {
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
  std::vector<double> impacts;  ///< s
  std::vector<double> peaks;    ///< rad, before the first impact, then after each
  bool overturned = false;      ///< the tilt passed the last one asked for
};

/// Called after each step and each impact with the time in s and the tilt in rad.
using Seen = std::function<void(double t, double tilt)>;

/// Steps of h, impacts located within them, until `duration` or a tilt beyond `last`, in critical angles.
inline Rocking rock(
    const Block& block, Motion m, const Pulse& pulse, double duration, double h, double last = 1.5,
    const Seen& seen = [](double, double) {}) {
  Rocking out{{}, {std::abs(m.tilt)}};
  double side = m.tilt > 0 ? 1 : m.tilt < 0 ? -1 : 0;
  for (double t = 0; t < duration;) {
    if (side == 0) {
      if (const double floor = pulse(t); std::abs(floor) > 1) side = floor > 0 ? -1 : 1;
      t += h;
      seen(t, 0);
      continue;
    }
    const Motion next = moved(block, side, m, t, h, pulse);
    if (side * next.tilt > 0 || side * next.rate > 0) {
      m = next;
      t += h;
      seen(t, m.tilt);
      out.peaks.back() = std::max(out.peaks.back(), side * m.tilt);
      if (side * m.tilt > last * block.critical) return out.overturned = true, out;
      continue;
    }
    double low = 0, high = h;  // the impact lies between
    while (high - low > 1e-13) {
      const double middle = (low + high) / 2;
      (side * moved(block, side, m, t, middle, pulse).tilt > 0 ? low : high) = middle;
    }
    m = {0, block.kept * moved(block, side, m, t, high, pulse).rate};
    t += high;
    seen(t, 0);
    side = -side;
    out.impacts.push_back(t);
    out.peaks.push_back(0);
    if (std::abs(m.rate) < 1e-9) side = 0;
  }
  return out;
}

}  // namespace topple::test
