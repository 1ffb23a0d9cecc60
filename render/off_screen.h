// Drawing without a display, by whichever library is there.
#pragma once

#include <memory>
#include <string>

#include "render/context.h"

namespace topple::render {

/// any: OSMesa, or EGL where that cannot be loaded.
enum class Renderer { any, osmesa, egl };

/// A context that is current on the calling thread. `note`: why it is not OSMesa's though any would do, else
/// empty. Throws std::runtime_error that says what is missing and which Debian packages have it.
std::unique_ptr<Context> make_off_screen_context(Renderer renderer, std::string& note);

}  // namespace topple::render
