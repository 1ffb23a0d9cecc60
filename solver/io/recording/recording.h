// Recordings: one HDF5 file with the scene, the frames, the events, the checkpoints, the branches and the
// edits. Contract: interface 5.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "solver/io/common/errors.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/observer.h"
#include "solver/io/scene/scene.h"
#include "solver/math/elementary.h"
#include "solver/run/history.h"

namespace topple::io {

/// Text of the InputError where a scene no longer gives the model that it was recorded with.
inline constexpr const char* k_another_model =
    "the scene in the recording gives another model than the one it was recorded with";

/// Recording::arithmetic() of one that does not name its own: sines and logarithms were the C library's.
inline constexpr const char* k_system_arithmetic = "the system's functions";

/// Writes a recording while the run goes on. One thread owns it. After a failed write it never touches the
/// file again and every call throws the first WriteError.
class Recorder {
 public:
  /// Starts the recording beside the target; the first flush with a frame gives it its name, so that a start
  /// that fails leaves an older file there as it was. Writes branch 0. `arithmetic`: of the rows; of
  /// another recording when it is gone on from. Throws WriteError.
  Recorder(const host::Target& target, const std::string& scene_name, const std::string& scene_text,
           const Model& model, const std::vector<SceneFile>& files = {},
           const std::string& arithmetic = topple::arithmetic());
  ~Recorder();
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;
  void write(const Observation& observation);
  /// Before anything of the branch. Its parent was written before it.
  void write(const Branch& branch);
  /// Before anything that follows from the edit.
  void write(const LoggedEdit& edit);
  /// Puts everything written on disk now.
  void flush();
  /// The same when 50 ms of wall time have passed since the last time. Call it often, also when there is
  /// nothing to write.
  void flush_if_due();
  /// Writes status and summary, which are those of the newest branch, and closes. Without it the file stays
  /// readable, status "interrupted".
  void finish(const std::string& status, const std::string& summary_json);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The instant of a frame or a checkpoint.
struct FrameKey {
  std::int32_t branch;
  std::int64_t step;
  double time;  ///< s
};

/// Reads a recording, also one that is being written or whose writer was killed. Throws InputError (errors.h)
/// with one line for a missing, foreign, truncated, damaged or unknown-version file.
class Recording {
 public:
  explicit Recording(const std::string& path);
  ~Recording();
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;

  std::int32_t format() const;
  /// Which elementary functions its rows and state hashes were computed with (elementary.h).
  const std::string& arithmetic() const;
  /// A run can go on from its checkpoints. States of older formats are packed otherwise: their hashes can be
  /// checked, no more.
  bool can_go_on() const;
  /// Makes zero what frames of its format do not hold.
  void leave_out_unrecorded(FrameRow& row) const;
  const std::string& scene_name() const;
  const std::string& scene_text() const;
  /// Those that the scene names, as they were when it was recorded.
  const std::vector<SceneFile>& scene_files() const;
  const std::string& status() const;        ///< completed, stopped, diverged, interrupted
  const std::string& summary_json() const;  ///< empty when interrupted
  /// Its writer has not closed it: it is at work, or was killed.
  bool left_open() const;
  /// Follows a file that is still being written: takes in what came since. True when there was something new.
  /// Invalidates references to what is below and to status() and summary_json().
  bool refresh();
  std::int64_t frame_count() const;
  /// Frames behind the last one that the writer had begun to put on disk.
  std::int64_t incomplete_frames() const;
  FrameRow frame(std::int64_t index) const;  ///< checks the block's checksum
  /// Of every frame, in the order in which they were written.
  const std::vector<FrameKey>& index() const;
  /// Every branch comes after its parent, the root first; every row's branch is there. The values of edits
  /// are within their ranges; what the scene makes of them is checked by check_edit (edit_text.h).
  const History& history() const;
  /// Indices of the frames that show what led to the newest instant of `branch`, in order of their steps: of
  /// its ancestors up to where the next one begins, and its own. Throws std::invalid_argument as way_to.
  std::vector<std::int64_t> frames_on_way_to(std::int32_t branch) const;
  /// The branch that was begun last: the one to show unless another is asked for.
  std::int32_t newest_branch() const;
  std::vector<RecordedEvent> events() const;
  /// Those that led to the newest instant of `branch`.
  std::vector<RecordedEvent> events_on_way_to(std::int32_t branch) const;
  std::int64_t checkpoint_count() const;
  Checkpoint checkpoint(std::int64_t index) const;
  const std::vector<FrameKey>& checkpoint_index() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The scene from the text and the files in the recording. Throws InputError.
Scene recorded_scene(const Recording& recording);

/// Throws InputError where no run can go on from the recording.
void expect_to_go_on(const Recording& recording);

/// True when the file's first bytes are those of HDF5.
bool is_recording(const std::string& path);

}  // namespace topple::io
