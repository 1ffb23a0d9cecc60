#include "app/panels/accuracy.h"

#include <algorithm>
#include <cmath>

#include "app/panels/teaching_words.h"
#include "app/support/terms.h"

namespace topple::app {
namespace {

// Of all the work, the run at the scene's own steps: the other one makes twice as many or more.
constexpr double k_first_share = 1. / 3;

void work(const Setup& setup, Accuracy& background) {
  AccuracyResult found;
  const auto outcome_of = [&](const Setup& of, double from, double share) {
    Run run(of);
    while (!background.stopped() && run.status().ok() && !run.over()) {
      if (!run.advance().ok()) break;
      background.report_progress(from + share * run.time() / of.run.duration);
    }
    if (!run.status().ok()) found.failure = run.status().message(of.model);
    return run.outcome();
  };
  try {
    const Outcome outcome = outcome_of(setup, 0, k_first_share);
    found.bodies = outcome.bodies();
    if (found.failure.empty() && !background.stopped()) {
      const Outcome finer = outcome_of(study::compared(setup), k_first_share, 1 - k_first_share);
      if (found.failure.empty() && !background.stopped()) found.errors = study::errors(setup, outcome, finer);
    }
  } catch (const std::exception& error) {
    found.failure = error.what();
  }
  if (!background.stopped()) background.show(std::move(found));
}

/// To whole `unit`s, at least one: an error is not shown as none.
double rounded_up(double error, double unit) {
  return std::max(1., std::ceil(error / unit)) * unit;
}

}  // namespace

std::unique_ptr<Accuracy> estimate_accuracy(const Setup& setup) {
  return std::make_unique<Accuracy>([setup](Accuracy& background) { work(setup, background); });
}

std::vector<std::string> accuracy_in_words(const Model& model, const AccuracyResult& result) {
  using namespace window_words;
  if (!result.failure.empty()) return {say(k_estimate_failed, result.failure)};
  std::vector<std::string> lines;
  for (std::size_t b = 0; b < result.errors.size(); ++b) {
    const study::BodyError& error = result.errors[b];
    const std::string& name = model.bodies[b].name;
    if (!error.same_course())
      lines.push_back(say(k_unsure, name));
    else if (error.overturned)
      lines.push_back(say(k_sure_fall, name, error.overturn_time.value_or(0),
                          rounded_up(error.overturn_error.value_or(0), 1e-3)));
    else if (error.parted())
      lines.push_back(say(k_other_course, name, result.bodies[b].peak_tilt * k_degrees, error.impacts,
                          error.impacts_refined));
    else
      lines.push_back(say(k_sure_stay, name, result.bodies[b].peak_tilt * k_degrees,
                          rounded_up(error.peak_tilt_error.value_or(0) * k_degrees, 0.01)));
  }
  return lines;
}

}  // namespace topple::app
