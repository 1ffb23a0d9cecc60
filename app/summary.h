// What a run came to: for people and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "solver/io/scene.h"
#include "solver/run.h"

namespace topple::app {

/// The summary of interface 3. What does not exist is null; numbers that are not finite are null too.
/// `status`: completed, stopped, diverged or interrupted.
nlohmann::ordered_json summary(const io::Scene& scene, const Run& run, const std::string& status,
                               double wall_s);

/// The same as a table of a few lines.
std::string summary_table(const nlohmann::ordered_json& summary);

}  // namespace topple::app
