// Acceleration of the floor in the plane, as power series between its kinks.
#pragma once

#include <span>

#include "solver/model/parameters.h"
#include "solver/planar/power_series.h"

namespace topple::planar {

/// along a + up a_z + offset of the floor's accelerations a and a_z.
struct FloorSign {
  double along, up, offset;
};

/// How a floor moves. `series` sets its horizontal and vertical acceleration, m/s^2, as series of the time
/// since t, to k_order at least unless they are polynomials, and returns how long they hold: the time > t of
/// the next kink or jump, s, k_never when none. At a kink they are what comes after. It allocates nothing.
struct Floor {
  double (*series)(const void* floor, double t, Series<double>& horizontal, Series<double>& vertical);
  const void* floor;
  /// A kink of the floor at t or later up to which all of these are positive, s; t where none is known. Null:
  /// none ever is.
  double (*quiet)(const void* floor, double t, double until, std::span<const FloorSign> signs) = nullptr;
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
