// Motion of the floor.
#pragma once

#include "solver/parameters.h"
#include "solver/types.h"

namespace topple {

/// Acceleration of one shake at time t, m/s^2, world axes: A sin(2 pi f (t - start)) times a smooth taper, or
/// a pulse. After an edit of the frequency the phase goes on from where it was.
Vec3 shake_acceleration(const Shake& shake, double t);

/// Amplitude along its direction at time t, between two edits as between two values, m/s^2.
Vec3 shake_amplitude(const Shake& shake, double t);

/// Cycles that a sine has passed at time t.
double shake_turns(const Shake& shake, double t);

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
