// `topple view`: the window.
#pragma once

#include "app/window/opening.h"

namespace topple::app {

int view_command(const ViewOptions& options);

}  // namespace topple::app
