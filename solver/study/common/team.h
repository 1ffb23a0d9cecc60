// Threads for short work that comes again and again, such as the islands of a step.
#pragma once

#include <memory>

#include "solver/step/parallel_for.h"

namespace topple::study {

/// Threads that wait for tasks: 0.1 ms by spinning, then asleep. A call of share().run allocates no memory.
class Team {
 public:
  /// `workers` >= 1 with the thread that calls.
  explicit Team(int workers);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// To be used no longer than the team lives; one call at a time.
  ParallelFor share();

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace topple::study
