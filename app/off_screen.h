// Where pictures are drawn that no window shows.
#pragma once

#include <memory>

#include "render/off_screen.h"

namespace topple::app {

/// As render::make_off_screen_context; its note is said.
std::unique_ptr<render::Context> open_off_screen(render::Renderer renderer = render::Renderer::any);

}  // namespace topple::app
