// What the floor does to a block: its forces at an instant, and where energy goes in a step.
#pragma once

#include "solver/planar/integrator.h"

namespace topple::planar {

/// Of the floor on a block, per mass.
struct FloorForces {
  double tangential = 0, normal = 0;  ///< m/s^2
  /// Share of the normal force on the right edge, the rest being on the left one: so the moments balance.
  double right = 0;
};
/// In the mode that follows from the forces of this instant where that is open.
FloorForces floor_forces(const Situation& now, const State& state);

/// J/kg, as EnergyLedger has them: input is the work of the floor's acceleration, impact what impacts and
/// jams dissipate.
struct Exchanged {
  double input = 0, gravity = 0, friction = 0, impact = 0;
};
/// Adds the newest step, from `before` to `after` its event. Works are integrals of products of its series.
void add_exchange(const Block& block, const State& before, const Step& step, const State& after, Event event,
                  Exchanged& sum);

/// J/kg, of motion.
double kinetic_energy(const Block& block, const State& state, const Turned& known = {});

}  // namespace topple::planar
