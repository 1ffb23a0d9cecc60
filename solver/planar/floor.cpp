#include "solver/planar/floor.h"

#include <array>
#include <cmath>

#include "solver/math/elementary.h"
#include "solver/math/ranges.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"

namespace topple::planar {
namespace {

using Line = Series<double>;

Line line(double value, double slope) {
  Line of(value);
  of[1] = slope, of.degree = slope == 0 ? 0 : 1;
  return of;
}

Line product(const Line& a, const Line& b) {
  Line of;
  of.degree = std::min(a.degree + b.degree, k_order);
  for (int i = 0; i <= of.degree; ++i) {
    double sum = 0;
    for (int j = std::max(0, i - a.degree); j <= std::min(i, b.degree); ++j) sum += a[i - j] * b[j];
    of[i] = sum;
  }
  return of;
}

void add(Line& to, double factor, const Line& of) {
  for (int i = 0; i <= of.degree; ++i) to[i] = to.or_zero(i) + factor * of[i];
  to.degree = std::max(to.degree, of.degree);
}

/// sin and cos of 2 pi turns: s' = c p', c' = -s p'.
struct Wave {
  Line sine, cosine;
  explicit Wave(const Line& turns) {
    double phase = turns[0] - std::floor(turns[0]);
    const elementary::SinCos of = elementary::sin_cos(2 * k_pi * phase);
    sine[0] = of.sine, cosine[0] = of.cosine;
    sine.degree = cosine.degree = turns.degree == 0 ? 0 : k_order;
    if (turns.degree == 1) {
      const double rate = 2 * k_pi * turns[1];
      for (int i = 0; i < k_order; ++i) {
        const double factor = rate * k_reciprocal[static_cast<std::size_t>(i + 1)];
        sine[i + 1] = factor * cosine[i], cosine[i + 1] = -factor * sine[i];
      }
      return;
    }
    Line slope(0);
    for (int i = 1; i <= turns.degree; ++i) slope[i - 1] = 2 * k_pi * i * turns[i];
    for (int i = 0; i < sine.degree; ++i) {
      const double reciprocal = k_reciprocal[static_cast<std::size_t>(i + 1)];
      sine[i + 1] = reciprocal * product_term(cosine, slope, i, turns.degree - 1);
      cosine[i + 1] = -reciprocal * product_term(sine, slope, i, turns.degree - 1);
    }
  }
};

/// A part of one shake, with the end of its validity.
struct Part {
  double end = k_never;

  void ends_at(double when, double t) {
    if (when > t) end = std::min(end, when);
  }
};

/// (1 - cos(pi x))/2, smoothly from 0 to 1.
Line rise(const Line& x) {
  Line half = x;
  for (int i = 0; i <= x.degree; ++i) half[i] /= 2;
  Line of = Wave(half).cosine;
  for (int i = 0; i <= of.degree; ++i) of[i] /= -2;
  of[0] += 0.5;
  return of;
}

/// Share of the new values in an edit's ramp.
Line share(const ParameterRamp& ramp, double t, Part& part) {
  if (ramp.over == 0 || t >= ramp.since + ramp.over) return line(1, 0);
  part.ends_at(ramp.since, t);
  part.ends_at(ramp.since + ramp.over, t);
  if (t < ramp.since) return line(0, 0);
  return rise(line((t - ramp.since) / ramp.over, 1 / ramp.over));
}

Line turns_of(const Shake& shake, double t) {
  const double turns = shake_turns(shake, t);
  if (!traits(shake.kind).sweeps) return line(turns, shake.frequency);
  const double rate = elementary::log(shake.last_frequency / shake.frequency) / shake.duration;
  Line of(turns);
  of.degree = k_order;
  of[1] = shake.frequency * elementary::exp(rate * (t - shake.start));
  for (int i = 2; i <= k_order; ++i) of[i] = of[i - 1] * rate / i;
  return of;
}

/// When a sine or sweep has passed this many turns, s.
double time_of(const Shake& shake, double turns) {
  if (!traits(shake.kind).sweeps) return shake.start + shake.turned + (turns - shake.turns) / shake.frequency;
  const double octaves = elementary::log(shake.last_frequency / shake.frequency);
  if (octaves == 0) return shake.start + turns / shake.frequency;
  return shake.start +
         shake.duration / octaves * elementary::log1p(octaves * turns / (shake.frequency * shake.duration));
}

Line periodic(const Shake& shake, double t, Part& part) {
  const double cycles =
      traits(shake.kind).sweeps ? shake_turns(shake, shake.start + shake.duration) : shake.cycles;
  const Line turns = turns_of(shake, t);
  Line of = Wave(turns).sine;
  if (shake.taper == 0) return of;
  const auto window = [&](double full, const Line& x, bool rising) {
    const double when = time_of(shake, full);
    part.ends_at(when, t);
    if (rising == (t < when)) of = product(of, rise(x));
  };
  Line x = turns;
  for (int i = 0; i <= x.degree; ++i) x[i] /= shake.taper;
  window(shake.taper, x, true);
  if (cycles > 0) {
    for (int i = 0; i <= x.degree; ++i) x[i] = -x[i];
    x[0] += cycles / shake.taper;
    window(cycles - shake.taper, x, false);
  }
  return of;
}

struct PulseSeries {
  Shake::Shape kind;
  double turns;  ///< of the sine in its duration; 0: constant
};
constexpr PulseSeries k_pulses[] = {
    {Shake::Shape::half_sine, 0.5}, {Shake::Shape::full_sine, 1}, {Shake::Shape::rectangle, 0}};

Line pulse(const Shake& shake, double t, Part& part) {
  for (const double kink : traits(shake.shape).kinks) part.ends_at(shake.start + kink * shake.duration, t);
  const double turns = row_of(k_pulses, shake.shape).turns;
  if (turns == 0) return line(1, 0);
  return Wave(line(turns * (t - shake.start) / shake.duration, turns / shake.duration)).sine;
}

/// One component `since` seconds after the record's start at `start`.
Line recorded(const AccelerogramComponent& component, double start, double t, Part& part) {
  const std::size_t last = component.samples.size() - 1;
  const auto sample_time = [&](std::size_t i) { return start + static_cast<double>(i) * component.interval; };
  auto i = static_cast<std::size_t>((t - start) / component.interval);
  while (i <= last && sample_time(i + 1) <= t) ++i;
  while (i > 0 && sample_time(i) > t) --i;
  if (i >= last) return line(0, 0);
  part.ends_at(sample_time(i + 1), t);
  const double slope = (component.samples[i + 1] - component.samples[i]) / component.interval;
  return line(component.samples[i] + slope * (t - sample_time(i)), slope);
}

struct Kind {
  Shake::Kind kind;
  Line (*shape)(const Shake&, double t, Part&);  ///< over the amplitude; null: of a record
};
constexpr Kind k_kinds[] = {{Shake::Kind::sine, periodic},
                            {Shake::Kind::sweep, periodic},
                            {Shake::Kind::pulse, pulse},
                            {Shake::Kind::record, nullptr}};

/// What an edit's ramp makes of the amplitude or scale.
struct Share {
  Share(const Shake& shake, double t, Part& part)
      : now(share(shake.ramp, t, part)), whole(now.degree == 0 && now[0] == 1) {}
  Line ramped(double before, double after) const {
    Line of(before);
    add(of, after - before, now);
    return of;
  }
  Line now;
  bool whole;  ///< no ramp, or it is over
};

/// What the modes of a building add to its ground's motion.
void add_floor_of_building(const Shake& shake, const Vec3& along, double t, const Share& share, Part& part,
                           Line& horizontal) {
  const auto& components = shake.building->components;
  for (std::size_t k = 0; k < components.size(); ++k) {
    const double interval = components[k].interval;
    // a time that rounding puts just before an interval's end belongs to the next one
    double place = (t - shake.start) / interval, u = 0;
    if (const double next = std::round(place); shake.start + next * interval <= t)
      place = std::max(place, next);
    const double first = std::floor(place);
    const FloorResponse::Cubic* const c = floor_curve(components[k], (first + 0.5) * interval, u);
    if (!c) continue;
    part.ends_at(shake.start + (first + 1) * interval, t);
    u = place - first;
    Line of((*c)[0] + u * ((*c)[1] + u * ((*c)[2] + u * (*c)[3])));
    of.degree = 3;
    of[1] = ((*c)[1] + u * (2 * (*c)[2] + 3 * u * (*c)[3])) / interval;
    of[2] = ((*c)[2] + 3 * u * (*c)[3]) / (interval * interval);
    of[3] = (*c)[3] / (interval * interval * interval);
    const auto level = [&](const Vec3& v) { return v.x() * along.x() + v.y() * along.y(); };
    const bool recorded = traits(shake.kind).has_record;
    const double direction = recorded ? level(shake.record->components[k].direction) : 1,
                 before = recorded ? shake.scale_before : level(shake.amplitude_before),
                 now = !shake.on  ? 0
                       : recorded ? shake.scale
                                  : level(shake.amplitude * shake.direction);
    add(horizontal, direction, share.whole ? product(Line(now), of) : product(share.ramped(before, now), of));
  }
}

/// Returns how long it holds.
double add_shake(const Shake& shake, const Vec3& along, double t, Line& horizontal, Line& vertical) {
  Part part;
  part.ends_at(shake.start, t);
  part.ends_at(shake_end(shake), t);
  part.ends_at(ground_end(shake), t);
  if (t < shake.start || t >= shake_end(shake)) return part.end;
  const Share share_now{shake, t, part};
  if (t < ground_end(shake)) {
    const double level = shake.building ? shake.building->ground : 1;
    const auto add_along = [&](const Vec3& direction, const Line& of) {
      if (level * direction.dot(along) != 0) add(horizontal, level * direction.dot(along), of);
      if (direction.z() != 0) add(vertical, direction.z(), of);
    };
    if (const auto shape = row_of(k_kinds, shake.kind).shape) {
      const Line of = shape(shake, t, part);
      const Vec3 now = shake.on ? Vec3(shake.amplitude * shake.direction) : Vec3(Vec3::Zero());
      if (share_now.whole)
        add_along(now, of);
      else
        for (const Vec3& axis : {along, Vec3(Vec3::UnitZ())})
          add_along(axis, product(of, share_now.ramped(shake.amplitude_before.dot(axis), now.dot(axis))));
    } else {
      const double before = shake.scale_before, now = shake.on ? shake.scale : 0;
      for (const AccelerogramComponent& component : shake.record->components) {
        Line of = recorded(component, shake.start, t, part);
        if (share_now.whole)
          for (int i = 0; i <= of.degree; ++i) of[i] *= before + (now - before);
        else
          of = product(share_now.ramped(before, now), of);
        add_along(component.direction, of);
      }
    }
  }
  if (shake.building) add_floor_of_building(shake, along, t, share_now, part, horizontal);
  return part.end;
}

}  // namespace

namespace {

/// Of a record alone, whose components are sampled together, from sample to sample.
double quiet(const ShakenPlane& plane, double t, double until, std::span<const FloorSign> signs) {
  if (plane.shakes.size() != 1) return t;
  const Shake& shake = plane.shakes.front();
  if (!traits(shake.kind).has_record || shake.building || !shake.on || t < shake.start ||
      (shake.ramp.over > 0 && t < shake.ramp.since + shake.ramp.over))
    return t;
  const std::vector<AccelerogramComponent>& components = shake.record->components;
  const double interval = components.front().interval;
  const std::size_t count = components.front().samples.size();
  struct Sampled {
    double along, up;
    const double* samples;
  };
  std::array<Sampled, 3> sampled;
  if (components.size() > sampled.size()) return t;
  for (std::size_t c = 0; c < components.size(); ++c) {
    const AccelerogramComponent& one = components[c];
    if (one.interval != interval || one.samples.size() != count) return t;
    sampled[c] = {one.direction.dot(plane.along), one.direction.z(), one.samples.data()};
  }
  const auto all_positive = [&](std::size_t i) {
    double along = 0, up = 0;
    for (std::size_t c = 0; c < components.size(); ++c) {
      along += sampled[c].along * sampled[c].samples[i];
      up += sampled[c].up * sampled[c].samples[i];
    }
    along *= shake.scale, up *= shake.scale;
    return ranges::all_of(
        signs, [&](const FloorSign& sign) { return sign.along * along + sign.up * up + sign.offset > 0; });
  };
  const auto time_of_sample = [&](std::size_t i) { return shake.start + static_cast<double>(i) * interval; };
  auto i = static_cast<std::size_t>((t - shake.start) / interval);
  double out = t;
  if (i >= count || !all_positive(i)) return out;
  while (++i < count && time_of_sample(i) <= until && all_positive(i)) out = std::max(t, time_of_sample(i));
  return out;
}

}  // namespace

Floor floor_at_rest() {
  return {[](const void*, double, Line& horizontal, Line& vertical) {
            horizontal = vertical = 0;
            return k_never;
          },
          nullptr};
}

Floor shaken(const ShakenPlane& plane) {
  return {[](const void* floor, double t, Line& horizontal, Line& vertical) {
            const auto& of = *static_cast<const ShakenPlane*>(floor);
            horizontal = vertical = 0;
            double end = k_never;
            for (const Shake& shake : of.shakes)
              end = std::min(end, add_shake(shake, of.along, t, horizontal, vertical));
            return end;
          },
          &plane,
          [](const void* floor, double t, double until, std::span<const FloorSign> signs) {
            return quiet(*static_cast<const ShakenPlane*>(floor), t, until, signs);
          }};
}

}  // namespace topple::planar
