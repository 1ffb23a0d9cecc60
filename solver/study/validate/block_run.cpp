#include "solver/study/validate/block_run.h"

#include "solver/planar/integrator.h"

namespace topple::study {

bool overturns(const planar::Block& block, const std::shared_ptr<const Accelerogram>& record, double factor,
               double after) {
  constexpr double k_fallen = 1;  // rad
  Shake shake;
  shake.kind = Shake::Kind::record;
  shake.record = record;
  shake.scale = factor;
  const planar::ShakenPlane plane{{&shake, 1}, Vec3::UnitX()};
  const planar::Floor floor = planar::shaken(plane);
  const planar::Controls controls{.last_tilt = k_fallen};
  const double duration = record->duration + after;
  planar::State state = planar::standing();
  planar::Step step;
  while (state.time < duration) {
    const planar::Event event = planar::advance(block, floor, controls, duration, state, step);
    if (event == planar::Event::overturn) return true;
    if (event == planar::Event::stalled) return false;
  }
  return false;
}

}  // namespace topple::study
