#include "solver/excitation.h"

#include <algorithm>
#include <cmath>

namespace topple {
namespace {

double sine(const Shake& shake, double tau) {
  const double phase = shake.frequency * tau;  // cycles since the start
  if (shake.cycles > 0 && phase >= shake.cycles) return 0;
  double window = 1;
  if (shake.taper > 0) {
    const auto rise = [](double x) { return x >= 1 ? 1 : (1 - std::cos(k_pi * x)) / 2; };
    window = rise(phase / shake.taper);
    if (shake.cycles > 0) window *= rise((shake.cycles - phase) / shake.taper);
  }
  return shake.amplitude * window * std::sin(2 * k_pi * phase);
}

double pulse(const Shake& shake, double tau) {
  if (tau >= shake.duration) return 0;
  switch (shake.shape) {
    case Shake::Shape::half_sine:
      return shake.amplitude * std::sin(k_pi * tau / shake.duration);
    case Shake::Shape::full_sine:
      return shake.amplitude * std::sin(2 * k_pi * tau / shake.duration);
    case Shake::Shape::rectangle:
      return shake.amplitude;
  }
  return 0;
}

}  // namespace

double shake_acceleration(const Shake& shake, double t) {
  const double tau = t - shake.start;
  if (tau < 0) return 0;
  return shake.kind == Shake::Kind::sine ? sine(shake, tau) : pulse(shake, tau);
}

Vec3 floor_acceleration(const std::vector<Shake>& shakes, double t) {
  Vec3 sum = Vec3::Zero();
  for (const Shake& shake : shakes) sum += shake_acceleration(shake, t) * shake.direction;
  return sum;
}

Vec3 floor_velocity_jump(const std::vector<Shake>& shakes, double t0, double t1) {
  Vec3 sum = Vec3::Zero();
  for (const Shake& shake : shakes)
    if (shake.kind == Shake::Kind::sine && shake.initial_velocity == Shake::Start::jump &&
        shake.start >= t0 && shake.start < t1)
      sum -= shake.amplitude / (2 * k_pi * shake.frequency) * shake.direction;
  return sum;
}

void advance_floor(Vec3& displacement, Vec3& velocity, const Vec3& a0, const Vec3& a1, double h) {
  const double w = 2 * k_pi * k_floor_corner, c = std::sqrt(2.) * w, k = w * w;
  const Vec3 v0 = velocity;
  const Vec3 rhs = (1 - h / 2 * c - h * h / 4 * k) * v0 - h * k * displacement + h / 2 * (a0 + a1);
  velocity = rhs / (1 + h / 2 * c + h * h / 4 * k);
  displacement += h / 2 * (v0 + velocity);
}

}  // namespace topple
