// The line that says what plays.
#pragma once

#include <string>

#include "app/live/player.h"

namespace topple::app {

/// One sentence for the status line: what plays, and how it stands with it.
std::string status_in_words(const Player& player);

}  // namespace topple::app
