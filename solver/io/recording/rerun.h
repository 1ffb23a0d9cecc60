// Running again what was recorded.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "solver/io/recording/recording.h"

namespace topple::io {

/// Refuses edits that the recording's scene has no place for. Throws InputError; afterwards the history can
/// be repeated.
void check_edits(const History& history, const Setup& setup);

/// Where a recording is not what its second run gives.
struct Difference {
  FrameKey at;
  std::string what;  ///< "position", "hinge", "state", ...
  int element = -1;  ///< index into Model::elements, the first that it is about; -1: it is about none
};

/// What a second run came to.
struct Rerun {
  std::int64_t checkpoints = 0;         ///< found the same
  std::vector<Difference> damage;       ///< stored states that do not have their hashes
  std::vector<Difference> differences;  ///< of each branch the first
};

/// Reads every frame and checkpoint, then runs every branch again, from the scene text and the edits, and
/// compares the numbers of all its frames and the state hashes of its checkpoints (of formats from which a
/// run can go on): the root from its start, others from their parent at the fork, which is reached from the
/// checkpoint before it and not compared again. `seen` is called with the number of checkpoints passed.
/// Throws InputError for a recording that is damaged or does not belong to its scene.
Rerun rerun(const Recording& recording, const std::function<void(std::int64_t)>& seen);

}  // namespace topple::io
