#include "solver/study/common/spread.h"

#include <algorithm>
#include <cmath>

#include "solver/run/ways.h"
#include "solver/study/common/parallel.h"

namespace topple::study {

Interval wilson(int hits, int trials) {
  constexpr double z = k_95;
  const double n = trials, p = hits / n;
  const double middle = p + z * z / (2 * n);
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  const double scale = 1 + z * z / n;
  return {std::max((middle - half) / scale, 0.), std::min((middle + half) / scale, 1.)};
}

std::vector<Shake> shaken_by(std::vector<Shake> shakes, double factor) {
  for (Shake& shake : shakes) {
    shake.amplitude *= factor;
    shake.scale *= factor;
  }
  return shakes;
}

Setup shaken_by(const Setup& setup, double factor) {
  Setup changed = setup;
  changed.parameters.shakes = shaken_by(setup.parameters.shakes, factor);
  return changed;
}

std::vector<double> even_factors(int count, double spread) {
  std::vector<double> factors;
  factors.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) factors.push_back(1 + spread * (2. * k - (count - 1)) / (count - 1));
  return factors;
}

std::vector<Trial> try_factors(const Setup& setup, const std::vector<double>& factors, int jobs,
                               const std::function<bool(int done)>& go_on) {
  std::vector<Trial> trials(factors.size());
  for_each_case(
      static_cast<int>(factors.size()), jobs,
      [&](int k, int) {
        Trial& trial = trials[static_cast<std::size_t>(k)];
        trial.factor = factors[static_cast<std::size_t>(k)];
        const Setup changed = shaken_by(setup, trial.factor);
        Run run(changed);
        while (run.status().ok() && !run.over())
          if (!run.advance().ok()) break;
        trial.finished = run.status().ok();
        for (int b = 0; b < setup.model.furniture_total(); ++b)
          trial.overturned.push_back(
              run.outcome().bodies()[static_cast<std::size_t>(b)].beyond_since.has_value());
        trial.open = open_ways(run);
        for (const AnchorOutcome& anchor : run.outcome().anchors())
          trial.broke.push_back(anchor.broke.has_value());
      },
      go_on);
  return trials;
}

}  // namespace topple::study
