// Rest by pseudo-transient continuation (steps in pseudo time), of whatever has a stiffness and a mass.
#pragma once

#include <algorithm>
#include <optional>

#include "solver/state/step_result.h"

namespace topple {

inline constexpr double k_balance = 1e-10;  ///< greatest unbalanced force at rest over the weight

/// What a balance of forces is: stable; unstable: the body tips over; not yet final: a section breaks, or
/// what was held slips; there is none near the start, as the body leaves it; none was found.
enum class Balance { rest, tips_over, not_final, leaves, none };

/// Of a balance that is none of rest.
inline NoRest no_rest(Balance balance) {
  return balance == Balance::leaves      ? NoRest::leaves
         : balance == Balance::tips_over ? NoRest::tips_over
                                         : NoRest::not_found;
}

/// Greatest displacement of a node, m.
struct RestStep {
  double length;    ///< by the step
  double furthest;  ///< since find_rest began
};

/// Newton's method with K + M/sigma^2 for a balance of forces; sigma, s, doubles after steps below `most`, of
/// the size, and halves after longer ones. Where that leads to no rest in 100 rounds (contacts of q < 1 are
/// infinitely stiff as they close) it begins again and goes with what a step leaves (switched evolution
/// relaxation: Mulder and van Leer, 1985). Returns rest, tips_over, leaves or none. `body` has:
///   double size            m
///   double balanced        N, greatest unbalanced force that counts as balance
///   double unbalance()     N, the unbalanced force; finds forces and tangent
///   Balance look()         judges a balance: rest, tips_over or not_final
///   optional<RestStep> step(sigma)    solves for a step; null: singular or not finite
///   void follow()          takes the step, stick springs included
template <class Body>
Balance find_rest(Body& body, double most) {
  constexpr int k_most_rounds = 400, k_usual_rounds = 100;
  constexpr double k_first_sigma = 1e-3, k_last_sigma = 1e3;  // s
  constexpr double k_furthest = 0.25;                         // of the size: more is falling, not settling
  double sigma = k_first_sigma, left = 0;
  for (int round = 0; round < k_most_rounds; ++round) {
    const double before = left;
    left = body.unbalance();
    if (round == k_usual_rounds) sigma = k_first_sigma;
    if (left < body.balanced && sigma > 1) {
      const Balance balance = body.look();
      if (balance != Balance::not_final) return balance;
      sigma = k_first_sigma;
      continue;
    }
    const std::optional<RestStep> step = body.step(sigma);
    if (!step) return Balance::none;
    if (!(step->furthest <= k_furthest * body.size)) return Balance::leaves;
    body.follow();
    const bool shorter = step->length < most * body.size;
    const double factor = round <= k_usual_rounds || left < body.balanced
                              ? (shorter ? 2 : 0.5)
                              : std::clamp(before / left, 1. / 16, 2.);
    sigma = std::clamp(sigma * factor, k_first_sigma / 16, k_last_sigma);
  }
  return Balance::none;
}

}  // namespace topple
