// What a scene or a recording holds, for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Settings, bodies and anchors.
nlohmann::ordered_json scene_description(const io::Scene& scene);

/// The same of its scene, and what is recorded; events, energy and the last instant of the newest branch.
/// Throws InputError for events of what the scene does not have.
nlohmann::ordered_json recording_description(const io::Recording& recording);

/// What running the recording again shows: "same", "damaged", and the first difference of each branch.
/// Reports progress.
nlohmann::ordered_json verify(const io::Recording& recording);

}  // namespace topple::app
