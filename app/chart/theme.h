// Colours of the window's charts and words, light or dark.
#pragma once

#include <imgui.h>

namespace topple::app {

/// A cell of the overturning map and the mark in it.
struct CellStyle {
  ImU32 fill, mark;
};

struct Theme {
  ImU32 text, quiet;  ///< words on panels and sheets
  ImU32 sheet;        ///< behind charts
  ImU32 halo;         ///< of letters over the scene
  ImU32 frame, axis, faint, cursor;
  ImU32 line, chosen, positive, negative, hinge, edit, ghost, other;
  ImU32 floor[3];        ///< its components
  CellStyle verdict[6];  ///< by study::Verdict
};

/// Whether the window has the dark theme; it begins with the light one.
inline bool& window_is_dark() {
  static bool dark = false;
  return dark;
}
const Theme& theme();

/// Dear ImGui's own colours and sizes, of letters `scale` times as large as at 720 lines.
void set_style(float scale);

}  // namespace topple::app
