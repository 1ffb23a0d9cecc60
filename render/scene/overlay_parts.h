// What the parts of an overlay are drawn with.
#pragma once

#include <imgui.h>

#include <cmath>
#include <string>

#include "render/scene/font.h"

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
  float line(const ImFont* font) const { return std::round(1.32f * font->FontSize); }

  void text(const ImFont* font, float x, float y, ImU32 colour, const std::string& words) const {
    list.AddText(font, font->FontSize, {std::round(x), std::round(y)}, colour, words.data(),
                 words.data() + words.size());
  }
};

/// With a minus sign, and a power of ten where it is large or small.
std::string number(double value, int decimals);

}  // namespace topple::render
