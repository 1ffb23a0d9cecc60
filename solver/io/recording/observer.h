// What a recording holds of a run, and which of its instants are recorded.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "solver/io/recording/frame_row.h"
#include "solver/run/history.h"
#include "solver/run/run.h"

namespace topple::io {

/// A whole state, to go on from.
struct Checkpoint {
  std::int32_t branch;
  std::int64_t step;
  double time;                ///< s
  std::uint64_t hash;         ///< of the packed state (state.h)
  std::vector<double> state;  ///< pack(State)
};

/// No NaN, no infinity in it; integers packed bit for bit do not look like any.
bool is_finite(const Checkpoint& checkpoint);

struct RecordedEvent {
  std::int32_t branch;
  std::int64_t step;
  double time;  ///< s
  Event event;
};

/// Those of `all` on a way (History::way_to). Of a start that branches share, those of the newest that has
/// any.
std::vector<RecordedEvent> events_on(const std::vector<Stretch>& way, const std::vector<RecordedEvent>& all);

/// What a recording takes of one step of a run.
struct Observation {
  std::vector<FrameRow> frames;
  std::optional<Checkpoint> checkpoint;
  std::vector<RecordedEvent> events;

  bool empty() const { return frames.empty() && !checkpoint && events.empty(); }
};

/// Of a body, relative to the floor, J: BodyNumbers::energy less strain and gravity energy. Its error is that
/// of the row's single-precision positions: 1e-7 of them times the body's weight.
double kinetic_energy(const Model& model, const Vec3& gravity, const FrameRow& row, int body);

/// The newest state of `run` as a row of branch 0; the same at `time` within its newest step.
FrameRow frame_row(const Run& run);
FrameRow frame_row(const Run& run, double time);
/// `time` is not reached yet, but for rounding.
bool is_ahead(const Run& run, double time);
/// Of an instant that is due at `time`, which is not ahead: as either of these.
FrameRow frame_row_due(const Run& run, double time);

/// Decides which instants of one branch of a run are recorded.
class Observer {
 public:
  explicit Observer(std::int32_t branch = 0) : branch_(branch) {}
  /// Call after each accepted step and once before the first, with the edits that are made at the start: rows
  /// at multiples of the output interval, within the step if need be, new events, a checkpoint once per
  /// simulated second. The first call always gives a row and a checkpoint, so that a branch begins with its
  /// own; events that `run` has seen by then are its parent's.
  Observation observe(const Run& run);
  /// Row and checkpoint of the newest state, where observe() has not given them: when a run ends or a branch
  /// is left.
  Observation last(const Run& run);

 private:
  void add_frame(FrameRow row, Observation& out);
  void add_checkpoint(const Run& run, Observation& out);
  void add_events(const Run& run, Observation& out);

  std::int32_t branch_;
  bool begun_ = false;
  std::size_t events_seen_ = 0;
  std::int64_t last_frame_ = -1, last_checkpoint_ = -1;  ///< steps; -1: none
  double next_checkpoint_ = -std::numeric_limits<double>::infinity(),
         next_frame_ = 0;  ///< due then; in intervals
};

}  // namespace topple::io
