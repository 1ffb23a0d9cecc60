// What a run should not be trusted for, found in the run itself.
#pragma once

#include <vector>

#include "app/support/language.h"
#include "solver/run/run.h"

namespace topple::app {

/// One sentence each, for the `warnings` of a summary: what was seen, where, and what to try.
std::vector<Said> run_warnings(const Run& run);
/// Adds those of accelerations that no floor has, most likely of a unit that was forgotten, and of
/// frequencies that rows at `output_rate`, Hz, do not follow.
void warn_of_shakes(const std::vector<Shake>& shakes, double output_rate, std::vector<Said>& list);

}  // namespace topple::app
