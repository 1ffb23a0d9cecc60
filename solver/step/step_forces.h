// Contacts of the newest step.
#pragma once

#include "solver/step/workspace.h"

namespace topple {

/// Body and element with the greatest contact force of the newest step; false: nothing touches.
bool blame_hardest_contact(const Model& model, Workspace::Impl& w, StepStatus& status);

}  // namespace topple
