// The modes of a block: their equations and the guards that end them.
#pragma once

#include <array>
#include <span>

#include "solver/planar/equations.h"
#include "solver/planar/transition.h"

namespace topple::planar {

/// sign * of + offset: the mode ends where it falls below zero.
struct Guard {
  const Series<double>* of;
  double sign, offset;
  Event event;
  Side side;
  State (*next)(const Situation&, const State&, Side);
};

/// Of one step. Of guards that fall together the first counts.
struct Guards {
  static constexpr int k_most = 5;
  std::array<Guard, k_most> guard;
  int count = 0;
  std::array<Series<double>, 4> combined;  ///< series that guards point to

  void add(const Guard& one) { guard[static_cast<std::size_t>(count++)] = one; }
};

struct GuardedMotion {
  const Block& block;
  const State& start;
  const Solution<double>& solution;
  double last_tilt;  ///< rad
};

/// A mode is an enumerator and a row of the table in mode.cpp.
struct ModeTraits {
  Mode kind;
  const char* word;
  void (*solve)(const Coefficients<double>&, Solution<double>&, Truncation&);
  void (*guard)(const GuardedMotion&, Guards&);
};
std::span<const ModeTraits> modes();
const ModeTraits& traits(Mode mode);

}  // namespace topple::planar
