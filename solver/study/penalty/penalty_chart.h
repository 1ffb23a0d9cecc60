// The chart of the penalty study.
#pragma once

#include <string>

#include "solver/study/common/chart.h"
#include "solver/study/penalty/penalty_advice.h"

namespace topple::study {

/// gnuplot script with six panels: force against l/L, depth at rest, creep, restitution, contact frequency
/// and the errors against rigid contact; above them what alpha is recommended. `origin`: what the results
/// come from, program and machine, in a line of its own.
std::string penalty_chart(const PenaltyStudy& study, const Advice& advice, const std::string& origin,
                          ChartFormat format);

}  // namespace topple::study
