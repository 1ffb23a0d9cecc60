#include "app/picture/replay.h"

#include <algorithm>

#include "app/support/interrupt.h"

namespace topple::app {

Replay::Replay(const io::Recording& recording, std::int32_t branch)
    : recording_(recording), frames_(recording.frames_on_way_to(branch)) {
  for (const std::int64_t frame : frames_) times_.push_back(recording.index()[frame].time);
}

bool Replay::changed(const io::Scene& scene, const io::FrameRow& row) const {
  return changed_before(scene.setup, recording_.history(), row.branch, row.step);
}

Parameters Replay::parameters(const io::Scene& scene, const io::FrameRow& row) const {
  return parameters_before(scene.setup, recording_.history(), row.branch, row.step);
}

io::FrameRow Replay::at(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  const std::int64_t next = std::min<std::int64_t>(after - times_.begin(), frame_count() - 1);
  const std::int64_t here = std::max<std::int64_t>(next - 1, 0);
  if (times_[here] == time || here == next) return frame(here);
  return blend(frame(here), frame(next), time);
}

RunExtent extent_of(const Replay& replay, const io::Scene& scene) {
  RunExtent extent;
  for (std::int64_t i = 0; i < replay.frame_count() && !interrupted(); ++i)
    extent.add(scene.setup, scene.setup.parameters, replay.frame(i));
  return extent;
}

}  // namespace topple::app
