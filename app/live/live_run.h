// A run on a thread of its own: commands in, reports out, nobody waits for the other.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/live/live_report.h"

namespace topple::app {

class LiveWorker;

class LiveRun {
 public:
  using Advance = LiveAdvance;

  /// Starts the thread. `wake` is called from it after each report.
  explicit LiveRun(
      LiveSource source, std::function<void()> wake = [] {}, Advance advance = &Run::advance);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Steps on, `speed` simulated seconds per wall second at most.
  void go(double speed);
  void halt();
  void one_step();
  /// At the next step, before the first one at once (Run::edit); ignored in a replay.
  void edit(const Edit& edit);
  /// Leaves the present branch and begins a new one at the state that `branch` had at `step`, with `edits`.
  void fork(std::int32_t branch, std::int64_t step, std::vector<Edit> edits = {});

  LiveReport take();

  /// Ends the run and closes the recording, within 500 ms, with a step under way or not. `status` is that of
  /// a run which had not come to its end: "stopped" or "interrupted". Returns how it stood in the end.
  /// Nothing may be called afterwards.
  LiveStatus close(const std::string& status);

 private:
  std::shared_ptr<LiveWorker> worker_;  ///< outlives this when a step does
};

}  // namespace topple::app
