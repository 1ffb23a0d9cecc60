// Motion of a block from event to event by Taylor series of high order: exact but for rounding and what the
// tolerance leaves. Between events a step is a polynomial, which is the dense output, and in which the guards
// of the mode find the next event (Falls: none is missed). Allocates nothing.
#pragma once

#include "solver/planar/floor.h"
#include "solver/planar/mode.h"

namespace topple::planar {

struct Controls {
  double tolerance = 1e-11;  ///< last terms of the accelerations, over gravity; 0: all steps as the longest
  double longest = 10;       ///< s, step
  int order = k_order;       ///< highest power in the accelerations, 2..k_order
  double last_tilt =
      1.5707;  ///< rad, at which the block has overturned; up to where its walls meet the floor
};

/// What a step begins with.
struct Leg {
  const Block* block;
  const Controls* controls;
  State start;                          ///< its mode decided
  double end, floor_end;                ///< s, of the step at most, and of the series of the floor
  Series<double> horizontal, vertical;  ///< of the floor, m/s^2; the latter with gravity
  int without_progress = 0;             ///< events in a row that came at once
  Turned known, known_at_start;         ///< of the start's tilt; the first from finish() on of the end's

  Situation situation() const {  ///< at the start
    return {*block, horizontal[0], vertical[0], horizontal.or_zero(1), known};
  }
};
/// To `until`. False: `start` rests until `end`, several lines of a record that cannot wake it at once.
/// Block and controls must outlive the leg.
bool begin(const Block& block, const Floor& floor, const Controls& controls, double until, const State& state,
           Leg& leg);
/// At the end of a leg in which nothing wakes it.
State rested(const Leg& leg);

/// A step of the blocks in the lanes of a pack, all in the same mode, each with its own clock and length.
template <class P>
struct PackStep {
  PerLane<P, State> start;
  P length{0};  ///< s
  Solution<P> solution;
  Guards<P> guards;
};
/// Ends the first `count` legs; the other lanes repeat one of them. `after` and the events returned: as of
/// advance(). The bits of a lane do not depend on the others. P: double or Four.
template <class P>
PerLane<P, Event> finish(const PerLane<P, Leg*>& legs, int count, PackStep<P>& step,
                         PerLane<P, State>& after);

/// The newest step of one block. In one at rest that passed several lines of a record at once the
/// solution's `horizontal` and `vertical` are those of the first.
struct Step : PackStep<double> {
  Leg leg;
};

/// One step: to `until`, an event, a kink of the floor or the end of what the series hold. `state` is the
/// motion after the event. Returns the event, `none` without one. After `overturn` and `stalled` a run ends.
Event advance(const Block& block, const Floor& floor, const Controls& controls, double until, State& state,
              Step& step);

/// The motion at a time within the newest step, before the event that ended it.
State state_within(const Step& step, double time);

}  // namespace topple::planar
