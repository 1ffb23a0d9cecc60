// Motion of the floor.
#pragma once

#include <span>
#include <vector>

#include "solver/math/types.h"
#include "solver/model/building.h"
#include "solver/model/parameters.h"
#include "solver/model/table.h"

namespace topple {

/// A shape of pulse. A new one is a Shake::Shape and a row of the table in excitation.cpp.
struct PulseTraits {
  Shake::Shape kind;
  const char* word;                     ///< in scenes
  double (*value)(double t, double T);  ///< over the amplitude, at time t in 0..T of its duration T, s
  std::span<const double> kinks;  ///< t/T within the pulse at which value or slope jump: steps end there
  double velocity;                ///< greatest velocity that it gives the floor, over amplitude times T
  double cycles;  ///< periods within T of the sine whose half waves last as long as its pushes
};
std::span<const PulseTraits> pulse_shapes();
inline const PulseTraits& traits(Shake::Shape shape) {
  return row_of(pulse_shapes(), shape);
}

/// A kind of shake. A new one is a Shake::Kind and a row of the table in excitation.cpp.
struct ShakeTraits {
  Shake::Kind kind;
  const char* word;  ///< in scenes
  // Which members of Shake it uses.
  bool has_amplitude;  ///< amplitude, direction
  bool has_frequency;  ///< frequency, taper
  bool has_duration, has_shape;
  bool has_record;                               ///< record, scale
  bool steady;                                   ///< cycles, initial_velocity: one frequency, which may go on
  bool sweeps;                                   ///< the frequency goes from `frequency` to `last_frequency`
  Vec3 (*acceleration)(const Shake&, double t);  ///< m/s^2, t not before its start
  double (*end)(const Shake&);                   ///< see shake_end, s
  double (*period)(const Shake&, double t);      ///< s, of its motion at time t
  void (*complete)(Shake&);  ///< sets what a sine does not have, when an edit turns one into this; or null
};
std::span<const ShakeTraits> shake_kinds();
inline const ShakeTraits& traits(Shake::Kind kind) {
  return row_of(shake_kinds(), kind);
}

/// The floor becomes one of a building with these modes (`storey`, `of`: see FloorResponse), which the shake
/// moves at its ground (building.h): along it horizontally, by the same modes in every direction; vertically
/// it moves with the ground. Kind, frequency, duration, shape and record stay as they are from then on;
/// amplitude, direction, scale, on and off, with their ramps, are factors on the floor's motion. False: it
/// takes more than k_most_floor_intervals.
bool put_in_building(std::vector<BuildingMode> modes, int storey, int of, Shake& shake);

/// Time from which on the ground of a building is still, s; of a shake without one shake_end.
double ground_end(const Shake& shake);

/// Acceleration of one shake at time t, m/s^2, world axes: in a building that of its floor, else A sin(2 pi
/// n) times a smooth taper, n = shake_turns; a pulse; or scale times a record (accelerogram.h). Allocates
/// nothing.
Vec3 shake_acceleration(const Shake& shake, double t);

/// Amplitude times direction at time t, m/s^2; 0 when off. After an edit it goes from the old to the new
/// value over Shake::ramp.
Vec3 shake_amplitude(const Shake& shake, double t);

/// Factor of a record at time t, likewise.
double shake_scale(const Shake& shake, double t);

/// Cycles that a sine or sweep has passed at time t. Sine: f (t - start); after an edit of the frequency the
/// phase goes on from where it was. Sweep: exponential, f(t) = f0 (f1/f0)^(x/T) with x = t - start, so that
/// each octave takes as long: f0 T/ln(f1/f0) ((f1/f0)^(x/T) - 1).
double shake_turns(const Shake& shake, double t);

/// Frequency of a sine or sweep at time t, Hz.
double shake_frequency(const Shake& shake, double t);
/// Of a kind with a frequency the highest that it comes to, Hz; else 0.
double highest_frequency(const Shake& shake);
/// Fewer rows in a period draw another motion.
inline constexpr double k_rows_in_period = 4;
/// Whether rows at `output_rate`, Hz, show the floor's motion.
bool rows_follow(const Shake& shake, double output_rate);

/// Time from which on the shake is 0, s; infinite for a sine that goes on.
double shake_end(const Shake& shake);

/// Shortest time between the samples of the records that shake the floor at time t, s; infinite without one.
double sample_interval(const std::vector<Shake>& shakes, double t);

/// Sum of all shakes, m/s^2, world axes.
Vec3 floor_acceleration(const std::vector<Shake>& shakes, double t);

/// Of |floor_acceleration| at all times an upper bound, m/s^2.
double greatest_acceleration(const std::vector<Shake>& shakes);

/// Velocity jump of the floor of the shakes that start in [t0, t1): -A/(2 pi f) along the direction for each
/// with `initial_velocity = jump`, m/s; in a building the share that passes its modes by.
Vec3 floor_velocity_jump(const std::vector<Shake>& shakes, double t0, double t1);

/// Whether the floor's acceleration jumps at t, s, but for what rounding makes of times: at the start or end
/// of a shake, as of a rectangle. Then what it is until t, and from t on, m/s^2.
bool acceleration_jumps(const std::vector<Shake>& shakes, double t);
Vec3 acceleration_until(const std::vector<Shake>& shakes, double t);
Vec3 acceleration_from(const std::vector<Shake>& shakes, double t);

/// Corner frequency of the causal high-pass that turns the acceleration into the displayed displacement, Hz.
inline constexpr double k_floor_corner = 0.05;

/// Advances the filter d'' + 2 z w d' + w^2 d = a(t), z = 1/sqrt(2), w = 2 pi k_floor_corner, by h (s) with
/// the accelerations a0 and a1 at the two ends, m/s^2 (trapezoidal rule).
void advance_floor(Vec3& displacement, Vec3& velocity, const Vec3& a0, const Vec3& a1, double h);

}  // namespace topple
