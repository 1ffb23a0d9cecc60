#include "solver/study/overturn/motion_measures.h"

#include <cmath>

#include "solver/math/elementary.h"
#include "solver/math/types.h"
#include "solver/study/common/intensity.h"
#include "solver/study/overturn/floor_peak.h"

namespace topple::study {
namespace {

double itself(double value) {
  return value;
}

/// The acceleration of JMA's formula, gal.
double jma_acceleration(double intensity) {
  return elementary::pow(10, (intensity - 0.94) / 2);
}
double jma_intensity(double gal) {
  return 2 * elementary::log(gal) / elementary::log(10) + 0.94;
}

io::Key key(const char* name, io::Dimension dimension, const char* unit, double least, double most) {
  return {
      .table = "measure", .name = name, .dimension = dimension, .unit = unit, .least = least, .most = most};
}

}  // namespace

std::span<const MotionMeasure> motion_measures() {
  static const MotionMeasure k_measures[] = {
      {key("pga", io::Dimension::acceleration, "gal", 1e-2, 1e3), "peak horizontal acceleration of the floor",
       [](const std::vector<Shake>& shakes, double duration) {
         return floor_peak(shakes, duration).acceleration;
       },
       itself, itself, 1, "pga=50 gal..2000 gal:24"},
      {key("pgv", io::Dimension::velocity, "cm/s", 1e-4, 1e2), "peak horizontal velocity of the floor",
       [](const std::vector<Shake>& shakes, double duration) {
         return floor_peak(shakes, duration).velocity;
       },
       itself, itself, 1, "pgv=5 cm/s..300 cm/s:24"},
      {key("arias", io::Dimension::velocity, "m/s", 1e-6, 1e4), "Arias intensity", arias_intensity, itself,
       itself, 2, "arias=0.05 m/s..50 m/s:24"},
      {key("jma", io::Dimension::none, "", 0.5, 8), "JMA instrumental intensity",
       [](const std::vector<Shake>& shakes, double duration) {
         return jma_intensity(intensity_acceleration(floor_motion(shakes, duration)));
       },
       jma_acceleration, jma_intensity, 1, "jma=3..7:24"}};
  return k_measures;
}

double amplitude_factor(const MotionMeasure& measure, double from, double to) {
  return elementary::pow(measure.intensity(to) / measure.intensity(from), 1 / measure.power);
}

double arias_intensity(const std::vector<Shake>& shakes, double duration) {
  const Motion motion = floor_motion(shakes, duration);
  double sum = 0;
  for (const Vec3& a : motion.samples) sum += a.head<2>().squaredNorm();
  return k_pi / (2 * k_standard_gravity) * sum * motion.interval;
}

}  // namespace topple::study
