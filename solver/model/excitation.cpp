#include "solver/model/excitation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/elementary.h"
#include "solver/math/ranges.h"
#include "solver/model/accelerogram.h"

namespace topple {
namespace {

constexpr double k_record_period = 1;  // s, what a record is taken to have; it has none of its own
constexpr double k_sweep = 10;         // s, of a sweep that was a sine, to ten times its frequency
constexpr double k_highest = 1e3;      // Hz, legal

constexpr PulseTraits k_shapes[] = {
    {.kind = Shake::Shape::half_sine,
     .word = "half-sine",
     .value = [](double t, double T) { return elementary::sin(k_pi * t / T); },
     .kinks = {},
     .velocity = 2 / k_pi,
     .cycles = 0.5},
    {.kind = Shake::Shape::full_sine,
     .word = "full-sine",
     .value = [](double t, double T) { return elementary::sin(2 * k_pi * t / T); },
     .kinks = {},
     .velocity = 1 / k_pi,
     .cycles = 1},
    {.kind = Shake::Shape::rectangle,
     .word = "rectangle",
     .value = [](double, double) { return 1.; },
     .kinks = {},
     .velocity = 1,
     .cycles = 0.5},
};

Vec3 periodic(const Shake& shake, double t) {
  const double turns = shake_turns(shake, t);
  const double cycles =
      traits(shake.kind).sweeps ? shake_turns(shake, shake.start + shake.duration) : shake.cycles;
  if (cycles > 0 && turns >= cycles) return Vec3::Zero();
  double window = 1;
  if (shake.taper > 0) {
    const auto rise = [](double x) { return x >= 1 ? 1 : (1 - elementary::cos(k_pi * x)) / 2; };
    window = rise(turns / shake.taper);
    if (cycles > 0) window *= rise((cycles - turns) / shake.taper);
  }
  return window * elementary::sin(2 * k_pi * turns) * shake_amplitude(shake, t);
}

Vec3 pulse(const Shake& shake, double t) {
  const double since = t - shake.start;
  if (since >= shake.duration) return Vec3::Zero();
  return traits(shake.shape).value(since, shake.duration) * shake_amplitude(shake, t);
}

Vec3 recorded(const Shake& shake, double t) {
  return shake_scale(shake, t) * acceleration(*shake.record, t - shake.start);
}

double end_of_sine(const Shake& shake) {
  if (shake.cycles == 0) return std::numeric_limits<double>::infinity();
  return shake.start + shake.turned + (shake.cycles - shake.turns) / shake.frequency;
}

double end_by_duration(const Shake& shake) {
  return shake.start + shake.duration;
}

double period_now(const Shake& shake, double t) {
  return 1 / shake_frequency(shake, t);
}

constexpr ShakeTraits k_kinds[] = {
    {.kind = Shake::Kind::sine,
     .word = "sine",
     .has_amplitude = true,
     .has_frequency = true,
     .has_duration = false,
     .has_shape = false,
     .has_record = false,
     .steady = true,
     .sweeps = false,
     .acceleration = periodic,
     .end = end_of_sine,
     .period = period_now,
     .complete = nullptr},
    {.kind = Shake::Kind::sweep,
     .word = "sweep",
     .has_amplitude = true,
     .has_frequency = true,
     .has_duration = true,
     .has_shape = false,
     .has_record = false,
     .steady = false,
     .sweeps = true,
     .acceleration = periodic,
     .end = end_by_duration,
     .period = period_now,
     .complete =
         [](Shake& shake) {
           shake.duration = k_sweep;
           shake.last_frequency = std::min(10 * shake.frequency, k_highest);
         }},
    {.kind = Shake::Kind::pulse,
     .word = "pulse",
     .has_amplitude = true,
     .has_frequency = false,
     .has_duration = true,
     .has_shape = true,
     .has_record = false,
     .steady = false,
     .sweeps = false,
     .acceleration = pulse,
     .end = end_by_duration,
     .period = [](const Shake& shake, double) { return shake.duration; },
     .complete = [](Shake& shake) { shake.duration = 0.5 / shake.frequency; }},
    {.kind = Shake::Kind::record,
     .word = "record",
     .has_amplitude = false,
     .has_frequency = false,
     .has_duration = false,
     .has_shape = false,
     .has_record = true,
     .steady = false,
     .sweeps = false,
     .acceleration = recorded,
     .end = [](const Shake& shake) { return shake.start + shake.record->duration; },
     .period = [](const Shake&, double) { return k_record_period; },
     .complete = nullptr},
};

}  // namespace

std::span<const PulseTraits> pulse_shapes() {
  return k_shapes;
}

std::span<const ShakeTraits> shake_kinds() {
  return k_kinds;
}

double ParameterRamp::share(double t) const {
  if (over == 0 || t >= since + over) return 1;  // without a ramp at t < 0 too: statics' load factor
  return (1 - elementary::cos(k_pi * std::max(t - since, 0.) / over)) / 2;
}

Vec3 shake_amplitude(const Shake& shake, double t) {
  Vec3 now = shake.on ? Vec3(shake.amplitude * shake.direction) : Vec3(Vec3::Zero());
  if (shake.ramp.over == 0) return now;
  const double share = shake.ramp.share(t);
  return (1 - share) * shake.amplitude_before + share * now;
}

double shake_scale(const Shake& shake, double t) {
  const double now = shake.on ? shake.scale : 0;
  if (shake.ramp.over == 0) return now;
  const double share = shake.ramp.share(t);
  return (1 - share) * shake.scale_before + share * now;
}

double shake_turns(const Shake& shake, double t) {
  if (traits(shake.kind).sweeps) {
    const double octaves = elementary::log(shake.last_frequency / shake.frequency);
    if (octaves == 0) return shake.frequency * (t - shake.start);
    return shake.frequency * shake.duration / octaves *
           elementary::expm1(octaves * (t - shake.start) / shake.duration);
  }
  return shake.turns + shake.frequency * (t - shake.start - shake.turned);
}

double shake_frequency(const Shake& shake, double t) {
  if (!traits(shake.kind).sweeps) return shake.frequency;
  const double share = std::clamp((t - shake.start) / shake.duration, 0., 1.);
  return shake.frequency * elementary::pow(shake.last_frequency / shake.frequency, share);
}

double highest_frequency(const Shake& shake) {
  if (!traits(shake.kind).has_frequency) return 0;
  return traits(shake.kind).sweeps ? std::max(shake.frequency, shake.last_frequency) : shake.frequency;
}

bool rows_follow(const Shake& shake, double output_rate) {
  return k_rows_in_period * highest_frequency(shake) <= output_rate;
}

double ground_end(const Shake& shake) {
  return traits(shake.kind).end(shake);
}

double shake_end(const Shake& shake) {
  return shake.building ? shake.start + shake.building->duration : ground_end(shake);
}

bool put_in_building(std::vector<BuildingMode> modes, int storey, int of, Shake& shake) {
  const ShakeTraits& uses = traits(shake.kind);
  std::vector<GroundSignal> ground;
  if (uses.has_record) {
    for (const AccelerogramComponent& component : shake.record->components)
      ground.push_back({.acceleration = [&](double tau) { return acceleration(component, tau); },
                        .grid = component.interval,
                        .shortest = std::numeric_limits<double>::infinity(),
                        .duration = component.interval * static_cast<double>(component.samples.size() - 1)});
  } else {
    Shake unit = shake;
    unit.amplitude = 1, unit.direction = Vec3::UnitX(), unit.start = 0, unit.on = true;
    const double end = uses.end(unit);
    const bool goes_on = !std::isfinite(end);
    GroundSignal& signal = ground.emplace_back();
    signal.acceleration = [unit](double tau) { return traits(unit.kind).acceleration(unit, tau).x(); };
    signal.duration = signal.grid = goes_on ? 1 / unit.frequency : end;
    signal.shortest = std::min(uses.period(unit, 0), uses.period(unit, goes_on ? 0 : end));
    signal.goes_on = goes_on;
    signal.steady = uses.has_frequency ? unit.taper / unit.frequency : 0;
    if (uses.steady && unit.initial_velocity == Shake::Start::jump)
      signal.jump = -1 / (2 * k_pi * unit.frequency);
  }
  const std::shared_ptr<FloorResponse> response = floor_response(std::move(modes), ground);
  if (!response) return false;
  response->storey = storey, response->of = of;
  shake.building = response;
  return true;
}

double sample_interval(const std::vector<Shake>& shakes, double t) {
  double least = std::numeric_limits<double>::infinity();
  for (const Shake& shake : shakes)
    if (traits(shake.kind).has_record && t >= shake.start && t < shake_end(shake))
      least = std::min(least, shake.record->interval);
  return least;
}

Vec3 shake_acceleration(const Shake& shake, double t) {
  if (t < shake.start) return Vec3::Zero();
  Vec3 sum = traits(shake.kind).acceleration(shake, t);
  if (!shake.building) return sum;
  const FloorResponse& building = *shake.building;
  sum.head<2>() *= building.ground;
  for (std::size_t k = 0; k < building.components.size(); ++k) {
    const Vec3 along = shake.record ? Vec3(shake_scale(shake, t) * shake.record->components[k].direction)
                                    : shake_amplitude(shake, t);
    sum.head<2>() += floor_response_at(building.components[k], t - shake.start) * along.head<2>();
  }
  return sum;
}

Vec3 floor_acceleration(const std::vector<Shake>& shakes, double t) {
  Vec3 sum = Vec3::Zero();
  for (const Shake& shake : shakes) sum += shake_acceleration(shake, t);
  return sum;
}

double greatest_acceleration(const std::vector<Shake>& shakes) {
  double greatest = 0;
  for (const Shake& shake : shakes) {
    if (!shake.on) continue;
    const double own = traits(shake.kind).has_record ? shake.record->peak : shake.direction.norm(),
                 scale = traits(shake.kind).has_record ? shake.scale : shake.amplitude;
    greatest +=
        std::abs(scale) *
        (shake.building ? std::max(1., std::abs(shake.building->ground)) * own + shake.building->peak : own);
  }
  return greatest;
}

Vec3 floor_velocity_jump(const std::vector<Shake>& shakes, double t0, double t1) {
  Vec3 sum = Vec3::Zero();
  for (const Shake& shake : shakes)
    if (shake.on && traits(shake.kind).steady && shake.initial_velocity == Shake::Start::jump &&
        shake.start >= t0 && shake.start < t1) {
      const double passed = shake.building ? shake.building->ground : 1;
      sum -= shake.amplitude / (2 * k_pi * shake.frequency) *
             shake.direction.cwiseProduct(Vec3(passed, passed, 1));
    }
  return sum;
}

namespace {

constexpr double k_jump_slack = 1e-9;  // s

}  // namespace

bool acceleration_jumps(const std::vector<Shake>& shakes, double t) {
  constexpr double k_none = 1e-5;  // m/s^2
  const auto is_near = [&](double at) { return std::abs(at - t) <= k_jump_slack; };
  const auto changes = [&](const Shake& shake) {
    const ShakeTraits& kind = traits(shake.kind);
    return is_near(shake.start) ||
           ((kind.has_duration || kind.has_record || shake.cycles > 0) && is_near(ground_end(shake)));
  };
  return ranges::any_of(shakes, changes) &&
         (floor_acceleration(shakes, t + 2 * k_jump_slack) - floor_acceleration(shakes, t - 2 * k_jump_slack))
                 .norm() > k_none;
}

Vec3 acceleration_until(const std::vector<Shake>& shakes, double t) {
  return floor_acceleration(shakes, acceleration_jumps(shakes, t) ? t - 2 * k_jump_slack : t);
}

Vec3 acceleration_from(const std::vector<Shake>& shakes, double t) {
  return floor_acceleration(shakes, acceleration_jumps(shakes, t) ? t + 2 * k_jump_slack : t);
}

void advance_floor(Vec3& displacement, Vec3& velocity, const Vec3& a0, const Vec3& a1, double h) {
  const double w = 2 * k_pi * k_floor_corner, c = std::sqrt(2.) * w, k = w * w;
  const Vec3 v0 = velocity;
  const Vec3 rhs = (1 - h / 2 * c - h * h / 4 * k) * v0 - h * k * displacement + h / 2 * (a0 + a1);
  velocity = rhs / (1 + h / 2 * c + h * h / 4 * k);
  displacement += h / 2 * (v0 + velocity);
}

}  // namespace topple
