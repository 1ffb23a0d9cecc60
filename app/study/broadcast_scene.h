// A scene as rank 0 broadcasts it to the others.
#pragma once

#include <string>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::app {

/// Name, text, then name and bytes of each file.
std::vector<std::string> broadcast_parts(const io::Scene& scene);
io::Scene scene_from(const std::vector<std::string>& parts);

}  // namespace topple::app
