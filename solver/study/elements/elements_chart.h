// The chart of the element comparison.
#pragma once

#include <string>

#include "solver/study/common/chart.h"
#include "solver/study/elements/elements.h"

namespace topple::study {

/// Errors below are rounding; they are drawn here, 0 too.
inline constexpr double k_error_floor = 1e-15;

/// gnuplot script: for each charted quantity the error against elements per member, and below it against CPU
/// time, both axes logarithmic. `origin`: what the results come from, program and machine, in a line of its
/// own.
std::string elements_chart(const ElementsStudy& study, const std::string& origin, ChartFormat format);

}  // namespace topple::study
