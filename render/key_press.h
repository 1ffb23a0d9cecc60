// A key that a person pressed.
#pragma once

namespace topple::render {

/// Printable keys are the capital that stands on them (ASCII); these are the others that count.
namespace key {
inline constexpr int escape = 256, home = 268, end = 269, f1 = 290;  // as GLFW numbers them
}

struct KeyPress {
  int key = 0;
  bool control = false, shift = false;
};

}  // namespace topple::render
