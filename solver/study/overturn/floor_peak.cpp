#include "solver/study/overturn/floor_peak.h"

#include <algorithm>

#include "solver/model/excitation.h"
#include "solver/study/common/intensity.h"

namespace topple::study {

FloorPeak floor_peak(std::vector<Shake> shakes, double duration) {
  FloorPeak peak;
  for (const Vec3& at : floor_motion(shakes, duration).samples)
    peak.acceleration = std::max(peak.acceleration, at.head<2>().norm());
  for (Shake& shake : shakes)
    if (traits(shake.kind).steady && (!shake.building || shake.taper == 0)) {
      shake.initial_velocity = Shake::Start::jump;
      shake.taper = 0;
    }
  const Motion motion = floor_motion(shakes, duration);
  Vec3 velocity = Vec3::Zero();
  for (std::size_t i = 0; i < motion.samples.size(); ++i) {
    const double t = static_cast<double>(i) * motion.interval;
    if (i > 0) velocity += motion.interval / 2 * (motion.samples[i - 1] + motion.samples[i]);
    velocity += floor_velocity_jump(shakes, t, t + motion.interval);
    peak.velocity = std::max(peak.velocity, velocity.head<2>().norm());
  }
  return peak;
}

}  // namespace topple::study
