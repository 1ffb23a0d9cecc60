// Rendering without a display or a surface through EGL: Mesa's software, or the driver of a graphics card.
#pragma once

#include <memory>

#include "render/gl/context.h"

namespace topple::render {

/// Loads libEGL and returns a context that is current on the calling thread. Throws std::runtime_error that
/// names the Debian packages when the library or its surfaceless platform is missing.
std::unique_ptr<Context> make_egl_context();

}  // namespace topple::render
