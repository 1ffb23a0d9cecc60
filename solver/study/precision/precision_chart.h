// The precision study as one sheet.
#pragma once

#include <string>

#include "solver/study/common/chart.h"
#include "solver/study/precision/precision.h"

namespace topple::study {

/// Script for gnuplot: the four errors against CPU time, the tilt's error against the step, fronts of the
/// other laws, and the cheapest settings. `origin`: version and machine.
std::string precision_chart(const PrecisionPlan& plan, const PrecisionStudy& study, const std::string& origin,
                            ChartFormat format);

}  // namespace topple::study
