// What is computed, beside what is asked for: the model of a body and why, what moves it, the step it takes.
#pragma once

#include <optional>
#include <string>

#include "app/live/player.h"

namespace topple::app {

/// Mean step between the instant that is shown and the frame before it (of the first one: after it), s. None:
/// there are no two frames.
std::optional<double> step_taken(const Player& player);

/// "now rigid (nothing but motion is asked): central differences, TR-BDF2 on stiff contacts", at the instant
/// that is shown. Empty: there is none.
std::string computed_in_words(const Player& player, std::size_t body);

/// "of frames; at work now: central differences": what moves bodies at the instant that is shown. Empty: the
/// integrator that is chosen alone moves all of them, or there is no instant.
std::string integrators_in_words(const Player& player);

}  // namespace topple::app
