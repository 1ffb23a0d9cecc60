#include "solver/planar/mode.h"

#include "solver/model/table.h"

namespace topple::planar {
namespace {

/// What there is one of per block of a pack: value(block), ...
template <class P, class Value>
P of_blocks(const GuardedMotion<P>& of, const Value& value) {
  return pack_of<P>([&](int k) { return value(*of_lane(of.block, k)); });
}

/// a x + b y
template <class P>
const Series<P>* combination(Guards<P>& guards, int place, P a, const Series<P>& x, P b, const Series<P>& y) {
  Series<P>& sum = guards.combined[static_cast<std::size_t>(place)];
  const int degree = std::max(x.degree, y.degree);
  for (int i = 0; i <= degree; ++i) sum[i] = a * x.or_zero(i) + b * y.or_zero(i);
  sum.end(degree, choose(x.last() < y.last(), y.last(), x.last()));
  return &sum;
}

double sign_of(Side side) {
  return side == Side::right ? 1 : -1;
}

template <class P>
PerLane<P, Side> everywhere(Side side) {
  return per_lane<P>([&](int) { return side; });
}
template <class P>
PerLane<P, Side> sides(const GuardedMotion<P>& of) {
  return per_lane<P>([&](int k) { return of_lane(of.start, k).side; });
}

template <class P>
void guard_rest(const GuardedMotion<P>& of, Guards<P>& guards) {
  const P height = of_blocks(of, [](const Block&block) { return block.height; }),
          left = of_blocks(of, [](const Block&block) { return block.left; }),
          right = of_blocks(of, [](const Block&block) { return block.right; }),
          friction = of_blocks(of, [](const Block&block) { return block.static_friction; });
  const Series<P>&a = of.solution.horizontal, &g = of.solution.vertical;
  const P one(1), zero(0);
  guards.add({&g, one, zero, Event::take_off, everywhere<P>(Side::right), taken_off});
  guards.add({combination(guards, 0, height, a, right, g), one, zero, Event::uplift,
              everywhere<P>(Side::right), lifted});
  guards.add({combination(guards, 1, -height, a, left, g), one, zero, Event::uplift,
              everywhere<P>(Side::left), lifted});
  for (const int way : {0, 1})
    guards.add({combination(guards, 2 + way, P(way == 0 ? 1 : -1), a, friction, g), one, zero, Event::slip,
                everywhere<P>(Side::right), slipping_base});
}

template <class P>
P slips(const GuardedMotion<P>& of) {
  return pack_of<P>([&](int k) { return of_lane(of.start, k).slip; });
}

template <class P>
void guard_slide(const GuardedMotion<P>& of, Guards<P>& guards) {
  guards.add({&of.solution.vertical, P(1), P(0), Event::take_off, everywhere<P>(Side::right), taken_off});
  guards.add(
      {&of.solution.x_velocity, slips(of), P(0), Event::stick, everywhere<P>(Side::right), stopped_base});
}

template <class P>
void guard_tilt(const GuardedMotion<P>& of, Guards<P>& guards) {
  const PerLane<P, Side> side = sides(of);
  const P sign = pack_of<P>([&](int k) { return sign_of(of_lane(side, k)); });
  guards.add({&of.solution.tilt, sign, P(0), Event::impact, side, fallen_on_base});
  guards.add({&of.solution.tilt, -sign, of.last_tilt, Event::overturn, side, unchanged});
}

template <class P>
void guard_rock(const GuardedMotion<P>& of, Guards<P>& guards) {
  guard_tilt(of, guards);
  const P friction = of_blocks(of, [](const Block& block) { return block.static_friction; });
  for (const int way : {0, 1})
    guards.add(
        {combination(guards, way, P(way == 0 ? 1 : -1), of.solution.tangential, friction, of.solution.normal),
         P(1), P(0), Event::slip, sides(of), slipping_edge});
}

template <class P>
void guard_slide_rock(const GuardedMotion<P>& of, Guards<P>& guards) {
  const PerLane<P, Side> side = sides(of);
  guards.add({&of.solution.normal, P(1), P(0), Event::take_off, side, taken_off});
  guard_tilt(of, guards);
  guards.add({&of.solution.x_velocity, slips(of), P(0), Event::stick, side, stopped_edge});
  guards.add({&of.solution.denominator, P(1), P(-k_jam), Event::jam, side, jammed});
}

template <class P>
void guard_flight(const GuardedMotion<P>& of, Guards<P>& guards) {
  const Solution<P>& s = of.solution;
  const P height = of_blocks(of, [](const Block& block) { return block.height; });
  int place = 0;
  for (const Side side : {Side::left, Side::right}) {  // z - u sin th - h cos th
    const P edge = of_blocks(of, [&](const Block& block) { return block.edge(side); });
    Series<P>& gap = guards.combined[static_cast<std::size_t>(place++)];
    const int degree = std::max(s.z.degree, s.lever_x.degree);
    for (int i = 0; i <= degree; ++i)
      gap[i] = s.z.or_zero(i) + (-height * s.lever_x.or_zero(i) - edge * s.lever_z.or_zero(i));
    gap.end(degree, choose(s.z.last() < s.lever_x.last(), s.lever_x.last(), s.z.last()));
    guards.add({&gap, P(1), P(0), Event::landing, everywhere<P>(side), landed});
  }
  for (const Side side : {Side::left, Side::right})
    guards.add({&s.tilt, P(-sign_of(side)), of.last_tilt, Event::overturn, everywhere<P>(side), unchanged});
}

template <class P>
constexpr ModeTraits<P> k_modes[] = {
    {Mode::rest, resting, guard_rest},    {Mode::slide, sliding, guard_slide},
    {Mode::rock, rocking, guard_rock},    {Mode::slide_rock, slide_rocking, guard_slide_rock},
    {Mode::flight, flying, guard_flight},
};

}  // namespace

template <class P>
const ModeTraits<P>& traits(Mode mode) {
  return row_of(k_modes<P>, mode);
}
template const ModeTraits<double>& traits(Mode);
template const ModeTraits<Four>& traits(Mode);

}  // namespace topple::planar
