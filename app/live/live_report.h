// What a live run is made of and what it reports.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/support/language.h"
#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"
#include "solver/run/history.h"

namespace topple::app {

using RowPtr = std::shared_ptr<const io::FrameRow>;

/// State of a live run.
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
  std::vector<Said> warnings;  ///< over
  int element = -1;            ///< failed: where; -1: not an element's fault
  std::string recording;       ///< path; empty: nothing is recorded yet
  std::string record_failure;  ///< why the recording broke off; empty: it did not
};

/// Of the equilibrium at the end of a load step, with what was lost beyond it where the path ended there.
struct StepStability {
  std::int32_t branch;
  std::int64_t step;
  Stability stability;
};

/// What is new since the last report.
struct LiveReport {
  std::vector<Branch> branches;
  std::vector<LoggedEdit> edits;
  /// As recorded, in order within a branch. One of the start takes the place of another: edits change it.
  std::vector<RowPtr> rows;
  std::vector<io::RecordedEvent> events;
  std::vector<StepStability> stabilities;  ///< of static runs
  RowPtr head;                             ///< the newest state of a live run; null: as before
  std::vector<double> anchor_peaks;        ///< N, greatest force so far of the live branch; empty: as before
  LiveStatus status;
};

/// What to run and where to record it.
struct LiveSource {
  std::shared_ptr<const io::Scene> scene;
  std::optional<io::Recording> recording = {};  ///< replay this recording of the scene, which may still grow
  std::string output = {};                      ///< where a live run is recorded; empty: nowhere
  bool force = false;                           ///< in place of a file of any kind
};

/// Makes one step; tests slow it down.
using LiveAdvance = std::function<StepStatus(Run&)>;

}  // namespace topple::app
