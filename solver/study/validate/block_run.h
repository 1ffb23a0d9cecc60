// A planar block alone under one record: whether it overturns.
#pragma once

#include <memory>

#include "solver/model/accelerogram.h"
#include "solver/planar/block.h"

namespace topple::study {

/// What is as rough as that does not slip.
inline constexpr double k_rough = 10;

/// Whether a block that stands overturns under a record along +x, all accelerations times `factor`, until
/// `after` seconds behind it. What jams without end counts as standing.
bool overturns(const planar::Block& block, const std::shared_ptr<const Accelerogram>& record, double factor,
               double after);

}  // namespace topple::study
