// The file side of a Recorder: takes finished rows and puts them on disk so that a reader never sees half of
// one.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording_format.h"

namespace topple::io {

/// An extendible data set with rows of one size; rows are only appended.
class RowSet {
 public:
  RowSet() = default;
  /// Creates it. `fill`: value of a row that was allocated and never written, or nullptr for zeros.
  RowSet(hid_t group, const char* name, hid_t type, std::vector<hsize_t> row_dims, hsize_t chunk_rows,
         const void* fill = nullptr);
  void append(const void* rows, std::size_t count);
  hsize_t rows() const { return dims_[0]; }
  void flush();
  /// Lets go of it without closing.
  void release();
  void describe(const char* units, const char* columns);

 private:
  Handle set_, type_;
  std::vector<hsize_t> dims_;  ///< rows so far, then those of one row
  bool dirty_ = false;
};

/// Writes a recording row by row. Everything appended since the last flush may be lost when the process is
/// killed; whatever was flushed is complete. After a failed write the file is let go of, and every call
/// throws the first WriteError again.
class RecordingWriter {
 public:
  /// A row stays in memory at most this long while flush_if_due is called often; half of the promised 100 ms.
  static constexpr std::chrono::milliseconds k_flush_interval{50};

  /// Starts the recording beside the target. The first flush with a frame gives it its name, so that a start
  /// that fails leaves an older file there as it was. Throws WriteError.
  RecordingWriter(const host::Target& target, const std::string& scene_name, const std::string& scene_text,
                  const Model& model, const RowShape& shape, const std::vector<SceneFile>& files = {},
                  const std::string& arithmetic = topple::arithmetic());
  /// Closes; without finish() the recording reads as interrupted.
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// Refuses what is not finite, with a WriteError; the recording stays sound and keeps what came before.
  void append(const FrameRow& row);
  void append(const Checkpoint& checkpoint);
  void append(const RecordedEvent& event);
  void append(const Branch& branch);
  void append(const LoggedEdit& edit);
  void flush();
  void flush_if_due();
  void finish(const std::string& status, const std::string& summary_json);

 private:
  template <typename Work>
  void guarded(Work&& work);
  void create(const std::string& scene_name, const std::string& scene_text, const Model& model,
              const std::vector<SceneFile>& files, const std::string& arithmetic);
  void write_files(const std::vector<SceneFile>& files);
  void create_rows();
  [[noreturn]] void refuse(const std::string& what, double time);
  void write_batch();
  void write_pending();
  template <typename Work>
  void for_each_set(Work work);
  void close();
  void detach() noexcept;

  host::StagedFile staged_;
  std::array<FrameField, k_field_count> descriptions_{};
  std::array<std::size_t, k_field_count> field_bytes_{};
  std::size_t field_count_ = 0;
  std::optional<std::string> failure_;
  bool finished_ = false;
  std::chrono::steady_clock::time_point last_flush_{};  ///< long ago: the first frame is flushed at once

  Handle file_;
  int descriptor_ = -1;  ///< HDF5's own, owned by file_
  std::array<RowSet, k_field_count> fields_;
  RowSet frame_index_, checkpoint_state_, checkpoint_index_, events_, edits_, blobs_, branches_, result_,
      summary_;

  std::array<std::vector<std::byte>, k_field_count> batch_;  ///< rows not yet handed to HDF5
  std::size_t batch_rows_ = 0;
  std::int64_t frames_ = 0;
  std::vector<FrameRecord> pending_frames_;  ///< of rows that HDF5 has, or that are in the batch
  std::vector<CheckpointRecord> pending_checkpoints_;
  std::vector<EventRecord> pending_events_;
  std::vector<BranchRecord> pending_branches_;
  std::vector<EditRecord> pending_edits_;
  std::int32_t newest_branch_ = 0;
};

}  // namespace topple::io
