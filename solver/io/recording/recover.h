// Repair of recordings whose writer was killed, or that were damaged later.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording.h"

namespace topple::io {

/// The rows of a recording that can be read and have their checksums, and how many have not.
struct SoundRows {
  std::vector<std::int64_t> frames, checkpoints;  ///< indices
  std::int64_t damaged_frames = 0, damaged_checkpoints = 0;
};
/// Reads every frame and checkpoint.
SoundRows sound_rows(const Recording& recording);

/// Writes a closed recording that holds these rows and all events, edits, branches and the result of
/// `recording`. It appears at `target` whole or not at all; false, and it does not, when `proceed` (asked
/// before each frame) gave it up. Throws WriteError, and InputError when the scene gives another model now
/// than the one that was recorded, or the format is one that no run goes on from.
bool write_recovered(const Recording& recording, const SoundRows& rows, const host::Target& target,
                     const std::function<bool()>& proceed = {});

}  // namespace topple::io
