// Many runs of planar blocks at once, in the lanes of packs.
#pragma once

#include <functional>
#include <memory>

#include "solver/planar/planar_run.h"

namespace topple::planar {

struct LaneUse {
  long busy = 0;   ///< steps of runs
  long lanes = 0;  ///< of the steps of packs
  double share() const { return lanes > 0 ? static_cast<double>(busy) / static_cast<double>(lanes) : 1; }
};

/// Takes the runs make(0), make(1), ..., make(count - 1) (null: none) to their ends, which are told to
/// `ended`. Some are on their way at once, each with its own clock and mode: up to four in the same mode take
/// a step in one pack, one that is over makes room for the next. Each has the bits that it has alone. Stops
/// when give_up(), asked after each step of a pack, is true.
LaneUse run_in_lanes(int count, const std::function<std::unique_ptr<PlanarRun>(int)>& make,
                     const std::function<void(int, const PlanarRun&)>& ended,
                     const std::function<bool()>& give_up);

}  // namespace topple::planar
