#include "solver/model/excitation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/elementary.h"
#include "solver/model/accelerogram.h"

namespace topple {
namespace {

// Of amplitude 1.
double sine(const Shake& shake, double t) {
  const double turns = shake_turns(shake, t);
  const double cycles =
      shake.kind == Shake::Kind::sweep ? shake_turns(shake, shake.start + shake.duration) : shake.cycles;
  if (cycles > 0 && turns >= cycles) return 0;
  double window = 1;
  if (shake.taper > 0) {
    const auto rise = [](double x) { return x >= 1 ? 1 : (1 - elementary::cos(k_pi * x)) / 2; };
    window = rise(turns / shake.taper);
    if (cycles > 0) window *= rise((cycles - turns) / shake.taper);
  }
  return window * elementary::sin(2 * k_pi * turns);
}

double pulse(const Shake& shake, double tau) {
  if (tau >= shake.duration) return 0;
  switch (shake.shape) {
    case Shake::Shape::half_sine:
      return elementary::sin(k_pi * tau / shake.duration);
    case Shake::Shape::full_sine:
      return elementary::sin(2 * k_pi * tau / shake.duration);
    case Shake::Shape::rectangle:
      return 1;
  }
  return 0;
}

}  // namespace

double Passage::share(double t) const {
  if (t >= since + over) return 1;
  return (1 - elementary::cos(k_pi * std::max(t - since, 0.) / over)) / 2;
}

Vec3 shake_amplitude(const Shake& shake, double t) {
  Vec3 now = shake.on ? Vec3(shake.amplitude * shake.direction) : Vec3(Vec3::Zero());
  if (shake.passage.over == 0) return now;
  const double share = shake.passage.share(t);
  return (1 - share) * shake.amplitude_before + share * now;
}

double shake_scale(const Shake& shake, double t) {
  const double now = shake.on ? shake.scale : 0;
  if (shake.passage.over == 0) return now;
  const double share = shake.passage.share(t);
  return (1 - share) * shake.scale_before + share * now;
}

double shake_turns(const Shake& shake, double t) {
  if (shake.kind == Shake::Kind::sweep) {
    const double octaves = elementary::log(shake.last_frequency / shake.frequency);
    if (octaves == 0) return shake.frequency * (t - shake.start);
    return shake.frequency * shake.duration / octaves *
           elementary::expm1(octaves * (t - shake.start) / shake.duration);
  }
  return shake.turns + shake.frequency * (t - shake.start - shake.turned);
}

double shake_frequency(const Shake& shake, double t) {
  if (shake.kind != Shake::Kind::sweep) return shake.frequency;
  const double share = std::clamp((t - shake.start) / shake.duration, 0., 1.);
  return shake.frequency * elementary::pow(shake.last_frequency / shake.frequency, share);
}

double shake_end(const Shake& shake) {
  switch (shake.kind) {
    case Shake::Kind::sine:
      if (shake.cycles == 0) return std::numeric_limits<double>::infinity();
      return shake.start + shake.turned + (shake.cycles - shake.turns) / shake.frequency;
    case Shake::Kind::sweep:
    case Shake::Kind::pulse:
      return shake.start + shake.duration;
    case Shake::Kind::record:
      return shake.start + shake.record->duration;
  }
  return 0;
}

double sample_interval(const std::vector<Shake>& shakes, double t) {
  double least = std::numeric_limits<double>::infinity();
  for (const Shake& shake : shakes)
    if (shake.kind == Shake::Kind::record && t >= shake.start && t < shake_end(shake))
      least = std::min(least, shake.record->interval);
  return least;
}

Vec3 shake_acceleration(const Shake& shake, double t) {
  if (t < shake.start) return Vec3::Zero();
  switch (shake.kind) {
    case Shake::Kind::sine:
    case Shake::Kind::sweep:
      return sine(shake, t) * shake_amplitude(shake, t);
    case Shake::Kind::pulse:
      return pulse(shake, t - shake.start) * shake_amplitude(shake, t);
    case Shake::Kind::record:
      return shake_scale(shake, t) * acceleration(*shake.record, t - shake.start);
  }
  return Vec3::Zero();
}

Vec3 floor_acceleration(const std::vector<Shake>& shakes, double t) {
  Vec3 sum = Vec3::Zero();
  for (const Shake& shake : shakes) sum += shake_acceleration(shake, t);
  return sum;
}

Vec3 floor_velocity_jump(const std::vector<Shake>& shakes, double t0, double t1) {
  Vec3 sum = Vec3::Zero();
  for (const Shake& shake : shakes)
    if (shake.on && shake.kind == Shake::Kind::sine && shake.initial_velocity == Shake::Start::jump &&
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
