#include "solver/study/common/refinement.h"

#include <algorithm>
#include <cmath>

#include "solver/math/ranges.h"

namespace topple::study {
namespace {

double error(double coarse, double fine, double least) {
  return std::max(k_error_of_difference * std::abs(coarse - fine), least);
}

/// Before it overturned; 0 of what did not.
int impacts_before(const BodyOutcome& body) {
  return body.beyond_since ? static_cast<int>(ranges::count_if(
                                 body.impact_times, [&](double t) { return t < *body.beyond_since; }))
                           : 0;
}

}  // namespace

Setup refined(const Setup& setup) {
  Setup finer = setup;
  finer.parameters.tolerance /= k_finer_tolerance;
  finer.parameters.substep_refinement *= k_finer_step;
  if (!finer.parameters.adaptive) finer.parameters.time_step /= k_finer_step;
  return finer;
}

std::vector<BodyError> errors(const Model& model, const Outcome& run, const Outcome& finer) {
  std::vector<BodyError> list;
  for (int b = 0; b < model.furniture_total(); ++b) {
    const BodyOutcome &coarse = run.bodies()[b], &fine = finer.bodies()[b];
    BodyError e;
    e.overturned = coarse.beyond_since.has_value();
    e.overturned_refined = fine.beyond_since.has_value();
    if (e.overturned && e.overturned_refined) {
      e.impacts = impacts_before(coarse);
      e.impacts_refined = impacts_before(fine);
    }
    e.overturn_time = coarse.beyond_since;
    e.overturn_refined = fine.beyond_since;
    if (e.same_verdict()) {
      if (e.overturned)
        e.overturn_error = error(*coarse.beyond_since, *fine.beyond_since, k_least_time_error);
      e.peak_tilt_error = error(coarse.peak_tilt, fine.peak_tilt, k_least_tilt_error);
      e.peak_slide_error = error(coarse.peak_slide, fine.peak_slide, k_least_slide_error);
      if (!e.overturned && !coarse.always_rigid && !fine.always_rigid)
        e.peak_stress_error =
            error(coarse.peak_stress, fine.peak_stress, k_least_stress_error * coarse.peak_stress);
    }
    list.push_back(e);
  }
  return list;
}

}  // namespace topple::study
