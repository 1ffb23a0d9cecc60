// The modes of a block: their equations and the guards that end them.
#pragma once

#include <array>
#include <span>

#include "solver/planar/equations.h"
#include "solver/planar/transition.h"

namespace topple::planar {

/// sign * of + offset: the mode ends where it falls below zero.
template <class P>
struct Guard {
  const Series<P>* of;
  P sign, offset;
  Event event;
  PerLane<P, Side> side;
  State (*next)(const Situation&, const State&, Side);
};

/// Of one step. Of guards that fall together the first counts.
template <class P>
struct Guards {
  static constexpr int k_most = 5;
  std::array<Guard<P>, k_most> guard;
  int count = 0;
  std::array<Series<P>, 4> combined;  ///< series that guards point to

  void add(const Guard<P>& one) { guard[static_cast<std::size_t>(count++)] = one; }
};

/// Of blocks in the same mode.
template <class P>
struct GuardedMotion {
  const PerLane<P, const Block*>& block;
  const PerLane<P, State>& start;
  const Solution<P>& solution;
  P last_tilt;  ///< rad
};

/// A mode is an enumerator and a row of the table in mode.cpp.
template <class P>
struct ModeTraits {
  Mode kind;
  void (*solve)(const Coefficients<P>&, Solution<P>&, Truncation<P>&);
  void (*guard)(const GuardedMotion<P>&, Guards<P>&);
};
/// P: double or Four.
template <class P>
const ModeTraits<P>& traits(Mode mode);

}  // namespace topple::planar
