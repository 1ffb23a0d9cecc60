// What a recording holds of a run, and which of its instants are recorded.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "solver/run.h"

namespace topple::io {

inline constexpr std::uint8_t k_flowed_first = 5, k_flowed_second = 6;  ///< of FrameRow::hinge

/// Of FrameRow::anchor. slack: in place, without force.
inline constexpr float k_anchor_away = 0, k_anchor_slack = 1, k_anchor_holds = 2, k_anchor_broken = 3;
/// "away", "slack", "holds", "broken".
const char* anchor_word(float state);

/// One recorded instant. Array shapes: n nodes, e elements, c contact points x planes, b bodies, a anchors,
/// t elements that other bodies' members can touch: e, or 0 of a single body.
struct FrameRow {
  std::int32_t branch = 0;
  std::int64_t step = 0;
  double time = 0;                    ///< s
  std::vector<float> position;        ///< n x 3, m, floor's frame
  std::vector<float> rotation;        ///< n x 4, w x y z
  std::vector<float> section_force;   ///< e x 6: N, Vy, Vz, T, My, Mz at the stress point, N and N m
  std::vector<float> s;               ///< e, integration point
  std::vector<std::uint8_t> hinge;    ///< e: 0 none, 1 at the first end, 2 at the second, 3 broken,
                                      ///< 4 in the middle; 5, 6: none now, flowed at the first, second end
  std::vector<float> contact_depth;   ///< c, 1 - l/L; 0: open
  std::vector<float> contact_force;   ///< c x 3, N
  std::vector<float> member_contact;  ///< t x 4: resultant of what members of other bodies do to the element,
                                      ///< N, and where it acts, 0..1 from the first node to the second
  std::vector<double> energy;         ///< input, kinetic, strain, gravity, contact, friction, normal damping,
                                      ///< numerical, plastic, damping, model switch, balance error; with
                                      ///< anchors also anchor, released; J, balance error -
  std::vector<double> body;        ///< b x 11: centre x y z (m), quaternion w x y z, tilt (rad), slide (m),
                                   ///< energy (J), critical angle (rad, 0: none)
  std::vector<std::uint8_t> rung;  ///< b: 0 rigid, 1 elastic, 2 frame
  double floor_acceleration[3] = {};  ///< m/s^2
  double floor_displacement[3] = {};  ///< m, high-passed
  double load_factor = 0;             ///< of static runs
  std::vector<float> anchor;  ///< a x 4: tension (N, negative: pushes), energy (J), natural length (m),
                              ///< state (k_anchor_away, ...)
};

/// No NaN, no infinity in it.
bool is_finite(const FrameRow& row);

/// A whole state, to go on from.
struct Checkpoint {
  std::int32_t branch;
  std::int64_t step;
  double time;
  std::uint64_t hash;
  std::vector<double> state;  ///< pack(State)
};

/// No NaN, no infinity in it; bits that are integers do not look like any.
bool is_finite(const Checkpoint& checkpoint);

struct RecordedEvent {
  std::int32_t branch;
  std::int64_t step;
  double time;
  Event event;
};

/// What a recording takes of one instant of a run.
struct Observation {
  std::optional<FrameRow> frame;
  std::optional<Checkpoint> checkpoint;
  std::vector<RecordedEvent> events;

  bool empty() const { return !frame && !checkpoint && events.empty(); }
};

/// Of a body, relative to the floor, J: what is left of its energy without that of strain and gravity. To the
/// rounding of the row's places, 1e-7 of the body's weight times their size.
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
  std::int64_t last_frame_ = -1, last_checkpoint_ = -1;                                           ///< steps
  double next_frame_ = -std::numeric_limits<double>::infinity(), next_checkpoint_ = next_frame_;  ///< turns
};

}  // namespace topple::io
