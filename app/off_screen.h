// Where pictures are drawn that no window shows.
#pragma once

#include <memory>

#include "render/off_screen.h"

namespace topple::app {

/// As render::make_off_screen_context; its note is said, unless another process that draws says it.
std::unique_ptr<render::Context> open_off_screen(render::Renderer renderer = render::Renderer::any,
                                                 bool say_note = true);

}  // namespace topple::app
