#include "render/scene/colour_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::render {
namespace {

constexpr int k_knots = 17;
using Knots = std::array<std::uint32_t, k_knots>;

// The published maps at every sixteenth; straight lines between them stay within their eye-visible
// tolerance.
constexpr Knots k_viridis = {0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d,
                             0x2c728e, 0x26818e, 0x21908c, 0x1f9f88, 0x28ae80, 0x3ebc74,
                             0x5dc963, 0x82d34c, 0xabdc32, 0xd5e21a, 0xfde725};
constexpr Knots k_cividis = {0x00224e, 0x002e6a, 0x1a386f, 0x32436d, 0x434e6c, 0x52596d,
                             0x61656f, 0x6f7073, 0x7c7b78, 0x8b8778, 0x9b9376, 0xaba072,
                             0xbbad6c, 0xccba64, 0xddc958, 0xefd748, 0xfee838};

ColourTable interpolated(const Knots& knots) {
  ColourTable table;
  for (int i = 0; i < k_colour_map_size; ++i) {
    const double at = static_cast<double>(i) / (k_colour_map_size - 1) * (k_knots - 1);
    const int below = std::min(static_cast<int>(at), k_knots - 2);
    for (int channel = 0; channel < 3; ++channel) {
      const int shift = 16 - 8 * channel;
      const double a = (knots[static_cast<std::size_t>(below)] >> shift) & 0xff;
      const double b = (knots[static_cast<std::size_t>(below) + 1] >> shift) & 0xff;
      table[static_cast<std::size_t>(i)][static_cast<std::size_t>(channel)] =
          static_cast<std::uint8_t>(std::lround(a + (b - a) * (at - below)));
    }
  }
  return table;
}

/// sRGB bytes of a CIELAB colour (D65), cut at the gamut's border.
std::array<std::uint8_t, 3> srgb_of_lab(double lightness, double a, double b) {
  const auto linear = [](double f) { return f > 6.0 / 29 ? f * f * f : 108.0 / 841 * (f - 4.0 / 29); };
  const double fy = (lightness + 16) / 116;
  const double x = 0.95047 * linear(fy + a / 500);
  const double y = linear(fy);
  const double z = 1.08883 * linear(fy - b / 200);
  const auto encode = [](double c) {
    c = std::clamp(c, 0.0, 1.0);
    const double coded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * coded));
  };
  return {encode(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
          encode(-0.969266 * x + 1.8760108 * y + 0.041556 * z),
          encode(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}

/// Two hues of equal lightness at equal distance from a grey that still stands out from the floor.
ColourTable diverging_table() {
  constexpr double k_middle_lightness = 80;
  constexpr double k_end_lightness = 36;
  constexpr double k_chroma = 48;
  constexpr double k_blue_degrees = 280;
  constexpr double k_red_degrees = 37;
  ColourTable table;
  for (int i = 0; i < k_colour_map_size; ++i) {
    const double s = 2.0 * i / (k_colour_map_size - 1) - 1;
    const double hue = (s < 0 ? k_blue_degrees : k_red_degrees) * std::numbers::pi / 180;
    const double chroma = k_chroma * (1 - std::pow(1 - std::abs(s), 1.6));
    table[static_cast<std::size_t>(i)] =
        srgb_of_lab(k_middle_lightness + (k_end_lightness - k_middle_lightness) * std::abs(s),
                    chroma * std::cos(hue), chroma * std::sin(hue));
  }
  return table;
}

/// The upper part of a map that grows lighter.
ColourTable on_dark(const ColourTable& map) {
  constexpr double k_from = 0.42;
  ColourTable table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double at = k_from + (1 - k_from) * static_cast<double>(i) / (k_colour_map_size - 1);
    table[i] = map[static_cast<std::size_t>(std::lround(at * (k_colour_map_size - 1)))];
  }
  return table;
}

}  // namespace

const ColourTable& colour_table(ColourMap map) {
  static const ColourTable viridis = interpolated(k_viridis);
  static const ColourTable cividis = interpolated(k_cividis);
  static const ColourTable diverging = diverging_table();
  static const ColourTable light_viridis = on_dark(viridis), light_cividis = on_dark(cividis);
  switch (map) {
    case ColourMap::cividis:
      return cividis;
    case ColourMap::diverging:
      return diverging;
    case ColourMap::viridis_on_dark:
      return light_viridis;
    case ColourMap::cividis_on_dark:
      return light_cividis;
    case ColourMap::viridis:
      break;
  }
  return viridis;
}

float colour_position(float value, float minimum, float maximum) {
  if (!(maximum > minimum)) return 0;
  return std::clamp((value - minimum) / (maximum - minimum), 0.0f, 1.0f);
}

}  // namespace topple::render
