// Changes of parameters as they are marked on the timeline.
#pragma once

#include <vector>

#include "solver/run/history.h"

namespace topple::app {

/// One mark: edits of the same thing that follow each other closely, as those of a drag do.
struct EditMark {
  LoggedEdit first, last;
};

/// `edits` in order of their steps. Two of a branch belong together when no other edit stands between them
/// and less than 0.5 s of the run, or the earlier one is a pull that goes on.
std::vector<EditMark> edit_marks(const std::vector<LoggedEdit>& edits);

}  // namespace topple::app
