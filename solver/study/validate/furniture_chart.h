// The chart of the comparison with furniture values.
#pragma once

#include <string>

#include "solver/study/common/chart.h"
#include "solver/study/validate/furniture_study.h"

namespace topple::study {

/// gnuplot script: the acceleration that half overturn at over the floor's frequency, beside the formula, and
/// what friction does to it. `origin`: as of fragility_chart().
std::string furniture_chart(const std::vector<FurnitureValue>& values,
                            const std::vector<FurnitureCurve>& curves, const std::string& origin,
                            ChartFormat format);

}  // namespace topple::study
