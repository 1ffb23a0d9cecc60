// A recording as something that plays: one of its branches, by time.
#pragma once

#include <cstdint>
#include <vector>

#include "app/picture/bridge.h"
#include "solver/io/recording/recording.h"

namespace topple::app {

/// What a recording shows of a branch, by time. The recording must outlive it.
class Replay {
 public:
  explicit Replay(const io::Recording& recording) : Replay(recording, recording.newest_branch()) {}
  Replay(const io::Recording& recording, std::int32_t branch);
  std::int64_t frame_count() const { return static_cast<std::int64_t>(frames_.size()); }
  double first() const { return times_.front(); }  ///< s; a static run: its part of the way
  double last() const { return times_.back(); }
  io::FrameRow frame(std::int64_t number) const { return recording_.frame(frames_[number]); }
  /// Those with which a row came about.
  Parameters parameters(const io::Scene& scene, const io::FrameRow& row) const;
  /// changed_before() there.
  bool changed(const io::Scene& scene, const io::FrameRow& row) const;
  /// Between two rows, or the first or last one.
  io::FrameRow at(double time) const;

 private:
  const io::Recording& recording_;
  std::vector<std::int64_t> frames_;
  std::vector<double> times_;
};

/// Of all rows, or of those before Ctrl+C.
RunExtent extent_of(const Replay& replay, const io::Scene& scene);

}  // namespace topple::app
