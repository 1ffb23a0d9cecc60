// Planar blocks alone under records: which overturn.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "solver/model/accelerogram.h"
#include "solver/planar/block.h"

namespace topple::study {

/// What is as rough as that does not slip.
inline constexpr double k_rough = 10;

/// A block that stands under a record along +x, all accelerations times `factor`, until `after` seconds
/// behind it.
struct BlockRun {
  planar::Block block;
  std::shared_ptr<const Accelerogram> record;
  double factor = 1, after = 1;
};

/// Which of them overturn, in lanes (planar_lanes.h); empty: give_up() came true. What jams without end
/// counts as standing.
std::vector<bool> overturns(const std::vector<BlockRun>& runs, const std::function<bool()>& give_up);

}  // namespace topple::study
