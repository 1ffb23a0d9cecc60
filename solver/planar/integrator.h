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

/// The newest step. A block at rest passes as many lines of a record at once as cannot wake it; the
/// solution's `horizontal` and `vertical` are then those of the first.
struct Step {
  State start;
  double length = 0;  ///< s
  Solution<double> solution;
  double floor_end = 0;  ///< s, of the series of the floor
  Guards guards;
  int without_progress = 0;  ///< events in a row that came at once
};

/// One step: to `until`, an event, a kink of the floor or the end of what the series hold. `state` is the
/// motion after the event. Returns the event, `none` without one. After `overturn` and `stalled` a run ends.
Event advance(const Block& block, const Floor& floor, const Controls& controls, double until, State& state,
              Step& step);

/// The motion at a time within the newest step, before the event that ended it.
State state_within(const Step& step, double time);

}  // namespace topple::planar
