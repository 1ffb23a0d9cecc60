// How far a scene's run is from itself at finer steps, computed beside the window.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/support/background.h"
#include "solver/study/common/refinement.h"

namespace topple::app {

/// What became of the bodies, and how far that can be trusted.
struct AccuracyResult {
  std::string failure;              ///< why there is none; empty: there is
  std::vector<BodyOutcome> bodies;  ///< at the scene's own steps
  std::vector<study::BodyError> errors;
};

/// Runs a setup as it is and refined.
using Accuracy = Background<AccuracyResult>;
std::unique_ptr<Accuracy> estimate_accuracy(const Setup& setup);

/// One line for each of the furniture, in the language of the window.
std::vector<std::string> accuracy_in_words(const Model& model, const AccuracyResult& result);

}  // namespace topple::app
