// Drawing without a display, by whichever library is there.
#pragma once

#include <memory>

#include "render/gl/context.h"

namespace topple::render {

/// any: OSMesa, or EGL where that cannot be loaded (Mesa 25.1 has none). Both draw with Mesa's software.
enum class Renderer { any, osmesa, egl };

/// A context that is current on the calling thread. Throws std::runtime_error that says what is missing and
/// which Debian packages have it.
std::unique_ptr<Context> make_off_screen_context(Renderer renderer);

}  // namespace topple::render
