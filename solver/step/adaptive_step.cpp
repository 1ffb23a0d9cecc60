#include "solver/step/adaptive_step.h"

#include <algorithm>
#include <cmath>

#include "solver/body/step_control.h"
#include "solver/frame/integrator.h"

namespace topple {
namespace {

constexpr double k_safety = 0.9;        // of the error that is aimed at
constexpr double k_most_growth = 2;     // from step to step
constexpr double k_most_shrinking = 5;  // of a step that is tried again
constexpr int k_many_iterations = 8;    // of Newton: the step does not grow
constexpr double k_explicit_share = 0.9;
// Of the stable step of central differences without damping: a shorter step resolves all that a frame can do,
// and is as good as any where nothing moves yet that its error could be measured by. Not looked for above
// k_short_step.
constexpr double k_resolved_share = 0.01;
constexpr double k_short_step = 1e-6;  // s
// A jump of the energy, as where a contact passes from one part of a member to another, is the same in steps
// of any size: a short one that errs as one a fifth longer did takes it, up to this many times what the
// tolerance allows.
constexpr double k_jump = 10;
constexpr double k_same_error = 0.98;
constexpr double k_unexplained = 1e-6;  // J, that it may leave

// The size to try next after one of size h with this error and these iterations.
double next_size(double h, double error, int iterations) {
  double growth = error > 0 ? k_safety / std::sqrt(error) : k_most_growth;
  if (iterations > k_many_iterations) growth = std::min(growth, 1.);
  return h * std::clamp(growth, 1 / k_most_shrinking, k_most_growth);
}

// At most h, so that what is left of the way takes no step much shorter than the others.
double fit(double h, double left) {
  if (left <= h) return left;
  return left < 2 * h ? left / 2 : h;
}

}  // namespace

StepStatus adaptive_step(const Model& model, const Parameters& parameters, const State& state,
                         Workspace::Impl& w, double until, const TryStep& try_step) {
  const double share = stable_share(parameters);
  if (std::isfinite(share)) w.find_explicit_limit(parameters, state);
  // no frame, no limit: bodies bound their errors
  const double longest =
      w.explicit_limit && std::isfinite(share)
          ? k_explicit_share * share * w.explicit_limit->step / parameters.substep_refinement
          : k_longest_step;
  const auto is_resolved = [&](double h) {
    return h <= k_short_step && w.parts.moves_nodes() &&
           std::abs(w.next.energy.unexplained() - state.energy.unexplained()) < k_unexplained &&
           h <= k_resolved_share * w.find_undamped_limit(parameters, w.next);
  };
  const bool by_limit = w.explicit_limit.has_value() && traits(parameters.integrator).is_explicit;
  const double left = std::min(until, next_kink(model, parameters, state.time)) - state.time;
  double h = state.step_size > 0 ? state.step_size : k_first_step;
  h = by_limit ? longest : std::min({h, longest, w.parts.time_limit(parameters, state)});
  h = fit(h, left);
  StepStatus status;
  int iterations = 0, rejected = 0;
  double longer_errs = 0;  // of the step tried before
  for (;;) {
    status = try_step(h);
    iterations += status.newton_iterations;
    StepError error;
    if (status.ok() && !by_limit)
      error = step_error(model, parameters, state, w.next, h, w.parts.with_frames());
    // explicit substeps follow the motion: they are as short as they must be, whatever h
    const double reach = by_limit ? 0 : w.parts.explicit_reach(parameters);
    const double counts = h <= reach ? error.energy : error.greatest();
    const bool jumps =
        h <= k_short_step && counts <= k_jump && counts > k_same_error * longer_errs && longer_errs > 1;
    const bool resolved = status.ok() && counts > 1 && (jumps || is_resolved(h));
    longer_errs = status.ok() ? counts : 0;
    if (status.ok() && (counts <= 1 || resolved)) {
      if (h == left) w.next.time = state.time + left;
      // as far as the energy of explicit substeps adds up; without frames there is none
      const double by_reach = std::isfinite(reach) ? std::min(next_size(h, error.energy, 0), reach) : reach;
      const double wanted = std::min(
          std::max({next_size(h, error.greatest(), w.most_iterations), by_reach, resolved ? h : 0}), longest);
      w.next.step_size = h;
      if (!by_limit) change_step(w.next, std::min(wanted, w.parts.time_limit(parameters, w.next)));
      break;
    }
    if (status.kind == StepStatus::Kind::step_too_long) {  // a body becomes a frame
      ++rejected;
      h = k_explicit_share * status.limit / parameters.substep_refinement;
      continue;
    }
    if (by_limit || h < 2 * k_least_step) {
      if (status.ok()) {
        status.kind = StepStatus::Kind::not_accurate;
        status.time = w.next.time;
      }
      break;
    }
    ++rejected;
    double shorter = status.ok() ? next_size(h, counts, 0) : h / 2;
    if (h > reach) shorter = std::max(shorter, reach);
    h = std::max(std::min(shorter, h / 1.2), k_least_step);
  }
  status.newton_iterations = iterations;
  status.rejected = rejected;
  status.by_tolerance = !by_limit;
  return status;
}

}  // namespace topple
