// Recordings: one HDF5 file with the scene, the frames, the events and the checkpoints. Contract:
// interface 5.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/run.h"

namespace topple::io {

/// A recording cannot be written (disk full, no permission): one line with path and cause.
struct WriteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One recorded instant. Array shapes: n nodes, e elements, c contact points x planes, b bodies.
struct FrameRow {
  std::int32_t branch = 0;
  std::int64_t step = 0;
  double time = 0;                   ///< s
  std::vector<float> position;       ///< n x 3, m, floor's frame
  std::vector<float> rotation;       ///< n x 4, w x y z
  std::vector<float> section_force;  ///< e x 6: N, Vy, Vz, T, My, Mz at the stress point, N and N m
  std::vector<float> s;              ///< e, integration point
  std::vector<std::uint8_t> hinge;   ///< e: 0 none, 1 at the first end, 2 at the second, 3 broken,
                                     ///< 4 in the middle
  std::vector<float> contact_depth;  ///< c, 1 - l/L; 0: open
  std::vector<float> contact_force;  ///< c x 3, N
  std::vector<double> energy;        ///< input, kinetic, strain, gravity, contact, friction, normal damping,
                                     ///< numerical, balance error; J, last -
  std::vector<double> body;          ///< b x 11: centre x y z (m), quaternion w x y z, tilt (rad), slide (m),
                                     ///< energy (J), critical angle (rad, 0: none)
  std::vector<std::uint8_t> rung;    ///< b: 0 rigid, 1 elastic, 2 frame
  double floor_acceleration[3] = {};  ///< m/s^2
  double floor_displacement[3] = {};  ///< m, high-passed
};

/// The newest state of `run` as a row.
FrameRow frame_row(const Run& run);

/// Writes a recording while the run goes on. One thread owns it. After a failed write it never touches the
/// file again and every call throws the first WriteError.
class Recorder {
 public:
  /// Starts the recording in "PATH.part-PID"; the first observe() flushes it and renames it to `path`, so
  /// that a start that fails leaves an older file there as it was. Throws WriteError.
  Recorder(const std::string& path, const std::string& scene_name, const std::string& scene_text,
           const Model& model);
  ~Recorder();
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;
  /// Call after each accepted step and once before the first: writes rows at the scene's output rate, new
  /// events, and a checkpoint once per simulated second; flushes when 50 ms of wall time have passed.
  void observe(const Run& run);
  /// Puts everything observed on disk now. For a run that pauses: observe() is what flushes otherwise.
  void flush();
  /// Writes the last row, status and summary, and closes. Without it the file stays readable, status
  /// "interrupted".
  void finish(const Run& run, const std::string& status, const std::string& summary_json);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct Checkpoint {
  std::int32_t branch;
  std::int64_t step;
  double time;
  std::uint64_t hash;
  std::vector<double> state;  ///< pack(State)
};

struct RecordedEvent {
  std::int32_t branch;
  std::int64_t step;
  double time;
  Event event;
};

/// Reads a recording, also one that is being written or whose writer was killed. Throws InputError (scene.h)
/// with one line for a missing, foreign, truncated, damaged or unknown-version file.
class Recording {
 public:
  explicit Recording(const std::string& path);
  ~Recording();
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;

  const std::string& scene_name() const;
  const std::string& scene_text() const;
  const std::string& status() const;        ///< completed, stopped, diverged, interrupted
  const std::string& summary_json() const;  ///< empty when interrupted
  /// Follows a file that is still being written: takes in what came since. True when there was something new.
  /// Invalidates references to times(), status() and summary_json().
  bool refresh();
  std::int64_t frame_count() const;
  FrameRow frame(std::int64_t index) const;  ///< checks the block's checksum
  const std::vector<double>& times() const;
  std::vector<RecordedEvent> events() const;
  std::int64_t checkpoint_count() const;
  Checkpoint checkpoint(std::int64_t index) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// True when the file's first bytes are those of HDF5.
bool is_recording(const std::string& path);

/// Writes bodies.csv, nodes.csv, elements.csv and floor.csv into `folder` (created when missing), as
/// interface 4 fixes them. Each file appears whole or not at all. Throws WriteError, InputError.
void export_csv(const Recording& recording, const std::string& folder);

}  // namespace topple::io
