// The chart of the overturning map.
#pragma once

#include <string>

#include "solver/study/common/chart.h"
#include "solver/study/overturn/overturn_map.h"

namespace topple::study {

/// gnuplot script: the map of verdicts, or of an ensemble the probability and beside it the fragility curve
/// at the scene's own place; criteria over it, labelled where they end. `origin`: what the results come from,
/// program and machine, in a line of its own.
std::string overturn_chart(const OverturnPlan& plan, const OverturnMap& map, const std::string& origin,
                           ChartFormat format);

}  // namespace topple::study
