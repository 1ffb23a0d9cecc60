#include "render/scene/overlay_parts.h"

#include <cstdio>

namespace topple::render {
namespace {

constexpr Colours k_light = {
    IM_COL32(24, 34, 45, 255),  IM_COL32(44, 56, 68, 255),    IM_COL32(84, 97, 110, 255),
    IM_COL32(60, 74, 88, 150),  IM_COL32(255, 255, 255, 205), IM_COL32(38, 92, 140, 255),
    IM_COL32(200, 70, 30, 255), IM_COL32(60, 74, 88, 60),     IM_COL32(60, 74, 88, 90)};
constexpr Colours k_dark = {
    IM_COL32(240, 243, 246, 255), IM_COL32(220, 226, 232, 255), IM_COL32(186, 195, 204, 255),
    IM_COL32(190, 200, 210, 150), IM_COL32(26, 30, 36, 205),    IM_COL32(110, 185, 240, 255),
    IM_COL32(255, 130, 90, 255),  IM_COL32(190, 200, 210, 60),  IM_COL32(190, 200, 210, 90)};

}  // namespace

const Colours& colours(bool dark) {
  return dark ? k_dark : k_light;
}

std::string number(double value, int decimals) {
  char digits[64];
  const bool plain = value == 0 || (std::abs(value) < 1e6 && decimals <= 4);
  std::snprintf(digits, sizeof digits, plain ? "%.*f" : "%.*e", plain ? decimals : 1, std::abs(value));
  const bool zero = std::string(digits).find_first_not_of("0.") == std::string::npos;
  return (value < 0 && !zero ? "\xe2\x88\x92" : "") + std::string(digits);
}

}  // namespace topple::render
