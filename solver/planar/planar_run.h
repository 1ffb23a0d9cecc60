// A run of a planar block on a floor that shakes, and what became of it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "solver/planar/planar_case.h"

namespace topple::planar {

/// The case must outlive the run.
class PlanarRun {
 public:
  /// duration: s.
  PlanarRun(const PlanarCase& of, std::vector<Shake> shakes, double duration);
  PlanarRun(const PlanarRun&) = delete;
  PlanarRun& operator=(const PlanarRun&) = delete;

  /// One step, at the end of which the floor's velocity jumps where a shake begins with that. Must not be
  /// called when over().
  Event advance();
  /// Time is up, the block has overturned or got stuck, or something else may be within reach.
  bool over() const;

  /// advance() in two: begin() is false where the step has ended at once, else leg() is to be finished (alone
  /// or in a lane) and handed to end().
  bool begin();
  Leg& leg() { return step_.leg; }
  template <class P>
  void end(const PackStep<P>& step, int lane, const State& after, Event event);

  bool stuck() const { return last_ == Event::stalled; }
  bool left() const { return left_; }  ///< came within reach of something else: not known what it does

  const State& state() const { return state_; }
  const Step& step() const { return step_; }  ///< the newest of those taken alone
  /// s: it has turned by k_uplift_angle (as BodyOutcome::first_uplift counts).
  std::optional<double> lifted() const { return lifted_; }
  /// m, greatest travel of the middle of the base at ends of steps, up to the critical angle (as
  /// BodyOutcome::peak_slide).
  double peak_slide() const { return peak_slide_; }
  /// s: the tilt has been beyond the critical angle since (as BodyOutcome::beyond_since).
  std::optional<double> beyond_since() const { return beyond_since_; }

 private:
  double next_jump() const;
  template <class P>
  void observe(const PackStep<P>& step, int lane);
  double middle(double centre) const;

  const PlanarCase& case_;
  std::vector<Shake> shakes_;
  ShakenPlane plane_;
  double duration_;
  std::array<double, 2> critical_;  ///< rad, towards the left and the right
  State state_;
  Step step_;
  double jump_ = k_never;  ///< s, the next of the floor's velocity
  Event last_ = Event::none;
  bool left_ = false;
  double middle_at_start_ = 0, peak_slide_ = 0;
  std::optional<double> lifted_, beyond_since_;
};

}  // namespace topple::planar
