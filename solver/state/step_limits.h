// What the steps of an adaptive run are held to.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/types.h"

namespace topple {

inline constexpr double k_least_step = 1e-8;    ///< s, shorter steps are given up
inline constexpr double k_longest_step = 0.05;  ///< s
inline constexpr double k_first_step = 1e-4;    ///< s, tried first
inline constexpr double k_contact_part = 20;    ///< steps per period of a body on its contacts
inline constexpr double k_closing_part = 4;     ///< steps in which a closing contact crosses its width
inline constexpr double k_turn = 0.1;           ///< rad per step

/// Longest step that sees a contact close, s: the time to touch, or that in which the contact crosses a part
/// of its width; infinite where it does not touch within k_longest_step.
///   max(gap/v, L/(k_closing_part v))
/// gap, L: m. closing: v, m/s.
inline double closing_limit(double gap, double closing, double L) {
  return closing * k_longest_step > gap ? std::max(gap / closing, L / (k_closing_part * closing))
                                        : std::numeric_limits<double>::infinity();
}

/// A part of the period of a mass on springs, s: 2 pi sqrt(m/k)/k_contact_part; infinite without springs.
inline double bounce_limit(double mass, double stiffness) {
  return stiffness > 0 ? 2 * k_pi * std::sqrt(mass / stiffness) / k_contact_part
                       : std::numeric_limits<double>::infinity();
}

}  // namespace topple
