#include "solver/planar/transition.h"

#include <array>
#include <cmath>
#include <limits>

#include "solver/planar/sprung_base.h"

namespace topple::planar {
namespace {

constexpr double k_rounding = 1e-12;  // relative, of an energy

int sign(double a) {
  return (a > 0) - (a < 0);
}
int towards(Side side) {
  return side == Side::right ? 1 : -1;
}

/// On the floor, at rest there or slipping.
State touching(const Block& block, const State& state, Mode mode, Side side, int slip) {
  State to = referred(block, state, mode, side);
  to.z = to.z_velocity = 0;
  to.slip = slip;
  if (slip == 0) to.x_velocity = 0;
  return to;
}

State flat(const Block& block, const State& state, int slip) {
  State to = touching(block, state, slip == 0 ? Mode::rest : Mode::slide, state.side, slip);
  to.tilt = to.rate = 0;
  return to;
}

double slipping_denominator(const Block& block, const Lever& r, int slip) {
  return 1 + r.x * (r.x + block.kinetic_friction * slip * r.z) / block.inertia_over_mass();
}

State slip_on_edge(const Situation& now, const State& state, Side side, int slip) {
  const Lever r = now.lever(side, state.tilt);
  State to = touching(now.block, state, Mode::slide_rock, side, slip);
  if (slipping_denominator(now.block, r, slip) <= k_jam) return jammed(now, to, side);
  if (now.vertical + r.z * state.rate * state.rate <= 0) return taken_off(now, to, side);
  return to;
}

State slip_on_base(const Situation& now, const State& state, int slip) {
  const Block& block = now.block;
  const double place = block.kinetic_friction * slip * block.height;  // of the pressure
  if (place > block.right) return slip_on_edge(now, state, Side::right, slip);
  if (place < -block.left) return slip_on_edge(now, state, Side::left, slip);
  return flat(block, state, slip);
}

State decided_on_base(const Situation& now, const State& state) {
  const Block& block = now.block;
  if (now.vertical <= 0) return taken_off(now, state, state.side);
  if (state.slip != 0) return slip_on_base(now, state, state.slip);
  if (block.static_friction == 0)
    return slip_on_base(now, state, 1);  // nothing holds it: either sign will do
  const double moment = block.height * now.horizontal;
  if (-moment > block.right * now.vertical) return lifted(now, state, Side::right);
  if (moment > block.left * now.vertical) return lifted(now, state, Side::left);
  if (std::abs(now.horizontal) > block.static_friction * now.vertical)
    return slip_on_base(now, state, -sign(now.horizontal));
  return flat(block, state, 0);
}

bool in_static_cone(const Block& block, double tangential, double normal) {
  return normal > 0 && std::abs(tangential) <= block.static_friction * normal;
}

State decided_on_edge(const Situation& now, const State& state, Side side) {
  if (state.slip != 0) return slip_on_edge(now, state, side, state.slip);
  const State still = touching(now.block, state, Mode::rock, side, 0);
  const EdgeForces f = edge_forces(now, still, 0);
  return in_static_cone(now.block, f.tangential, f.normal) ? still : slipping_edge(now, still, side);
}

struct AfterImpact {
  double x_velocity = 0, z_velocity = 0, rate = 0;  ///< of the centre of gravity
  int slip = 0;
};

/// The first of the two directions of slip that is still one after the impact, else none.
template <class Try>
AfterImpact slipped(int first, const Try& after, const AfterImpact& stuck) {
  for (const int slip : {first, -first}) {
    AfterImpact out;
    if (slip != 0 && after(slip, out)) {
      out.slip = slip;
      return out;
    }
  }
  return stuck;
}

/// An edge that reaches the floor, or jams there.
AfterImpact impact_of_edge(const Block& block, const State& state, Side side) {
  const Lever r = lever(block, side, state.tilt);
  const Motion v = centre_of_gravity(block, state);
  const double k2 = block.inertia_over_mass();
  const double slip_before = v.x_velocity + r.z * state.rate, fall = v.z_velocity - r.x * state.rate;
  const double xx = 1 + r.x * r.x / k2, zz = 1 + r.z * r.z / k2, xz = -r.x * r.z / k2;
  const double determinant = 1 + (r.x * r.x + r.z * r.z) / k2;
  const auto struck = [&](double tangential, double normal) {
    return AfterImpact{v.x_velocity + tangential, v.z_velocity + normal,
                       state.rate + (r.z * tangential - r.x * normal) / k2, 0};
  };
  const double tangential = (xz * fall - xx * slip_before) / determinant,
               normal = (xz * slip_before - zz * fall) / determinant;
  const AfterImpact stuck = struck(tangential, normal);
  if (in_static_cone(block, tangential, normal)) return stuck;
  const auto after = [&](int slip, AfterImpact& out) {
    const double denominator = slipping_denominator(block, r, slip);
    const double push = -fall / denominator, drag = -block.kinetic_friction * slip * push;
    out = struck(drag, push);
    return denominator > k_jam && slip * (slip_before + zz * drag + xz * push) > 0;
  };
  return slipped(slip_before != 0 ? sign(slip_before) : -sign(tangential), after, stuck);
}

/// The base, upright; v: of the centre of gravity. The block goes on about this edge.
AfterImpact impact_about_edge(const Block& block, const Motion& v, double rate, Side side,
                              double restitution) {
  const double k2 = block.inertia_over_mass(), u = block.edge(side), h = block.height;
  const auto about_edge = [&](double after) { return AfterImpact{h * after, u * after, after, 0}; };
  const AfterImpact stuck =
      about_edge(restitution * (k2 * rate + h * v.x_velocity + u * v.z_velocity) / (k2 + h * h + u * u));
  const double tangential = stuck.x_velocity - v.x_velocity;
  if (in_static_cone(block, tangential, stuck.z_velocity - v.z_velocity)) return stuck;
  const auto after = [&](int slip, AfterImpact& out) {
    const double friction = block.kinetic_friction * slip, denominator = 1 + u * (u - friction * h) / k2;
    const double push = (u * rate - v.z_velocity) / denominator;
    out = about_edge(restitution * (rate + (friction * h - u) * push / k2));
    out.x_velocity = v.x_velocity - friction * (out.z_velocity - v.z_velocity);
    return denominator > k_jam && slip * (out.x_velocity - h * out.rate) > 0;
  };
  const double slip_before = v.x_velocity - h * rate;
  return slipped(slip_before != 0 ? sign(slip_before) : -sign(tangential), after, stuck);
}

AfterImpact impact_about_edge(const Block& block, const Motion& v, double rate, Side side) {
  const auto energy = [&](double x_velocity, double z_velocity, double turn) {
    return x_velocity * x_velocity + z_velocity * z_velocity + block.inertia_over_mass() * turn * turn;
  };
  const double most = energy(v.x_velocity, v.z_velocity, rate) * (1 + k_rounding),
               landing = block.sprung ? block.sprung->landing_factor(block, side, rate) : 1;
  for (const double factor : {block.restitution * landing, landing}) {
    const AfterImpact out = impact_about_edge(block, v, rate, side, factor);
    if (factor <= 1 || energy(out.x_velocity, out.z_velocity, out.rate) <= most) return out;
  }
  return impact_about_edge(block, v, rate, side, 1);
}

/// The state in which the centre of gravity moves so, an edge on the floor.
State after_impact(const Block& block, const State& state, Side side, const AfterImpact& after) {
  State to = referred(block, state, Mode::flight, side);
  to.x_velocity = after.x_velocity, to.z_velocity = after.z_velocity, to.rate = after.rate;
  return touching(block, to, after.slip == 0 ? Mode::rock : Mode::slide_rock, side, after.slip);
}

/// On its base again, where the rocking that an impact leaves is too small to follow.
State settled(const Situation& now, const State& state) {
  const double radius2 = now.block.inertia_over_mass() + now.block.height * now.block.height +
                         now.block.edge(state.side) * now.block.edge(state.side);
  const auto is_small = [&](int slip) {
    const double back = -towards(state.side) * edge_forces(now, state, slip).acceleration;
    return state.rate * state.rate < 2 * k_settled * back &&
           (slip != 0 || state.x_velocity * state.x_velocity < 2 * k_settled * back * radius2);
  };
  for (const int slip : {0, state.slip}) {
    if (is_small(slip)) {
      State of = referred(now.block, state, Mode::flight, state.side);
      of.slip = slip, of.rate = 0;
      const State base = decided_on_base(now, flat(now.block, of, slip));
      if (base.mode == Mode::rest || base.mode == Mode::slide) return base;
    }
    if (state.slip == 0) break;
  }
  return state;
}

}  // namespace

std::string_view word(Event event) {
  constexpr std::array<std::string_view, 12> words{"none",     "uplift",   "slip",     "stick",
                                                   "reversal", "take-off", "landing",  "impact",
                                                   "settled",  "jam",      "overturn", "stalled"};
  return words[static_cast<std::size_t>(event)];
}

double greatest_restitution(const Block& block) {
  const double about_centre = block.inertia_over_mass() + block.height * block.height,
               kept = about_centre - block.left * block.right;
  if (!(kept > 0)) return std::numeric_limits<double>::infinity();
  const auto about = [&](double u) { return about_centre + u * u; };
  double landing = 1;
  if (block.sprung)
    for (const Side side : {Side::left, Side::right}) {
      const double from = block.edge(other(side));
      const double rate = std::sqrt(0.75 * block.gravity / (block.height * about(from))) * std::abs(from);
      landing = std::max(landing, block.sprung->landing_factor(block, side, rate));
    }
  return std::sqrt(about(block.left) * about(block.right)) / (kept * landing);
}

EdgeForces edge_forces(const Situation& now, const State& state, int slip) {
  const Lever r = now.lever(state.side, state.tilt);
  const double k2 = now.block.inertia_over_mass(), spin = state.rate * state.rate;
  if (slip != 0) {
    const double friction = now.block.kinetic_friction * slip;
    const double denominator = slipping_denominator(now.block, r, slip);
    const double normal = (now.vertical + r.z * spin) / denominator;
    return {-friction * normal, normal, -(r.x + friction * r.z) * normal / k2};
  }
  const double turn = (r.z * now.horizontal - r.x * now.vertical) / (k2 + r.x * r.x + r.z * r.z);
  return {now.horizontal + r.x * spin - r.z * turn, now.vertical + r.z * spin + r.x * turn, turn};
}

State decided(const Situation& now, const State& state) {
  State to = state;
  if (state.mode == Mode::rest || state.mode == Mode::slide)
    to = decided_on_base(now, state);
  else if (state.mode != Mode::flight)
    to = decided_on_edge(now, state, state.side);
  to.undecided = false;
  return to;
}

State lifted(const Situation& now, const State& state, Side side) {
  State still = touching(now.block, state, Mode::rock, side, 0);
  const EdgeForces f = edge_forces(now, still, 0);
  if (!in_static_cone(now.block, f.tangential, f.normal))
    return slip_on_base(now, state, -sign(f.tangential));
  const SprungBase* const base = now.block.sprung.get();
  if (base)
    still.rate = towards(side) * base->lift_rate(now.block, side, now.horizontal, now.growth, now.vertical);
  return still;
}

State slipping_base(const Situation& now, const State& state, Side) {
  return slip_on_base(now, state, -sign(now.horizontal));
}

State stopped_base(const Situation& now, const State& state, Side) {
  if (now.block.static_friction == 0) return slip_on_base(now, state, -state.slip);
  return decided_on_base(now, flat(now.block, state, 0));
}

State slipping_edge(const Situation& now, const State& state, Side side) {
  const EdgeForces stay = edge_forces(now, state, 0);
  const Lever r = now.lever(side, state.tilt);
  const double spin = state.rate * state.rate;
  if (now.vertical + r.z * spin <= 0) return taken_off(now, state, side);
  const int slip = stay.normal > 0 ? -sign(stay.tangential) : -sign(now.horizontal + r.x * spin);
  if (slipping_denominator(now.block, r, slip) <= k_jam) return taken_off(now, state, side);
  return touching(now.block, state, Mode::slide_rock, side, slip == 0 ? 1 : slip);
}

State stopped_edge(const Situation& now, const State& state, Side side) {
  return decided_on_edge(now, touching(now.block, state, Mode::rock, side, 0), side);
}

State taken_off(const Situation& now, const State& state, Side side) {
  State to = referred(now.block, state, Mode::flight, side);
  to.slip = 0;
  return to;
}

State landed(const Situation& now, const State& state, Side side) {
  if (state.tilt == 0) return fallen_on_base(now, state, side);
  return decided_on_edge(now, after_impact(now.block, state, side, impact_of_edge(now.block, state, side)),
                         side);
}

State fallen_on_base(const Situation& now, const State& state, Side side) {
  State upright = state;
  upright.tilt = 0;
  const Block& block = now.block;
  const Motion v = centre_of_gravity(block, upright);
  const double push = -v.z_velocity;
  const int slip = std::abs(v.x_velocity) <= block.static_friction * push ? 0 : sign(v.x_velocity);
  const double drag = slip == 0 ? -v.x_velocity : -slip * block.kinetic_friction * push;
  Side about = state.mode == Mode::flight ? side : other(side);
  if (push > 0) {
    const double place = (block.inertia_over_mass() * state.rate - block.height * drag) / push;
    if (place >= -block.left && place <= block.right) {
      State base = referred(block, upright, Mode::flight, side);
      base.x_velocity += drag;
      base.rate = 0;
      return decided_on_base(now, flat(block, base, slip));
    }
    about = place > block.right ? Side::right : Side::left;
  }
  const State after = after_impact(block, upright, about, impact_about_edge(block, v, state.rate, about));
  if (after.rate * towards(about) <= 0) return decided_on_base(now, flat(block, after, after.slip));
  return settled(now, decided_on_edge(now, after, about));
}

State jammed(const Situation& now, const State& state, Side side) {
  return decided_on_edge(now, after_impact(now.block, state, side, impact_of_edge(now.block, state, side)),
                         side);
}

State unchanged(const Situation&, const State& state, Side) {
  return state;
}

}  // namespace topple::planar
