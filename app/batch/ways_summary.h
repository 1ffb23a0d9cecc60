// The way out in a summary.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "solver/run/run.h"

namespace topple::app {

/// "ways" of interface 3: one per place of the room, as what stands at `position` (per node) leaves it. A
/// place without a door has nulls. `length_m` is that of the shortest way of a person.
nlohmann::ordered_json ways_json(const Room& room, const Model& model, std::span<const Vec3> position,
                                 const std::vector<PlaceOutcome>& hits);

/// The same of a run, with "before": as it began.
nlohmann::ordered_json ways_json(const Run& run);

/// A line per place: "place desk: way to door open, widest 0.62 m, shortest 4.1 m long; hit by shelf at 2.31
/// s".
/// person: m.
std::string ways_in_words(const nlohmann::ordered_json& ways, double person);

/// "shelf at 2.31 s, desk at 2.40 s" of one of them; empty: nothing hits there.
std::string hits_in_words(const nlohmann::ordered_json& way);

}  // namespace topple::app
