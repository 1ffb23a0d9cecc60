// Accelerations that were recorded or computed elsewhere, as samples.
#pragma once

#include <memory>
#include <vector>

#include "solver/math/types.h"

namespace topple {

/// One component of a record.
struct AccelerogramComponent {
  Vec3 direction = Vec3::UnitX();  ///< unit
  double interval = 0;             ///< s between samples, > 0
  std::vector<double> samples;     ///< m/s^2, two or more
};

/// A record: linear between the samples of each component, 0 before the first and after the last. Shared and
/// never changed, so that a copy of Parameters copies no samples.
struct Accelerogram {
  std::vector<AccelerogramComponent> components;
  double duration = 0;             ///< s, from the first to the last sample of the longest component
  double interval = 0;             ///< s, the shortest of the components'
  double peak = 0;                 ///< m/s^2, greatest length of the sum of the components, at their samples
  Vec3 strongest = Vec3::UnitX();  ///< direction of the component with the largest sample
};

/// A record of one or more components; finds the other numbers.
std::shared_ptr<const Accelerogram> make_accelerogram(std::vector<AccelerogramComponent> components);

/// That of one component along its direction.
double acceleration(const AccelerogramComponent& component, double tau);

/// Acceleration `tau` seconds after the first sample, m/s^2, world axes. Takes the same time for every tau.
Vec3 acceleration(const Accelerogram& record, double tau);

/// Subtracts the mean of the samples, of which there is one at least.
void remove_mean(std::vector<double>& samples);

/// Subtracts from the acceleration the parabola c0 + c1 t + c2 t^2 that leaves the least mean square
/// velocity: the drift of the base line goes, and the velocity ends near zero (G. V. Berg, G. W. Housner,
/// Integrated velocity and displacement of strong earthquake ground motion, Bull. Seismol. Soc. Am. 51, 1961,
/// 175-189). Velocities by the trapezoidal rule, from rest. Four samples or more.
void subtract_parabola(std::vector<double>& samples);

}  // namespace topple
