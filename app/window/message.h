// Modal panels over the window's content, and messages about what went wrong.
#pragma once

#include <string>

#include "app/panels/panels.h"
#include "render/scene/font.h"

namespace topple::app {

/// Begins a panel of this width over `window` and dims the rest, which then takes no clicks. `height`: where
/// it stands, 0 at the top, 1 at the bottom. end_panel_over() ends it.
void begin_panel_over(const char* name, const Box& window, float width, float height,
                      const std::string& title, const render::OverlayFonts& fonts);
void end_panel_over();

/// A button at the right edge of the panel, `place` places from the right.
bool button_at_right(const std::string& label, int place, bool enabled = true);

/// What a person has to know and may want to copy.
struct Message {
  std::string title, text, advice;
  bool may_halve_step = false;  ///< offers that as a way on
};

enum class Answer { none, close, halve_step };
Answer draw_message(const Message& message, const Box& window, const render::OverlayFonts& fonts);

}  // namespace topple::app
