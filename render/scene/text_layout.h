// Fitting text into a width.
#pragma once

#include <imgui.h>

#include <string>
#include <string_view>
#include <vector>

namespace topple::render {

/// Width of one line in px.
float text_width(const ImFont& font, std::string_view text);

/// A line over bodies, which stay seen between its letters: those have an edge of the colour `halo`; 0: none.
void add_text(ImDrawList& list, const ImFont& font, ImVec2 at, ImU32 colour, ImU32 halo,
              std::string_view text);

/// The text on one line (control characters become spaces), cut with an ellipsis when it is wider
/// than `width` px.
std::string shortened(const ImFont& font, std::string_view text, float width);

/// The text broken at spaces, and between letters that are written without, into at most `most` lines, the
/// last one shortened.
std::vector<std::string> wrapped(const ImFont& font, std::string_view text, float width, int most);

}  // namespace topple::render
