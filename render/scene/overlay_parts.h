// What the parts of an overlay are drawn with.
#pragma once

#include <imgui.h>

#include <cmath>
#include <string>

#include "render/scene/font.h"
#include "render/scene/text_layout.h"

namespace topple::render {

/// Of text, lines and grounds, on a light or a dark picture.
struct Colours {
  ImU32 title, text, quiet, frame, sheet, trace, cursor, border, axis;
};
const Colours& colours(bool dark);

/// Where and how large the parts are.
struct Layout {
  ImDrawList& list;
  const OverlayFonts& fonts;
  float width, height;
  float unit;  // px of the picture for one pixel of a design 720 pixels high
  float margin;
  const Colours& colours;
  ImU32 halo = 0;  // of letters over bodies; 0: none
  float line(const ImFont* font) const { return std::round(1.32f * font->FontSize); }

  void text(const ImFont* font, float x, float y, ImU32 colour, const std::string& words) const {
    add_text(list, *font, {std::round(x), std::round(y)}, colour, halo, words);
  }
};

/// With a minus sign, and a power of ten where it is large or small.
std::string number(double value, int decimals);

}  // namespace topple::render
