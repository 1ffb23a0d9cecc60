// What a recording holds of a run, and which of its instants are recorded.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "solver/io/recording/frame_row.h"
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

/// What a recording takes of one instant of a run.
struct Observation {
  std::optional<FrameRow> frame;
  std::optional<Checkpoint> checkpoint;
  std::vector<RecordedEvent> events;

  bool empty() const { return !frame && !checkpoint && events.empty(); }
};

/// Of a body, relative to the floor, J: BodyNumbers::energy less strain and gravity energy. Its error is that
/// of the row's single-precision positions: 1e-7 of them times the body's weight.
double kinetic_energy(const Model& model, const Vec3& gravity, const FrameRow& row, int body);

/// The newest state of `run` as a row of branch 0.
FrameRow frame_row(const Run& run);

/// Decides which instants of one branch of a run are recorded.
class Observer {
 public:
  explicit Observer(std::int32_t branch = 0) : branch_(branch) {}
  /// Call after each accepted step and once before the first: rows at the scene's output rate, new events, a
  /// checkpoint once per simulated second. The first call always gives a row and a checkpoint, so that a
  /// branch begins with its own; events that `run` has seen by then are its parent's.
  Observation observe(const Run& run);
  /// Row and checkpoint of the newest state, where observe() has not given them: when a run ends or a branch
  /// is left.
  Observation last(const Run& run);

 private:
  void add_frame(const Run& run, Observation& out);
  void add_checkpoint(const Run& run, Observation& out);
  void add_events(const Run& run, Observation& out);

  std::int32_t branch_;
  bool begun_ = false;
  std::size_t events_seen_ = 0;
  std::int64_t last_frame_ = -1, last_checkpoint_ = -1;  ///< steps; -1: none
  double next_frame_ = -std::numeric_limits<double>::infinity(),
         next_checkpoint_ = next_frame_;  ///< due then; in intervals
};

}  // namespace topple::io
