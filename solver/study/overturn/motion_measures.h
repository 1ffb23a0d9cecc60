// Measures of how strong a floor shakes, over which fragility is told.
#pragma once

#include <span>
#include <vector>

#include "solver/io/scene/scene_key.h"
#include "solver/model/parameters.h"

namespace topple::study {

/// A measure is a row of the table in measures.cpp.
struct MotionMeasure {
  io::Key key;        ///< name, dimension, unit and range of its axis
  const char* title;  ///< "peak horizontal acceleration of the floor"
  double (*of)(const std::vector<Shake>& shakes, double duration);  ///< SI
  /// Proportional to a power of all amplitudes: what lognormal distributions are of. Of a value in the axis's
  /// unit, and back.
  double (*intensity)(double value);
  double (*value)(double intensity);
  double power;       ///< of the amplitudes in the intensity
  const char* usual;  ///< axis
};
std::span<const MotionMeasure> motion_measures();

/// Factor on all amplitudes with which `from` becomes `to`, both > 0, in one unit.
double amplitude_factor(const MotionMeasure& measure, double from, double to);

/// Arias intensity of the horizontal motion, m/s: pi/(2 g) times the integral of a^2.
double arias_intensity(const std::vector<Shake>& shakes, double duration);

}  // namespace topple::study
