// The chart of the comparison with shake-table tests.
#pragma once

#include <string>

#include "solver/study/common/chart.h"
#include "solver/study/validate/granite_study.h"

namespace topple::study {

/// gnuplot script: a column per rock, with shares right beside baselines, fragility measured and computed,
/// and the reliability of probabilities. `origin`: as of fragility_chart().
std::string granite_chart(const std::vector<GraniteTest>& tests, const GraniteFit& fit,
                          const GraniteResults& results, const std::string& origin, ChartFormat format);

}  // namespace topple::study
