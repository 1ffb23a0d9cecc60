// Load steps of static runs, as summaries hold them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "solver/run/run.h"

namespace topple::app {

/// "static" of a summary: one entry a load step.
nlohmann::ordered_json load_steps_json(const Run& run);

/// ", unstable in 1 direction: buckles ...; node 5 of "portal" moves most, along (0.00, 1.00, 0.00)" of one
/// of its entries; of a stable one nothing.
std::string loss_in_words(const nlohmann::ordered_json& step);

/// The load steps that a summary of `model` holds; none where it is no text of JSON or tells of none.
std::vector<LoadStep> load_steps_in(const std::string& summary, const Model& model);

/// Of the equilibria among load steps, one after the other. Where the next one failed, what it lost is the
/// loss of the one before it.
std::vector<Stability> stabilities(std::span<const LoadStep> steps);

}  // namespace topple::app
