// Changes of parameters as they are marked on the timeline, and which marks have room there.
#pragma once

#include <functional>
#include <vector>

#include "solver/run/history.h"

namespace topple::app {

/// One mark: edits of the same thing that follow each other closely, as those of a drag do.
struct EditMark {
  LoggedEdit first, last;
};

/// `edits` in order of their steps. Two of a branch belong together when no other edit stands between them
/// and less than 0.5 s of the run, or the earlier one is a pull that goes on, or the later one `goes_on` with
/// it, as known of a drag that was seen.
std::vector<EditMark> edit_marks(const std::vector<LoggedEdit>& edits,
                                 const std::function<bool(const LoggedEdit&)>& goes_on);

/// What a mark gives way to where there is no room for both.
enum class GivesWay { to_none, to_breaks, to_all };
/// A mark along the timeline, px.
struct PlacedMark {
  float x;
  GivesWay gives_way;
  bool breaks = false;
};
/// Whether each is drawn: of those that give way, what is `apart` from breaks, or `far_apart` from all drawn.
std::vector<bool> drawn_marks(const std::vector<PlacedMark>& marks, float apart, float far_apart);

}  // namespace topple::app
