// What a run should not be trusted for, found in the run itself.
#pragma once

#include <string>
#include <vector>

#include "solver/run/run.h"

namespace topple::app {

/// One sentence each, for the `warnings` of a summary: what was seen, where, and what to try.
std::vector<std::string> run_warnings(const Run& run);
/// Adds those of accelerations that no floor has, most likely of a unit that was forgotten, and of
/// frequencies that rows at `output_rate`, Hz, do not follow.
void warn_of_shakes(const std::vector<Shake>& shakes, double output_rate, std::vector<std::string>& list);

}  // namespace topple::app
