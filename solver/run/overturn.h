// Who falls: tilt, critical angle, uplift, impacts, overturning.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solver/body/body_pose.h"
#include "solver/model/model.h"
#include "solver/run/bearer.h"
#include "solver/state/state.h"
#include "solver/state/step_result.h"

namespace topple {

/// Share of the body's weight. A side has let go when it carries less than k_uplift, with what stands on the
/// floor between it and the opposite side, while the floor carries more than k_closing; it has closed again
/// when it carries more than k_closing itself. A wall that holds it up by friction counts as floor. Two
/// thresholds, or a resting side would chatter. On a floor that gives way an outer row of points sheds its
/// load before a body whose inner rows bear begins to rock.
inline constexpr double k_uplift = 1e-3;
inline constexpr double k_closing = 1e-2;

/// Impacts of a body of which time and the peak that follows are kept.
inline constexpr std::size_t k_kept_impacts = 100;

/// A body with all that stands on it.
struct Stack {
  double mass;             ///< kg, of all
  Vec3 centre_of_gravity;  ///< m, of all, in the reference axes of the body
};
/// Sets `stacks`, one for each of `poses`, which are those of the bodies now, in their order. A piece counts
/// that stood on the body at the start, or on such a piece, while it is still there: its centre of gravity
/// above the base of what bore it, and its own base as high on that as it was, within a quarter of its reach.
/// bearers: bearers_of.
void find_stacks(const Model& model, std::span<const Bearer> bearers, std::span<const BodyPose> poses,
                 std::vector<Stack>& stacks);

/// Tilt at which the centre of gravity of the stack is above the support polygon's edge in the direction of
/// the tilt, or of a body that tilts less than k_uplift_angle above the nearest edge, rad:
/// atan(distance/height). Infinite without a floor, and for a body without a base or with supports there.
double critical_angle(const Model& model, int body, const BodyPose& pose, const Stack& stack);

/// Energy that lifts the centre of gravity of a rigid body, and of what it bears, over an edge, J; both
/// infinite where critical_angle is.
///   m g R (1 - cos(critical - tilt)),  R from the edge to the centre of gravity; 0 beyond the critical angle
struct OverturnBarrier {
  double left;   ///< over the edge in the direction of the tilt, from this tilt on; upright the nearest
  double whole;  ///< from upright, over the same edge
};
/// gravity: m/s^2.
OverturnBarrier overturn_barrier(const Model& model, int body, const BodyPose& pose, const Stack& stack,
                                 double gravity);

/// Travel of the middle of the base along what bears the body since the start, in its axes, m; along the
/// floor since the reference pose. `on`: bearer_pose now.
double slide(const Model& model, int body, const BodyPose& pose, const Bearer& bearer, const BodyPose& on);

/// Something that happened to a body, at the end of a step.
struct Event {
  /// Recordings hold these numbers.
  enum class Kind { uplift = 0, impact = 1, overturn = 2, hinge = 3, fracture = 4, model = 5, anchor = 6 };
  Kind kind;
  std::int64_t step;
  double time;  ///< s
  int body;
  double value;  ///< uplift, impact: index of the side; overturn: tilt, rad; hinge: Hinge; model: ModelLevel;
                 ///< anchor: tension at which it broke, N
  int element = -1;                         ///< hinge, fracture: index into Model::elements
  LevelReason reason = LevelReason::asked;  ///< model: why the body changed, or began there
  int anchor = 0;                           ///< anchor: index into Model::anchors
};

/// A body began on a level, or came there.
struct LevelChange {
  double time;  ///< s
  ModelLevel level;
  LevelReason reason;
  double error_estimate;  ///< greatest BodyState::error_estimate on it so far
};

/// What happened to one body so far. Times in s, angles in rad, lengths in m.
struct BodyOutcome {
  double tilt = 0, peak_tilt = 0;
  double slide = 0, peak_slide = 0;
  double critical = 0;  ///< critical angle in the present direction
  /// Greatest tilt over critical angle, and the critical angle then.
  struct Nearest {
    double share = 0, critical = 0;
  };
  Nearest peak;                        ///< so far; of what overturned that of the moment when it did
  Nearest beyond;                      ///< so far, while it is beyond the critical angle: it may come back
  std::optional<double> beyond_since;  ///< the tilt has been beyond the critical angle since: overturned
  std::optional<double> first_beyond;  ///< it came there first, whether it came back or not
  std::optional<double> first_uplift;
  int impacts = 0;
  std::optional<double> first_impact;
  double rebound_tilt = 0;           ///< greatest tilt since the first impact
  std::vector<double> impact_times;  ///< of the first k_kept_impacts
  std::vector<double>
      peak_tilts;            ///< greatest tilt before the first of these, then after each up to the next
  double peak_stress = 0;    ///< Pa, while it was not rigid
  bool always_rigid = true;  ///< nothing is known of its stresses
  /// Greatest sqrt(f + 1) (plasticity.h) at the ends of elements; absent: nothing can yield.
  std::optional<double> peak_yield_ratio;
  int hinges = 0;               ///< nodes at which hinges formed so far, whether they still flow or not
  int fractures = 0;            ///< elements that broke
  double peak_penetration = 0;  ///< greatest 1 - l/L at planes
  double peak_pinch = 0;        ///< likewise between members, where 1 would be one through the other
  std::optional<double> over_60_since;     ///< tilt over 60 degrees without a break since
  std::optional<ModelLevel> level;         ///< at this observation
  std::vector<LevelChange> level_changes;  ///< the first one where BodyModelTraits::lists_start; at most
                                           ///< k_kept_impacts
  struct Side {
    bool open = false;             ///< it has let go and not closed again
    bool counts = false;           ///< the body has turned by k_uplift_angle since
    bool borne_otherwise = false;  ///< from the first state on, as by a pole: it has not let go
    double since = 0;              ///< s, when it let go
    Vec3 vertical = Vec3::Zero();  ///< then, in the body's axes
  };
  std::vector<Side> sides;        ///< of the support polygon
  Vec3 vertical = Vec3::UnitZ();  ///< of what bears it, at this observation, in the body's axes
  double time = 0;                ///< of this observation
};

/// What happened to one anchor so far.
struct AnchorOutcome {
  double tension = 0;              ///< N, at this observation; negative: pushes
  double peak_force = 0;           ///< N, of |tension|, that at which it broke included
  std::optional<double> broke;     ///< s, when it broke last
  std::optional<AnchorHold> hold;  ///< at this observation
};

/// Follows a run step by step.
class Outcome {
 public:
  /// starts: as of start_state.
  Outcome(const Model& model, const std::vector<BodyStart>& starts);
  /// Takes in one accepted step. `forces`, `between`: contact forces of that state. Appends to `events`.
  void observe(const Model& model, const Parameters& parameters, const State& state,
               const std::vector<ContactForce>& forces, const std::vector<MemberForce>& between,
               std::vector<Event>& events);
  /// Takes in the stresses of a body and returns the greatest, Pa; also at times within the step that is
  /// observed next: they may be greater there than at its ends, and no recorded row is to hold more than the
  /// peaks.
  double observe_stresses(const Model& model, int body, const std::vector<SectionForces>& sections);
  /// Takes in the greatest tilts and slides within the step from the last observation to `end`; `within`
  /// gives the state at a time there.
  void observe_peaks(const Model& model, const State& end,
                     const std::function<const State&(double time)>& within);
  const std::vector<BodyOutcome>& bodies() const { return bodies_; }
  const std::vector<AnchorOutcome>& anchors() const { return anchors_; }
  const std::vector<Bearer>& bearers() const { return bearers_; }  ///< per body
  bool all_overturned(double time) const;  ///< tilt of every body over 60 degrees for 0.5 s

 private:
  /// Adds a force, N, at a place on a part (each_share) to what the sides of its body's base carry.
  void carry(const Model& model, int part, double t, double u, const Vec3& force);
  /// Which points of the base of the newest body lie on a side, and before it.
  void list_points(const Model& model, const Body& body, int side);
  void observe_forces(const Model& model, const std::vector<ContactForce>& forces,
                      const std::vector<MemberForce>& between);
  /// Of body b.
  void observe_level(const Parameters& parameters, const State& state, std::size_t b,
                     std::vector<Event>& events);
  void observe_pose(const Model& model, const State& state, std::size_t b, std::vector<Event>& events);
  void take_pose(const Model& model, std::size_t b);  ///< of poses_
  struct Varying {
    double value, rate;  ///< rate: per second
  };
  /// -cos(tilt), and slide, m. NaN: not known between steps, of a frame, or not at all, of a slide on a
  /// piece.
  std::array<Varying, 2> tilt_and_slide(const Model& model, const State& state, std::size_t b) const;
  /// Sets poses_ and stacks_.
  void find_poses(const Model& model, const State& state);
  void observe_sides(const Model& model, const State& state, double weight, std::size_t b,
                     std::vector<Event>& events);
  /// goes_on: this is the first observation of a run that goes on from a checkpoint.
  void observe_hinges(const Model& model, const State& state, bool goes_on, std::vector<Event>& events);
  void observe_anchors(const Model& model, const State& state, std::vector<Event>& events);

  std::vector<BodyOutcome> bodies_;
  std::vector<AnchorOutcome> anchors_;
  std::vector<Bearer> bearers_;
  std::vector<std::array<Varying, 2>> tilts_and_slides_;  ///< per body, at this observation
  bool ends_known_ = false;                               ///< those at the next one, by observe_peaks()
  std::vector<BodyPose> poses_;                           ///< likewise, of furniture, or at a peak
  std::vector<Stack> stacks_;                             ///< likewise
  std::vector<char> broke_;                               ///< per element
  std::vector<char> flowed_;                              ///< per node: a section beside it has flowed
  int furniture_;                                         ///< bodies
  std::vector<Eigen::Vector4d> unit_stress_;              ///< per section: Pa by N, Mx, My and Mz of one
  /// Per body, per side: N, on it (of what touches bodies on the half next to it), and on to the opposite.
  std::vector<std::vector<double>> side_force_, inner_force_;
  std::vector<std::vector<double>> depth_;  ///< per body, per side: m, from it to what is farthest from it
  std::vector<char> reaches_base_;   ///< per element, then per panel: a node of it is of its body's base
  std::vector<double> total_force_;  ///< per body, N
  /// Per body: contact point (from 0) to the sides that it lies on, and to those before which it lies.
  std::vector<std::vector<std::vector<int>>> side_of_, inner_of_;
};

}  // namespace topple
