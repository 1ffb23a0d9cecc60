// The chart of the comparison with tossed cubes.
#pragma once

#include <string>

#include "solver/study/common/chart.h"
#include "solver/study/validate/toss_study.h"

namespace topple::study {

/// gnuplot script: errors of position and angle over time, and how many tosses end how far off. `origin`: as
/// of fragility_chart().
std::string toss_chart(const TossFit& fit, const TossResults& results, const std::string& origin,
                       ChartFormat format);

}  // namespace topple::study
