// Seismic intensity of a motion as the Japan Meteorological Agency computes it.
#pragma once

#include <vector>

#include "solver/math/types.h"
#include "solver/model/parameters.h"

namespace topple::study {

/// Accelerations in equal intervals.
struct Motion {
  double interval = 0;        ///< s, > 0
  std::vector<Vec3> samples;  ///< m/s^2, world axes
};

/// Of the floor from t = 0 to `duration`, 200 a second. Velocity jumps (excitation.h) are not in it.
Motion floor_motion(const std::vector<Shake>& shakes, double duration);

/// Largest length of the acceleration vector, m/s^2; 0 without samples.
double peak(const Motion& motion);

/// Gain of the three filters together at f > 0 Hz:
///   sqrt(1/f) / sqrt(1 + 0.694 x^2 + 0.241 x^4 + 0.0557 x^6 + 0.009664 x^8 + 0.00134 x^10 + 0.000155 x^12)
///   sqrt(1 - exp(-(f/0.5)^3)),  x = f/10 Hz;
/// 0 at f = 0. For accelerations in gal, as JMA has it; not a plain number but Hz^-1/2.
double intensity_filter(double f);

/// The acceleration a, gal, that the length of the filtered vector reaches or exceeds for 0.3 s in all; 0 for
/// a motion shorter than that.
double intensity_acceleration(const Motion& motion);

/// Instrumental seismic intensity 2 log10(a) + 0.94 of a in gal, rounded to two decimals and then cut to one.
/// At least 0, which JMA gives for what is weaker. Source: Ministry of Transport notice 4 of 1996, and the
/// agency's page on how the intensity is found, whose example has a = 127.85 gal and 5.1.
double instrumental_intensity(double a_gal);

/// The ten degrees of the scale.
enum class IntensityScale {
  zero,
  one,
  two,
  three,
  four,
  five_lower,
  five_upper,
  six_lower,
  six_upper,
  seven
};

/// The degree of an instrumental intensity: 5 lower from 4.5, 5 upper from 5.0 on, and so forth.
IntensityScale intensity_scale(double intensity);

}  // namespace topple::study
