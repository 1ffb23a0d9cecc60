// Scenes without what holds their furniture.
#pragma once

#include <optional>

#include "solver/io/scene/scene.h"

namespace topple::study {

/// The scene with every [[anchor]] and [[fixing]] taken away; none when it has none in place. Throws
/// io::InputError when the rest is no scene.
std::optional<io::Scene> without_anchors(const io::Scene& scene);

}  // namespace topple::study
