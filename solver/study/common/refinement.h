// How far a run is from itself at finer steps: the error of its time stepping.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "solver/run/run.h"

namespace topple::study {

/// The tolerance is divided by this, a fixed step and the explicit substeps of rigid and elastic bodies
/// (reduced_body.h) by k_finer_step.
inline constexpr double k_finer_tolerance = 10;
inline constexpr double k_finer_step = 2;

/// Error over the difference between the two runs. At half the step a method of order p leaves 2^p/(2^p - 1)
/// of the difference: 2 at first order, to which contacts that open and close bring any method; 4/3 at
/// second. At a hundredth of the tolerance it is 1.01 where errors go with the tolerance, 1.1 with its root.
inline constexpr double k_error_of_difference = 2;

/// Stated errors are not below these. A difference that small says nothing: errors of opposite signs meet in
/// it by chance; stick springs under a cabinet give way by a tenth of a millimetre.
inline constexpr double k_least_time_error = 1e-5;    ///< s
inline constexpr double k_least_tilt_error = 1e-5;    ///< rad
inline constexpr double k_least_slide_error = 1e-4;   ///< m
inline constexpr double k_least_stress_error = 5e-4;  ///< of the stress
inline constexpr double k_least_force_error = 5e-4;   ///< of the force

/// Fixed steps in a bounce from which on they resolve the blows of a frame.
inline constexpr double k_steps_of_bounce = 20;

/// The same run at half the step and a tenth of the tolerance; implicit substeps of rigid bodies follow the
/// tolerance at fixed steps too. Not for statics.
Setup refined(const Setup& setup);
/// The run from which the error of `setup`'s is found: refined once, where steps adapt twice, since those at
/// a tenth of the tolerance are at times no shorter.
Setup compared(const Setup& setup);
/// Whether steps follow the tolerance.
bool is_by_tolerance(const Parameters& parameters);

/// Stated errors of one body: k_error_of_difference times the difference; of the time of a fall more where it
/// comes later at finer steps, since what nearly balances takes ever longer. Absent: the quantity does not
/// exist in one of the runs, or they are on different courses, where small differences decide, or the
/// greatest tilt is the one from which the body was let go. Of what fell,
/// and of a frame that lands in fixed steps longer than its bounce over k_steps_of_bounce (contact_period),
/// the stress is that of a blow, whose error follows no order.
struct BodyError {
  bool overturned = false, overturned_refined = false;
  int impacts = 0, impacts_refined = 0;     ///< before it overturned, or in all
  std::optional<double> overturn_time;      ///< s, of the run
  std::optional<double> overturn_refined;   ///< s, of the finer one
  std::optional<double> overturn_error;     ///< s
  std::optional<double> peak_tilt_error;    ///< rad
  std::optional<double> peak_slide_error;   ///< m
  std::optional<double> peak_stress_error;  ///< Pa

  bool same_verdict() const { return overturned == overturned_refined; }
  /// The same verdict, and a fall after as many impacts or at nearly the same time: a light body that
  /// chatters meets the floor three times instead of once within milliseconds.
  bool same_course() const {
    constexpr double k_chatter = 0.02;  // s
    return same_verdict() && (!overturned || impacts == impacts_refined ||
                              std::abs(*overturn_time - *overturn_refined) < k_chatter);
  }
  /// It stands in both runs, but meets the floor so much more often in one of them that the stated errors of
  /// its peaks tell little.
  bool parted() const {
    constexpr double k_few = 0.1;
    return !overturned && !overturned_refined &&
           std::abs(impacts - impacts_refined) > k_few * std::max(impacts, impacts_refined);
  }
};

/// One of each body of `run` that is furniture. Both are outcomes of `setup`, but for their steps.
std::vector<BodyError> errors(const Setup& setup, const Outcome& run, const Outcome& finer);

/// N, stated errors of the greatest forces of the anchors. Absent: it was never in place, or broke in one of
/// the runs alone, or a body that it is attached to overturned, whose landing follows no order, or did not
/// bend as it was computed, which decides more than the steps do.
std::vector<std::optional<double>> anchor_errors(const Setup& setup, const Outcome& run,
                                                 const Outcome& finer);

}  // namespace topple::study
