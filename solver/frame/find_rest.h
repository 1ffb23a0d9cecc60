// Rest by steps in pseudo time, of whatever has a stiffness and a mass.
#pragma once

#include <algorithm>
#include <optional>

namespace topple {

inline constexpr double k_balance = 1e-10;  ///< of the weight, greatest force left

/// What forces in balance are: rest; none, it tips over by itself; or something yields, and it goes on.
enum class Balance { rest, tips_over, yields };

/// How far a step has led, m.
struct RestStep {
  double length;    ///< of the step
  double furthest;  ///< from where it began
};

/// Newton with K + M/sigma^2 for a balance of forces; sigma grows while steps are short. False: nothing is
/// found, or it is no rest. `body` has:
///   double size            m
///   double balanced        N, what may be left
///   double unbalance()     N, what is left; finds forces and tangent
///   Balance look()         where they are in balance
///   optional<RestStep> step(sigma)    null: there is none
///   void follow()          takes the step: contacts go along
template <class Body>
bool find_rest(Body& body) {
  constexpr int k_most_rounds = 400;
  constexpr double k_first_sigma = 1e-3, k_last_sigma = 1e3;  // s
  constexpr double k_furthest = 0.25;                         // of the size: more is falling, not settling
  constexpr double k_short = 0.01;                            // of the size
  double sigma = k_first_sigma;
  for (int round = 0; round < k_most_rounds; ++round) {
    if (body.unbalance() < body.balanced && sigma > 1) {
      const Balance balance = body.look();
      if (balance != Balance::yields) return balance == Balance::rest;
      sigma = k_first_sigma;
      continue;
    }
    const std::optional<RestStep> step = body.step(sigma);
    if (!step || !(step->furthest <= k_furthest * body.size)) return false;
    body.follow();
    sigma =
        std::clamp(sigma * (step->length < k_short * body.size ? 2 : 0.5), k_first_sigma / 16, k_last_sigma);
  }
  return false;
}

}  // namespace topple
