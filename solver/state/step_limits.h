// Limits on the steps of an adaptive run.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact/contact_law.h"
#include "solver/math/types.h"

namespace topple {

inline constexpr double k_least_step = 1e-8;    ///< s, a run that needs shorter steps ends
inline constexpr double k_longest_step = 0.05;  ///< s
inline constexpr double k_first_step = 1e-4;    ///< s, tried first
inline constexpr double k_contact_part = 20;    ///< steps per period of a body on its contacts
inline constexpr double k_quiet_steps = 5;      ///< times as long is a step while it hardly bounces
inline constexpr double k_closing_part = 4;     ///< steps in which a closing contact moves by its L
inline constexpr double k_turn = 0.1;           ///< rad per step
/// rad, of a contact's bounce, in the first implicit substep after a touch.
inline constexpr double k_resolved_bounce = 0.3;

/// Longest step that does not miss a contact closing, s: the time to touch, or, if longer, that in which it
/// closes by L/k_closing_part; infinite where it does not touch within k_longest_step.
///   max(gap/v, L/(k_closing_part v))
/// gap, L: m; closing: v, m/s.
inline double closing_limit(double gap, double closing, double L) {
  return closing * k_longest_step > gap ? std::max(gap / closing, L / (k_closing_part * closing))
                                        : std::numeric_limits<double>::infinity();
}

/// A part of the period of a mass (kg) on springs (stiffness: N/m), s: 2 pi sqrt(m/k)/k_contact_part;
/// infinite without springs.
inline double bounce_limit(double mass, double stiffness) {
  return stiffness > 0 ? 2 * k_pi * std::sqrt(mass / stiffness) / k_contact_part
                       : std::numeric_limits<double>::infinity();
}

/// How one contact bounds a step: open, by the time that closing_limit leaves; closed, by the stiffness on
/// which its bodies bounce (bounce_limit).
struct ContactAhead {
  double limit;      ///< s; infinite when it is closed
  double stiffness;  ///< N/m; 0 when it is open
};
/// gap: m, < 0 when it is closed. closing: m/s.
inline ContactAhead contact_ahead(const ContactLaw& law, double gap, double closing, double L) {
  if (gap < 0) return {std::numeric_limits<double>::infinity(), penalty_stiffness(law, -gap / L, L)};
  return {closing_limit(gap, closing, L), 0};
}

}  // namespace topple
