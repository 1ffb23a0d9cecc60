// Software rendering without a display through Mesa's off-screen library.
#pragma once

#include <memory>

#include "render/gl/context.h"

namespace topple::render {

/// Loads libOSMesa and returns a context that is current on the calling thread. A process that holds
/// it must not hold a window's context too: both share Mesa's dispatch state. Throws
/// std::runtime_error that names the Debian package when the library is missing.
std::unique_ptr<Context> make_osmesa_context();

}  // namespace topple::render
