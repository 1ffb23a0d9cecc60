// How strong the floor's motion is: what fragility is drawn over.
#pragma once

#include <vector>

#include "solver/model/parameters.h"

namespace topple::study {

/// Largest horizontal acceleration (PGA), m/s^2, and velocity (PGV), m/s: sizes of vectors.
struct FloorPeak {
  double acceleration = 0, velocity = 0;
};

/// Of the floor from t = 0 to `duration`. The velocity is the acceleration's integral (trapezoidal rule, 200
/// steps a second) from rest or from what the floor jumps to; of a sine it is that of its steady motion,
/// A/(2 pi f), however it begins: a constant drift of the floor exerts no force.
FloorPeak floor_peak(std::vector<Shake> shakes, double duration);

}  // namespace topple::study
