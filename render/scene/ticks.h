// Round numbers for scales.
#pragma once

#include <vector>

namespace topple::render {

/// Round numbers for a scale from minimum to maximum, at most `count` + 1 of them, with as many
/// decimals as tell them apart.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;
};
Ticks nice_ticks(double minimum, double maximum, int count);

/// Round numbers for a scale of square roots from 0 to maximum, far enough apart to be read; without
/// `decimals`.
Ticks root_ticks(double maximum);

}  // namespace topple::render
