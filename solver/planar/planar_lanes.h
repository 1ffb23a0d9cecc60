// Many runs of planar blocks, in the lanes of packs.
#pragma once

#include <functional>
#include <memory>

#include "solver/planar/planar_run.h"

namespace topple::planar {

struct LaneUse {
  long busy = 0;   ///< steps of runs
  long lanes = 0;  ///< of the packs that took them
  double share() const { return lanes > 0 ? static_cast<double>(busy) / static_cast<double>(lanes) : 1; }
};

using MakeRun = std::function<std::unique_ptr<PlanarRun>(int)>;
using RunEnded = std::function<void(int, const PlanarRun&)>;

/// Takes the runs make(0), ..., make(count - 1) (null: left out) to their ends, which `ended` is told. Some
/// are on their way at once, each with its own clock and mode: up to four in the same mode take their steps
/// in one pack, and one that is over makes room for the next. Each has the bits that it has alone. Stops when
/// give_up(), asked after each step of a pack, is true. Processors without AVX2 run them one by one.
LaneUse run_in_lanes(int count, const MakeRun& make, const RunEnded& ended,
                     const std::function<bool()>& give_up);

}  // namespace topple::planar
