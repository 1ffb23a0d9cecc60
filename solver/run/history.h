// What was done to a run while it ran: branches and edits. With the setup it is all that a run follows from.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/run/edit.h"
#include "solver/run/run.h"

namespace topple {

/// A future of a run. It begins at the state and with the parameters that its parent had at `fork_step`.
struct Branch {
  std::int32_t id = 0;
  std::int32_t parent = -1;  ///< -1: the root
  std::int64_t fork_step = 0;
};

/// An edit, posted when `branch` stood at `step`; it holds from there on.
struct LoggedEdit {
  std::int32_t branch = 0;
  std::int64_t step = 0;
  double time = 0;  ///< s, of that step
  Edit edit;
};

/// A part of the way from the root to a branch: `branch` up to and including `last_step`.
struct Stretch {
  std::int32_t branch;
  std::int64_t last_step;
};

/// Edits in the order in which they were posted; a branch that has been left gets no more.
struct History {
  std::vector<Branch> branches;
  std::vector<LoggedEdit> edits = {};

  /// Root first. Throws std::invalid_argument when the branch or an ancestor of it does not exist.
  std::vector<Stretch> way_to(std::int32_t branch) const;
  /// Those that hold on the way to `branch`, in order of their steps.
  std::vector<LoggedEdit> edits_on_way_to(std::int32_t branch) const;
};

/// Parameters of `branch` at `step`, edits posted there included.
Parameters parameters_at(const Setup& setup, const History& history, std::int32_t branch, std::int64_t step);

/// Parameters with which `branch` came to `step`: an edit that was posted there acts after it.
Parameters parameters_before(const Setup& setup, const History& history, std::int32_t branch,
                             std::int64_t step);

/// Whether `branch` took a step up to `step` with other parameters than the setup's.
bool changed_before(const Setup& setup, const History& history, std::int32_t branch, std::int64_t step);

/// Steps `run`, which stands on the way to `branch` with the parameters of its place, to `step` and applies
/// the edits met. False when a step failed and left the state where it was.
bool repeat(Run& run, const History& history, std::int32_t branch, std::int64_t step);

}  // namespace topple
