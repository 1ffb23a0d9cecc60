// The chart of fragility curves.
#pragma once

#include <string>

#include "solver/study/common/chart.h"
#include "solver/study/overturn/fragility_study.h"

namespace topple::study {

/// gnuplot script: a panel per body, of many the k_panels most likely to overturn and `any body`, and one of
/// the places from which the way out is closed most often: shares of runs with intervals, fitted curves,
/// criteria as lines across. `origin`: as of overturn_chart().
std::string fragility_chart(const FragilityPlan& plan, const FragilityResults& results,
                            const std::string& origin, ChartFormat format);

inline constexpr int k_panels = 4;

}  // namespace topple::study
