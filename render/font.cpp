#include "render/font.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace topple::render {
namespace {

constexpr const char* k_font_path = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

/// Pairs of first and last code point.
constexpr ImWchar k_letters[] = {0x0020, 0x00ff,  // Latin, with °, ², ³, ·, ±, ×
                                 0x0100, 0x017f,  // Latin of the rest of Europe
                                 0x0370, 0x03ff,  // Greek
                                 0x2010, 0x2026,  // dashes, quotation marks, ellipsis
                                 0x2070, 0x209c,  // superscripts and subscripts
                                 0x2190, 0x2193,  // arrows
                                 0x2202, 0x2265,  // mathematical signs
                                 0};

/// Below this size letters cannot be read, px.
constexpr float k_smallest = 9;

}  // namespace

OverlayFonts add_overlay_fonts(ImFontAtlas& atlas, int height) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(k_font_path, ignored)) {
    throw std::runtime_error(std::string(k_font_path) +
                             ": the font is not installed; install the Debian package fonts-dejavu-core");
  }
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  config.PixelSnapH = true;
  const auto add = [&](float size_at_720) {
    const float size = std::max(k_smallest, std::round(size_at_720 * static_cast<float>(height) / 720));
    ImFont* font = atlas.AddFontFromFileTTF(k_font_path, size, &config, k_letters);
    if (font == nullptr) throw std::runtime_error(std::string(k_font_path) + ": cannot be read as a font");
    // Asked for by code point: a literal of the sign would depend on the compiler's character set.
    font->EllipsisChar = 0x2026;
    return font;
  };
  return {add(26), add(17), add(14)};
}

}  // namespace topple::render
