// Colours of bodies in charts and paths.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace topple::app {

/// Okabe and Ito's colours, told apart by everybody: red, green, blue.
inline const std::array<std::uint8_t, 3>& body_colour(std::size_t body) {
  static constexpr std::array<std::uint8_t, 3> k_colours[] = {{0, 114, 178},   {213, 94, 0},   {0, 158, 115},
                                                              {204, 121, 167}, {86, 180, 233}, {230, 159, 0}};
  return k_colours[body % std::size(k_colours)];
}

}  // namespace topple::app
