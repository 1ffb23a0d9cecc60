#include "render/scene/text_layout.h"

#include <imgui.h>
#include <utf8.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>

namespace topple::render {
namespace {

constexpr const char* k_ellipsis = "\xe2\x80\xa6";

std::string one_line(std::string_view text) {
  std::string line = utf8::replace_invalid(text);
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return line;
}

void drop_last_letter(std::string& text) {
  auto last = text.end();
  utf8::prior(last, text.begin());
  text.erase(last, text.end());
}

/// Whether it is a letter of Chinese or Japanese, which are written without spaces.
bool is_ideographic(std::uint32_t letter) {
  return letter >= 0x3000 && letter <= 0xffff;
}

/// No line begins with these.
bool ends_a_phrase(std::string_view text, std::size_t at) {
  static constexpr std::string_view k_ends[] = {"、", "。", "）", "」", "：", "ー",
                                                "ッ", "ャ", "ュ", "ョ", "ィ"};
  return std::ranges::any_of(k_ends, [&](std::string_view end) { return text.substr(at).starts_with(end); });
}

/// Whether what follows the space at `at` is the unit of a number before it.
bool precedes_a_unit(std::string_view text, std::size_t at) {
  static constexpr std::string_view k_units[] = {"gal", "Hz", "s",   "mm", "m",     "kN",   "N",   "MPa",
                                                 "J",   "kg", "kgf", "%",  "rad/s", "cm/s", "m/s", "ms"};
  if (at == 0 || text[at - 1] < '0' || text[at - 1] > '9') return false;
  const std::string_view rest = text.substr(at + 1);
  return std::ranges::any_of(k_units, [&](std::string_view unit) {
    return rest.starts_with(unit) &&
           (rest.size() == unit.size() || !std::isalnum(static_cast<unsigned char>(rest[unit.size()])));
  });
}

/// Where a line may end next after `at`: at a space that does not part a number from its unit, or beside a
/// letter that needs none.
std::size_t next_break(std::string_view text, std::size_t at) {
  auto next = text.begin() + static_cast<std::ptrdiff_t>(at);
  std::uint32_t before = next == text.end() ? 0 : utf8::next(next, text.end());
  while (next != text.end()) {
    const auto i = static_cast<std::size_t>(next - text.begin());
    const std::uint32_t letter = utf8::next(next, text.end());
    if (letter == ' ' && !precedes_a_unit(text, i)) return i;
    if ((is_ideographic(letter) || is_ideographic(before)) && !ends_a_phrase(text, i)) return i;
    before = letter;
  }
  return std::string_view::npos;
}

}  // namespace

float text_width(const ImFont& font, std::string_view text) {
  return font
      .CalcTextSizeA(font.FontSize, std::numeric_limits<float>::max(), 0, text.data(),
                     text.data() + text.size())
      .x;
}

void add_text(ImDrawList& list, const ImFont& font, ImVec2 at, ImU32 colour, ImU32 halo,
              std::string_view text) {
  const float edge = std::max(1.f, std::round(font.FontSize / 13));
  const auto add = [&](float x, float y, ImU32 of) {
    list.AddText(&font, font.FontSize, {at.x + x * edge, at.y + y * edge}, of, text.data(),
                 text.data() + text.size());
  };
  if (halo != 0)
    for (const float y : {-1.f, 0.f, 1.f})
      for (const float x : {-1.f, 0.f, 1.f})
        if (x != 0 || y != 0) add(x, y, halo);
  add(0, 0, colour);
}

std::string shortened(const ImFont& font, std::string_view text, float width) {
  std::string line = one_line(text);
  if (text_width(font, line) <= width) return line;
  const float room = width - text_width(font, k_ellipsis);
  while (!line.empty() && text_width(font, line) > room) drop_last_letter(line);
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return room > 0 ? line + k_ellipsis : std::string();
}

std::vector<std::string> wrapped(const ImFont& font, std::string_view text, float width, int most) {
  std::vector<std::string> lines;
  const std::string all = one_line(text);
  std::size_t start = 0;
  while (start < all.size() && static_cast<int>(lines.size()) < most) {
    const std::string_view rest = std::string_view(all).substr(start);
    if (static_cast<int>(lines.size()) + 1 == most || text_width(font, rest) <= width) {
      lines.push_back(shortened(font, rest, width));
      break;
    }
    std::size_t fits = 0;  // length of the longest beginning that ends where a line may and fits
    for (std::size_t end = next_break(rest, 0); end != std::string_view::npos; end = next_break(rest, end)) {
      if (text_width(font, rest.substr(0, end)) > width) break;
      fits = end;
    }
    if (fits == 0) {  // one word is wider than the line
      const std::size_t space = rest.find(' ');
      fits = std::min(space, rest.size());
      lines.push_back(shortened(font, rest.substr(0, fits), width));
    } else {
      lines.emplace_back(rest.substr(0, fits));
    }
    start += fits;
    while (start < all.size() && all[start] == ' ') ++start;
  }
  return lines;
}

}  // namespace topple::render
