// A rigid block in a vertical plane on a hard floor: data and motion. World axes: x along the plane's
// horizontal, z up, both seen from the floor. A tilt is positive towards +x.
#pragma once

#include <memory>

#include "solver/math/elementary.h"

namespace topple::planar {

class SprungBase;

enum class Side { left, right };  ///< towards -x, +x
inline Side other(Side side) {
  return side == Side::right ? Side::left : Side::right;
}

/// A flat base with an edge on either side and a centre of gravity above the floor.
struct Block {
  double mass = 1;     ///< kg
  double inertia = 1;  ///< kg m^2, about the centre of gravity
  /// m, from below the centre of gravity to the edges; -left <= right, the base need not lie below it.
  double left = 1, right = 1;
  double height = 1;           ///< m, of the centre of gravity over the base
  double static_friction = 0;  ///< not below kinetic_friction
  double kinetic_friction = 0;
  /// Factor on the rate that a block without slip keeps at an impact of its base by Housner's condition
  /// (transition.h); 0: comes to rest on it.
  double restitution = 1;
  double gravity = 9.80665;                  ///< m/s^2
  std::shared_ptr<const SprungBase> sprung;  ///< where points lie between its edges (sprung_base.h)

  double edge(Side side) const { return side == Side::right ? right : -left; }
  double inertia_over_mass() const { return inertia / mass; }
};

/// What the block does.
enum class Mode { rest, slide, rock, slide_rock, flight };

/// All that is needed to go on, bit for bit. x, z: of the reference, that is the point of the base below the
/// centre of gravity (rest, slide), the edge that touches (rock, slide_rock), or the centre of gravity
/// (flight).
struct State {
  double time = 0;  ///< s
  Mode mode = Mode::rest;
  Side side = Side::right;  ///< edge that touches, in rock and slide_rock
  int slip = 0;             ///< sign of the velocity of the reference, in slide and slide_rock
  bool undecided = true;    ///< the mode follows from the forces of this instant (start, kink of the floor)
  double x = 0, z = 0, tilt = 0;                    ///< m, m, rad
  double x_velocity = 0, z_velocity = 0, rate = 0;  ///< m/s, m/s, rad/s
};

/// From the centre of gravity to a point of the block, world axes, m.
struct Lever {
  double x, z;
};
/// Sine and cosine of a tilt, kept with it: several laws at one instant ask for them.
struct Turned {
  double tilt = 0;
  elementary::SinCos of{0, 1};

  elementary::SinCos at(double other) const { return other == tilt ? of : elementary::sin_cos(other); }
};
/// u: along the base, w: up, both from the centre of gravity, m.
inline Lever lever(const elementary::SinCos& of_tilt, double u, double w) {
  return {u * of_tilt.cosine + w * of_tilt.sine, w * of_tilt.cosine - u * of_tilt.sine};
}
/// To the edge of this side.
inline Lever lever(const Block& block, Side side, const elementary::SinCos& of_tilt) {
  return lever(of_tilt, block.edge(side), -block.height);
}
inline Lever lever(const Block& block, Side side, double tilt) {
  return lever(block, side, elementary::sin_cos(tilt));
}

struct Motion {
  double x, z, x_velocity, z_velocity;  ///< m, m/s
};
/// Of the centre of gravity.
Motion centre_of_gravity(const Block& block, const State& state, const Turned& known = {});

/// The same motion with the reference of another mode.
State referred(const Block& block, const State& state, Mode mode, Side side);

/// m^2/s^2: of (v^2 + k^2 rate^2)/2 + g z, per mass, over that of the block at rest upright; the floor at
/// rest.
double energy(const Block& block, const State& state);

/// Standing on its base, or on the edge that the tilt (if none, the rate) is towards, which moves at
/// x_velocity. The reference is at x = 0.
State standing(double tilt = 0, double rate = 0, double x_velocity = 0);

/// After the floor's horizontal velocity jumped by this, m/s: the block stays behind.
State left_behind(const State& state, double jump);

}  // namespace topple::planar
