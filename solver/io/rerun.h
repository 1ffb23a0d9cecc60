// Running again what was recorded.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "solver/io/recording.h"

namespace topple::io {

/// Refuses edits that the recording's scene has no place for. Throws InputError; afterwards the history can
/// be repeated.
void check_edits(const History& history, const Setup& setup);

/// What a second run came to.
struct Rerun {
  std::int64_t checkpoints = 0;      ///< found the same
  std::vector<Instant> differences;  ///< of each branch the first checkpoint that has another state hash
};

/// Runs every branch again, from the scene text and the edits, and compares the state hashes of all its
/// checkpoints: the root from its start, others from their parent at the fork, which is reached from the
/// checkpoint before it. `seen` is called with the number of checkpoints passed. Throws InputError for a
/// recording that does not belong to its scene.
Rerun rerun(const Recording& recording, const std::function<void(std::int64_t)>& seen);

}  // namespace topple::io
