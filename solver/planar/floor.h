// Acceleration of the floor in the plane, as power series between its kinks.
#pragma once

#include <span>

#include "solver/model/parameters.h"
#include "solver/planar/power_series.h"

namespace topple::planar {

/// Of the time since t, m/s^2, valid from t on.
struct FloorSeries {
  Series<double> horizontal, vertical;
  double end;  ///< s, > t: of the first kink or jump after t; k_never when none
};

/// How a floor moves. `series` fills terms up to k_order at least unless a polynomial has fewer; at a kink it
/// is what comes after. It allocates nothing.
struct Floor {
  void (*series)(const void* floor, double t, FloorSeries& out);
  const void* floor;
};

/// A floor that does not move.
Floor floor_at_rest();

/// A floor that shakes along a horizontal unit vector and up; what it shakes across is left out. Both must
/// live as long as the floor.
struct ShakenPlane {
  std::span<const Shake> shakes;
  Vec3 along = Vec3::UnitX();
};
Floor shaken(const ShakenPlane& plane);

}  // namespace topple::planar
