// The letters of the overlay: DejaVu Sans, with the Latin, Greek and technical signs that captions use.
#pragma once

struct ImFont;
struct ImFontAtlas;

namespace topple::render {

/// Sizes of one overlay. The fonts belong to the atlas.
struct OverlayFonts {
  ImFont* title = nullptr;
  ImFont* text = nullptr;
  ImFont* small = nullptr;
};

/// Adds the three sizes that suit a picture of `height` pixels. Throws std::runtime_error that names
/// the Debian package when the font file is not installed.
OverlayFonts add_overlay_fonts(ImFontAtlas& atlas, int height);

}  // namespace topple::render
