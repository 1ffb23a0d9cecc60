// Colour maps: perceptually even, safe for colour-blind readers, with a luminance that rises
// (sequential) or mirrors about the middle (diverging).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace topple::render {

/// diverging: blue - grey - red, for signed values. On a dark ground the sequential ones begin where they
/// can be told from it.
enum class ColourMap { viridis, cividis, diverging, viridis_on_dark, cividis_on_dark };
inline constexpr std::size_t k_colour_map_count = 5;

inline constexpr int k_colour_map_size = 256;
using ColourTable = std::array<std::array<std::uint8_t, 3>, k_colour_map_size>;

/// The map as sRGB bytes, from the least value to the greatest.
const ColourTable& colour_table(ColourMap map);

/// Where `value` lies in minimum..maximum, 0..1; values outside take the nearest end.
float colour_position(float value, float minimum, float maximum);

}  // namespace topple::render
