// A key that a person pressed.
#pragma once

namespace topple::render {

/// Printable keys are the capital that stands on them (ASCII); these are the others that count.
namespace key {
// As GLFW numbers them.
inline constexpr int escape = 256, enter = 257, tab = 258, right = 262, left = 263, down = 264, up = 265,
                     home = 268, end = 269, del = 261, f1 = 290, f2 = 291, f6 = 295, f11 = 300,
                     keypad_minus = 333, keypad_plus = 334, enter_of_pad = 335;
}  // namespace key

struct KeyPress {
  int key = 0;
  bool control = false, shift = false;
};

}  // namespace topple::render
