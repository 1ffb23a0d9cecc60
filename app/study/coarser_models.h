// What a study computes more coarsely than a run does.
#pragma once

#include <string>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::app {

/// Lines with the bodies that a study of `scene`, which sets the keys `set` in it, computes on another level
/// than a run of the scene does for motion alone; empty: there are none.
std::string coarser_in_words(const io::Scene& scene, const std::vector<std::string>& set);

}  // namespace topple::app
