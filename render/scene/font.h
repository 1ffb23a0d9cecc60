// The fonts of the overlay: DejaVu Sans, with the Latin, Greek and technical signs that captions use, and
// Japanese ones from VL PGothic.
#pragma once

#include <string>

struct ImFont;
struct ImFontAtlas;

namespace topple::render {

/// Sizes of one overlay. The fonts belong to the atlas.
struct OverlayFonts {
  ImFont* title = nullptr;
  ImFont* text = nullptr;
  ImFont* small = nullptr;
};

/// Characters to load besides those of Latin captions.
struct Letters {
  std::string more = {};  ///< text that holds each of them
  bool needed = false;    ///< without their font there is an error, else signs for missing characters
  float smallest = 9;     ///< px
};

bool has_japanese_font();

/// Adds the three sizes that suit a picture of `height` pixels and bakes them. Throws std::runtime_error that
/// names the Debian package when a font that is needed is not installed.
OverlayFonts add_overlay_fonts(ImFontAtlas& atlas, int height, const Letters& letters = {});

}  // namespace topple::render
