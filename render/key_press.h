// A key that a person pressed.
#pragma once

namespace topple::render {

/// Printable keys are the capital that stands on them (ASCII); these are the others that count.
namespace key {
inline constexpr int escape = 256, tab = 258, home = 268, end = 269, f1 = 290, f6 = 295, keypad_minus = 333,
                     keypad_plus = 334;  // as GLFW numbers them
}

struct KeyPress {
  int key = 0;
  bool control = false, shift = false;
};

}  // namespace topple::render
