// What became of a run, as live pages hold it.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/page/verdict.h"
#include "solver/run/place_hits.h"

namespace topple::app {

/// [{"name", "overturn_time_s", "peak_tilt_deg", "critical_tilt_deg"}], null where there is none.
nlohmann::ordered_json ends_json(const std::vector<BodyEnd>& ends);
std::vector<BodyEnd> ends_from(const nlohmann::ordered_json& list);

/// [{"place", "body", "time_s"}]: indices, and when that one hit who is there.
nlohmann::ordered_json hits_json(const std::vector<PlaceOutcome>& places);
/// places: how many there are.
std::vector<PlaceOutcome> hits_from(const nlohmann::ordered_json& list, std::size_t places);

}  // namespace topple::app
