// Places of the ends of an element, to be moved one by one.
#pragma once

#include "solver/element/beam.h"
#include "solver/math/rotation.h"

namespace topple::test {

struct Pose {
  Vec3 x1, x2;
  Quat q1, q2;
};

/// Moved by h along one of twelve directions: x1, spin of the first end, x2, spin of the second, three each.
inline Pose moved(Pose p, int direction, double h) {
  const Vec3 step = h * Vec3::Unit(direction % 3);
  if (direction / 3 == 0) p.x1 += step;
  if (direction / 3 == 1) p.q1 = exp_quaternion(step) * p.q1;
  if (direction / 3 == 2) p.x2 += step;
  if (direction / 3 == 3) p.q2 = exp_quaternion(step) * p.q2;
  return p;
}

inline BeamEnds ends_of(const Pose& p) {
  return beam_ends(p.x1, p.q1, p.x2, p.q2);
}

}  // namespace topple::test
