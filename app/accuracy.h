// How far a scene's run is from itself at finer steps, computed beside the window.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "solver/study/refinement.h"

namespace topple::app {

/// What became of the bodies, and how far that can be trusted.
struct AccuracyResult {
  std::string failure;              ///< why there is none; empty: there is
  std::vector<BodyOutcome> bodies;  ///< at the scene's own steps
  std::vector<study::BodyError> errors;
};

/// Runs a setup as it is and refined, on a thread of its own.
class Accuracy {
 public:
  explicit Accuracy(const Setup& setup);
  /// Stops at the next step.
  ~Accuracy();
  Accuracy(const Accuracy&) = delete;
  Accuracy& operator=(const Accuracy&) = delete;

  double progress() const { return progress_; }  ///< 0..1
  /// Nothing while it goes on.
  std::optional<AccuracyResult> result() const;

 private:
  void work(const Setup& setup);

  std::atomic<double> progress_ = 0;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;
  std::optional<AccuracyResult> result_;
  std::thread thread_;
};

/// One line for each of the furniture, in the language of the window.
std::vector<std::string> accuracy_in_words(const Model& model, const AccuracyResult& result);

}  // namespace topple::app
