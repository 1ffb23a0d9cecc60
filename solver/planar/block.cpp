#include "solver/planar/block.h"

namespace topple::planar {
namespace {

bool on_edge(Mode mode) {
  return mode == Mode::rock || mode == Mode::slide_rock;
}

/// The reference of a mode, from the centre of gravity.
Lever reference(const Block& block, Mode mode, Side side, double tilt, const Turned& known = {}) {
  if (mode == Mode::flight) return {0, 0};
  const elementary::SinCos of = known.at(tilt);
  return on_edge(mode) ? lever(block, side, of) : lever(of, 0, -block.height);
}

bool same_reference(const State& state, Mode mode, Side side) {
  if (state.mode == Mode::flight || mode == Mode::flight) return state.mode == mode;
  return on_edge(mode) == on_edge(state.mode) && (!on_edge(mode) || side == state.side);
}

}  // namespace

Motion centre_of_gravity(const Block& block, const State& state, const Turned& known) {
  const Lever r = reference(block, state.mode, state.side, state.tilt, known);
  return {state.x - r.x, state.z - r.z, state.x_velocity - r.z * state.rate,
          state.z_velocity + r.x * state.rate};
}

State referred(const Block& block, const State& state, Mode mode, Side side) {
  State to = state;
  to.mode = mode, to.side = side;
  if (same_reference(state, mode, side)) return to;
  const Motion centre = centre_of_gravity(block, state);
  const Lever r = reference(block, mode, side, state.tilt);
  to.x = centre.x + r.x, to.z = centre.z + r.z;
  to.x_velocity = centre.x_velocity + r.z * state.rate;
  to.z_velocity = centre.z_velocity - r.x * state.rate;
  return to;
}

double energy(const Block& block, const State& state) {
  const Motion centre = centre_of_gravity(block, state);
  return (centre.x_velocity * centre.x_velocity + centre.z_velocity * centre.z_velocity +
          block.inertia_over_mass() * state.rate * state.rate) /
             2 +
         block.gravity * (centre.z - block.height);
}

State standing(double tilt, double rate, double x_velocity) {
  State state;
  state.tilt = tilt, state.rate = rate;
  const double towards = tilt != 0 ? tilt : rate;
  state.side = towards < 0 ? Side::left : Side::right;
  state.mode = towards != 0 ? Mode::rock : Mode::rest;
  return left_behind(state, -x_velocity);
}

State left_behind(const State& state, double jump) {
  State to = state;
  to.x_velocity -= jump;
  to.undecided = true;
  if (state.mode == Mode::flight) return to;
  to.slip = (to.x_velocity > 0) - (to.x_velocity < 0);
  const bool slips = to.slip != 0;
  if (on_edge(state.mode))
    to.mode = slips ? Mode::slide_rock : Mode::rock;
  else
    to.mode = slips ? Mode::slide : Mode::rest;
  return to;
}

}  // namespace topple::planar
