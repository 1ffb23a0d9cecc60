// What a block does next: from an event, or from the forces of an instant.
//
// Contact is plastic: what touches does not bounce. Where the floor's impulse (or force) that keeps a contact
// point in place lies within the cone of static friction, it stays; else it slips against kinetic friction.
//   edge on the floor     v+ = v + W j, w+ = 0, with Moreau's complementarity in the velocities after
//   base on the floor     the impulse keeps the base flat if its resultant lies within the base; else the
//                         block goes on about the edge beyond which that would lie. Without slip the rate is
//                         by angular momentum about the edge, times the restitution factor r and that of a
//                         sprung base (sprung_base.h), here one:
//                         th'+ = r (k^2 th' + h vx + u vz)/(k^2 + h^2 + u^2), v of the centre of gravity
//                         (Housner: r (k^2 + h^2 - l r)/(k^2 + h^2 + u^2) th')
// A slip that would press the edge on the floor ever harder (Painleve: 1 + X E/k^2, equations.h, not above
// k_jam) stops at once, by the impulse that keeps the edge in place.
#pragma once

#include <string_view>

#include "solver/planar/block.h"

namespace topple::planar {

enum class Event {
  none,
  uplift,    ///< leaves its base for an edge
  slip,      ///< begins to
  stick,     ///< stops to slip
  reversal,  ///< the slip changes its direction
  take_off,  ///< leaves the floor
  landing,   ///< an edge reaches the floor
  impact,    ///< the base reaches the floor
  settled,   ///< an impact that ends the rocking
  jam,       ///< a slip stops at once
  overturn,  ///< the tilt reaches the last one asked for
  stalled    ///< events without progress: the run cannot go on
};
std::string_view word(Event event);

/// An infinite sequence of impacts is cut when the next rise, the floor's acceleration held, stays below this
/// tilt d, and the block would stay on its base. With the acceleration q that brings it back and the ratio e
/// of rates at an impact, what is left out is a tilt of d and a rate of sqrt(2 q d), during
/// sqrt(8 d/q)/(1 - e); a slip slower than that rate times the radius of gyration about the edge ends too.
inline constexpr double k_settled = 1e-14;  // rad
inline constexpr double k_jam = 1e-3;

/// A block and what acts on it at an instant.
struct Situation {
  const Block& block;
  double horizontal;  ///< acceleration of the floor, m/s^2
  double vertical;    ///< gravity plus acceleration of the floor, m/s^2
  double growth = 0;  ///< of `horizontal`, m/s^3
  Turned known = {};  ///< of the state's tilt, where that has been asked for before

  Lever lever(Side side, double tilt) const { return planar::lever(block, side, known.at(tilt)); }
};

/// Forces of the floor on an edge per mass, and the angular acceleration, rad/s^2.
struct EdgeForces {
  double tangential, normal;  ///< m/s^2
  double acceleration;
};
/// slip: sign of the velocity; 0: the edge stays.
EdgeForces edge_forces(const Situation& now, const State& state, int slip);

/// The mode that follows from the forces of this instant.
State decided(const Situation& now, const State& state);

/// The restitution factor up to which no impact of a rocking block without slip gains energy,
///   sqrt((k^2 + h^2 + l^2)(k^2 + h^2 + r^2))/(k^2 + h^2 - l r);
/// on a sprung base over the factor of a landing from half of the critical angle; infinite where Housner's
/// condition lets none rock on. With a factor above 1 another impact, after a flight or with slip, that would
/// gain energy by it is Housner's.
double greatest_restitution(const Block& block);

/// What follows an event. `side`: the edge concerned.
State lifted(const Situation& now, const State& state, Side side);
State slipping_base(const Situation& now, const State& state, Side side);
State stopped_base(const Situation& now, const State& state, Side side);
State slipping_edge(const Situation& now, const State& state, Side side);
State stopped_edge(const Situation& now, const State& state, Side side);
State taken_off(const Situation& now, const State& state, Side side);
State landed(const Situation& now, const State& state, Side side);
State fallen_on_base(const Situation& now, const State& state, Side side);
State jammed(const Situation& now, const State& state, Side side);
State unchanged(const Situation& now, const State& state, Side side);

}  // namespace topple::planar
