// The stability study as a chart.
#pragma once

#include <string>
#include <vector>

#include "solver/study/common/chart.h"
#include "solver/study/stability/stability.h"
#include "solver/study/stability/stability_limits.h"

namespace topple::study {

/// A map for each method with the limits of theory over it, and how often each fate was met. `origin`:
/// version and machine.
std::string stability_chart(const StabilityPlan& plan, const StabilityMap& map,
                            const std::vector<StabilityLimit>& limits, const std::string& origin,
                            ChartFormat format);

}  // namespace topple::study
