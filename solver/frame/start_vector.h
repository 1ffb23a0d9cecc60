// Where iterations for eigenvectors begin.
#pragma once

#include "solver/math/elementary.h"

namespace topple {

/// Entry `row` of a vector, the `column`-th of several, that shares no symmetry of a body.
inline double start_entry(int row, int column = 0) {
  return elementary::sin(1 + 2.7 * row + 1.3 * column * (row % 7));
}

}  // namespace topple
