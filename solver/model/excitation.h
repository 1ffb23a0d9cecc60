// Motion of the floor.
#pragma once

#include <span>

#include "solver/math/types.h"
#include "solver/model/parameters.h"
#include "solver/model/table.h"

namespace topple {

/// A form of pulse. A new one is a Shake::Shape and a row of the table in excitation.cpp.
struct PulseTraits {
  Shake::Shape kind;
  const char* word;                     ///< in scenes
  double (*value)(double t, double T);  ///< over the amplitude, at time t in 0..T of its duration T, s
  std::span<const double> kinks;  ///< t/T within the pulse at which value or slope jump: steps end there
  double velocity;                ///< greatest that it gives the floor, over amplitude and T
  double cycles;                  ///< of a sine that pushes as long in one direction
};
std::span<const PulseTraits> pulse_shapes();
inline const PulseTraits& traits(Shake::Shape shape) {
  return row_of(pulse_shapes(), shape);
}

/// A kind of shake.
struct ShakeTraits {
  Shake::Kind kind;
  const char* word;  ///< in scenes
  // Which of its numbers it has; without amplitude and direction it is a record with a scale.
  bool has_amplitude, has_frequency, has_duration;
  bool sweeps;                                   ///< the frequency goes from `frequency` to `last_frequency`
  Vec3 (*acceleration)(const Shake&, double t);  ///< m/s^2 from its start on
  double (*end)(const Shake&);                   ///< s
  double (*period)(const Shake&, double t);      ///< s, of its motion at time t
  void (*complete)(Shake&);  ///< chooses what a sine lacks that becomes one; null: nothing
};
std::span<const ShakeTraits> shake_kinds();
inline const ShakeTraits& traits(Shake::Kind kind) {
  return row_of(shake_kinds(), kind);
}

/// Acceleration of one shake at time t, m/s^2, world axes: A sin(2 pi n) times a smooth taper, n =
/// shake_turns; a pulse; or scale times a record (accelerogram.h). Allocates nothing.
Vec3 shake_acceleration(const Shake& shake, double t);

/// Amplitude along its direction at time t, between two edits as between two values, m/s^2.
Vec3 shake_amplitude(const Shake& shake, double t);

/// Factor of a record at time t, between two edits as between two values.
double shake_scale(const Shake& shake, double t);

/// Cycles that a sine or sweep has passed at time t. Sine: f (t - start); after an edit of the frequency the
/// phase goes on from where it was. Sweep: exponential, f(t) = f0 (f1/f0)^(x/T) with x = t - start, so that
/// each octave takes as long: f0 T/ln(f1/f0) ((f1/f0)^(x/T) - 1).
double shake_turns(const Shake& shake, double t);

/// Of a sine or sweep at time t, Hz.
double shake_frequency(const Shake& shake, double t);

/// Time from which on the shake is 0, s; infinite for a sine that goes on.
double shake_end(const Shake& shake);

/// Shortest time between the samples of the records that shake the floor at time t, s; infinite without one.
double sample_interval(const std::vector<Shake>& shakes, double t);

/// Sum of all shakes, m/s^2, world axes.
Vec3 floor_acceleration(const std::vector<Shake>& shakes, double t);

/// Velocity jump of the floor of the shakes that start in [t0, t1): -A/(2 pi f) along the direction for each
/// with `initial_velocity = jump`, m/s.
Vec3 floor_velocity_jump(const std::vector<Shake>& shakes, double t0, double t1);

/// Corner of the causal high-pass that makes the displayed floor displacement of the acceleration, Hz.
inline constexpr double k_floor_corner = 0.05;

/// Advances the filter d'' + 2 z w d' + w^2 d = a(t), z = 1/sqrt(2), w = 2 pi k_floor_corner, by one step
/// with the accelerations at its two ends (trapezoidal rule).
void advance_floor(Vec3& displacement, Vec3& velocity, const Vec3& a0, const Vec3& a1, double h);

}  // namespace topple
