#include "solver/planar/mode.h"

#include "solver/model/table.h"

namespace topple::planar {
namespace {

/// a x + b y
const Series<double>* combination(Guards& guards, int place, double a, const Series<double>& x, double b,
                                  const Series<double>& y) {
  Series<double>& sum = guards.combined[static_cast<std::size_t>(place)];
  sum.degree = std::max(x.degree, y.degree);
  for (int i = 0; i <= sum.degree; ++i) sum[i] = a * x.or_zero(i) + b * y.or_zero(i);
  return &sum;
}

double sign_of(Side side) {
  return side == Side::right ? 1 : -1;
}

void guard_rest(const GuardedMotion& of, Guards& guards) {
  const Block& block = of.block;
  const Series<double>&a = of.solution.horizontal, &g = of.solution.vertical;
  guards.add({&g, 1, 0, Event::take_off, Side::right, taken_off});
  guards.add(
      {combination(guards, 0, block.height, a, block.right, g), 1, 0, Event::uplift, Side::right, lifted});
  guards.add(
      {combination(guards, 1, -block.height, a, block.left, g), 1, 0, Event::uplift, Side::left, lifted});
  for (const int way : {0, 1})
    guards.add({combination(guards, 2 + way, way == 0 ? 1 : -1, a, block.static_friction, g), 1, 0,
                Event::slip, Side::right, slipping_base});
}

void guard_slide(const GuardedMotion& of, Guards& guards) {
  const double slip = of.start.slip;
  guards.add({&of.solution.vertical, 1, 0, Event::take_off, Side::right, taken_off});
  guards.add({&of.solution.x_velocity, slip, 0, Event::stick, Side::right, stopped_base});
}

void guard_tilt(const GuardedMotion& of, Guards& guards) {
  const Side side = of.start.side;
  const double sign = sign_of(side);
  guards.add({&of.solution.tilt, sign, 0, Event::impact, side, fallen_on_base});
  guards.add({&of.solution.tilt, -sign, of.last_tilt, Event::overturn, side, unchanged});
}

void guard_rock(const GuardedMotion& of, Guards& guards) {
  guard_tilt(of, guards);
  for (const int way : {0, 1})
    guards.add({combination(guards, way, way == 0 ? 1 : -1, of.solution.tangential, of.block.static_friction,
                            of.solution.normal),
                1, 0, Event::slip, of.start.side, slipping_edge});
}

void guard_slide_rock(const GuardedMotion& of, Guards& guards) {
  const Side side = of.start.side;
  guards.add({&of.solution.normal, 1, 0, Event::take_off, side, taken_off});
  guard_tilt(of, guards);
  guards.add({&of.solution.x_velocity, double(of.start.slip), 0, Event::stick, side, stopped_edge});
  guards.add({&of.solution.denominator, 1, -k_jam, Event::jam, side, jammed});
}

void guard_flight(const GuardedMotion& of, Guards& guards) {
  const Solution<double>& s = of.solution;
  int place = 0;
  for (const Side side : {Side::left, Side::right}) {  // z - u sin th - h cos th
    Series<double>& gap = guards.combined[static_cast<std::size_t>(place++)];
    gap.degree = std::max(s.z.degree, s.lever_x.degree);
    for (int i = 0; i <= gap.degree; ++i)
      gap[i] = s.z.or_zero(i) +
               (-of.block.height * s.lever_x.or_zero(i) - of.block.edge(side) * s.lever_z.or_zero(i));
    guards.add({&gap, 1, 0, Event::landing, side, landed});
  }
  for (const Side side : {Side::left, Side::right})
    guards.add({&s.tilt, -sign_of(side), of.last_tilt, Event::overturn, side, unchanged});
}

constexpr ModeTraits k_modes[] = {
    {Mode::rest, "rest", resting, guard_rest},
    {Mode::slide, "slide", sliding, guard_slide},
    {Mode::rock, "rock", rocking, guard_rock},
    {Mode::slide_rock, "slide-rock", slide_rocking, guard_slide_rock},
    {Mode::flight, "flight", flying, guard_flight},
};

}  // namespace

std::span<const ModeTraits> modes() {
  return k_modes;
}

const ModeTraits& traits(Mode mode) {
  return row_of(k_modes, mode);
}

}  // namespace topple::planar
