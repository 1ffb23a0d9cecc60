#include "render/scene/font.h"

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

constexpr const char* k_japanese_path = "/usr/share/fonts/truetype/vlgothic/VL-PGothic-Regular.ttf";

void require(const char* path, const char* package) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw std::runtime_error(std::string(path) + ": the font is not installed; install the Debian package " +
                             package);
}

/// Pairs of first and last code point of what DejaVu is not asked for; empty: nothing.
ImVector<ImWchar> others(const std::string& text) {
  ImFontGlyphRangesBuilder all, known;
  all.AddText(text.c_str());
  known.AddRanges(k_letters);
  for (int i = 0; i < all.UsedChars.Size; ++i) all.UsedChars[i] &= ~known.UsedChars[i];
  ImVector<ImWchar> ranges;
  all.BuildRanges(&ranges);
  if (ranges.Size == 1) ranges.clear();  // the end alone
  return ranges;
}

}  // namespace

bool has_japanese_font() {
  std::error_code ignored;
  return std::filesystem::is_regular_file(k_japanese_path, ignored);
}

OverlayFonts add_overlay_fonts(ImFontAtlas& atlas, int height, const Letters& letters) {
  require(k_font_path, "fonts-dejavu-core");
  const ImVector<ImWchar> more = others(letters.more);
  if (letters.needed && !more.empty()) require(k_japanese_path, "fonts-vlgothic");
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  config.PixelSnapH = true;
  ImFontConfig japanese = config;
  japanese.OversampleH = 1;
  japanese.MergeMode = true;
  const auto add = [&](float size_at_720) {
    const float size = std::max(letters.smallest, std::round(size_at_720 * static_cast<float>(height) / 720));
    ImFont* font = atlas.AddFontFromFileTTF(k_font_path, size, &config, k_letters);
    if (font == nullptr) throw std::runtime_error(std::string(k_font_path) + ": cannot be read as a font");
    if (!more.empty() && has_japanese_font())
      atlas.AddFontFromFileTTF(k_japanese_path, size, &japanese, more.Data);
    // Asked for by code point: a literal of the sign would depend on the compiler's character set.
    font->EllipsisChar = 0x2026;
    return font;
  };
  const OverlayFonts fonts{add(26), add(17), add(14)};
  atlas.Build();  // while `more` lives
  return fonts;
}

}  // namespace topple::render
