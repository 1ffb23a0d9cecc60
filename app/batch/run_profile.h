// Where the time of a run's steps went: for people and for programs.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "solver/state/profile.h"

namespace topple::app {

/// Begins to measure: from here to profile_summary all time belongs to some phase.
void start_profile(Profile& profile);

/// "profile" of the summary: steps, total_s, and the time of each phase, which add up to it. Ends what
/// start_profile began.
nlohmann::ordered_json profile_summary(Profile& profile, std::int64_t steps);

/// The same as a table.
std::string profile_table(const nlohmann::ordered_json& profile);

}  // namespace topple::app
