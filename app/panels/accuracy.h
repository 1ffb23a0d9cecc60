// Discretisation error of a scene's run, by a second run at finer steps, on a thread beside the window.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/support/background.h"
#include "solver/study/common/refinement.h"

namespace topple::app {

/// Outcome of each body, and the estimate of its error.
struct AccuracyResult {
  std::string failure;              ///< why there is no result; empty: there is one
  std::vector<BodyOutcome> bodies;  ///< at the scene's own steps
  std::vector<study::BodyError> errors;
};

/// Runs a setup as it is and refined.
using Accuracy = Background<AccuracyResult>;
std::unique_ptr<Accuracy> estimate_accuracy(const Setup& setup);

/// One line for each of the furniture, in the language of the window.
std::vector<std::string> accuracy_in_words(const Model& model, const AccuracyResult& result);

}  // namespace topple::app
