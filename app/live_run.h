// A run on a thread of its own: commands in, reports out, nobody waits for the other.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/history.h"
#include "solver/io/recording.h"
#include "solver/io/scene.h"

namespace topple::app {

using RowPtr = std::shared_ptr<const io::FrameRow>;

/// How it stands with a live run.
struct LiveStatus {
  enum class Kind {
    starting,  ///< settling
    reading,   ///< a recording
    replay,    ///< a recording is all there is: fork() brings it to life
    halted,
    going,
    returning,  ///< on the way back to the instant of a fork
    over,       ///< at the end of the scene's duration or a stop condition
    failed,     ///< a step failed; the newest state is the last good one
    ended       ///< by an error of the program; nothing goes on
  };
  Kind kind = Kind::starting;
  std::int32_t branch = 0;     ///< the one that goes on
  double achieved = 0;         ///< going: simulated s per wall s over the last half second
  std::int64_t forks = 0;      ///< asked for and dealt with
  std::string message;         ///< failed: what, when, where, what to try
  int element = -1;            ///< failed: where; -1: not an element's fault
  std::string recording;       ///< path; empty: nothing is recorded yet
  std::string record_failure;  ///< why the recording broke off; empty: it did not
};

/// What is new since the last report.
struct LiveReport {
  std::vector<Branch> branches;
  std::vector<LoggedEdit> edits;
  std::vector<RowPtr> rows;  ///< as recorded, in order within a branch
  std::vector<io::RecordedEvent> events;
  RowPtr head;  ///< the newest state of a live run; null: as before
  LiveStatus status;
};

/// What to run and where to record it.
struct LiveSource {
  std::shared_ptr<const io::Scene> scene;
  std::optional<io::Recording> recording = {};  ///< replay this recording of the scene, which may still grow
  std::string output = {};                      ///< where a live run is recorded; empty: nowhere
};

class LiveRun {
 public:
  /// Makes one step; tests slow it down.
  using Advance = std::function<StepStatus(Run&)>;

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
  /// At the next step; ignored in a replay.
  void edit(const Edit& edit);
  /// Leaves the present branch and begins a new one at the state that `branch` had at `step`, with `edits`.
  void fork(std::int32_t branch, std::int64_t step, std::vector<Edit> edits = {});

  LiveReport take();

  /// Ends the run and closes the recording, within 500 ms, with a step under way or not. `status` is that of
  /// a run which had not come to its end: "stopped" or "interrupted". Returns how it stood in the end.
  /// Nothing may be called afterwards.
  LiveStatus close(const std::string& status);

 private:
  class Worker;
  std::shared_ptr<Worker> worker_;  ///< outlives this when a step does
};

}  // namespace topple::app
