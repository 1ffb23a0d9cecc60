// Rest by pseudo-transient continuation (steps in pseudo time), of whatever has a stiffness and a mass.
#pragma once

#include <algorithm>
#include <optional>

namespace topple {

inline constexpr double k_balance = 1e-10;  ///< greatest unbalanced force at rest over the weight

/// What a balance of forces is: stable; unstable: the body tips over; not yet final: a section breaks; none
/// was found.
enum class Balance { rest, tips_over, breaks, none };

/// Greatest displacement of a node, m.
struct RestStep {
  double length;    ///< by the step
  double furthest;  ///< since find_rest began
};

/// Newton's method with K + M/sigma^2 for a balance of forces; sigma, s, doubles after short steps and halves
/// after long ones. Returns rest, tips_over or none. `body` has:
///   double size            m
///   double balanced        N, greatest unbalanced force that counts as balance
///   double unbalance()     N, the unbalanced force; finds forces and tangent
///   Balance look()         judges a balance: rest, tips_over or breaks
///   optional<RestStep> step(sigma)    solves for a step; null: singular or not finite
///   void follow()          takes the step, stick springs included
template <class Body>
Balance find_rest(Body& body) {
  constexpr int k_most_rounds = 400;
  constexpr double k_first_sigma = 1e-3, k_last_sigma = 1e3;  // s
  constexpr double k_furthest = 0.25;                         // of the size: more is falling, not settling
  constexpr double k_short = 0.01;                            // of the size
  double sigma = k_first_sigma;
  for (int round = 0; round < k_most_rounds; ++round) {
    if (body.unbalance() < body.balanced && sigma > 1) {
      const Balance balance = body.look();
      if (balance != Balance::breaks) return balance;
      sigma = k_first_sigma;
      continue;
    }
    const std::optional<RestStep> step = body.step(sigma);
    if (!step || !(step->furthest <= k_furthest * body.size)) return Balance::none;
    body.follow();
    sigma =
        std::clamp(sigma * (step->length < k_short * body.size ? 2 : 0.5), k_first_sigma / 16, k_last_sigma);
  }
  return Balance::none;
}

}  // namespace topple
