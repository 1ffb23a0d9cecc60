// What happens at an element's stress point, and what an element remembers of it.
#pragma once

#include <cstdint>

#include "solver/math/types.h"

namespace topple {

/// Strains at the stress point r = -s (Eq. 1) in the frame of the integration point.
struct BeamStrain {
  Vec3 gamma;  ///< axial strain, shear strains along y and z, -
  Vec3 kappa;  ///< twist and curvatures about y and z, 1/m
};

/// Section forces of one element at its stress point r = -s, local axes.
struct SectionForces {
  Vec3 normal;  ///< N, Vy, Vz, N
  Vec3 moment;  ///< Mx, My, Mz, N m
};

/// Where an element has plastic hinges, at which its section flows (plasticity.h): at its ends, or in the
/// middle with the midpoint scheme. broken: it carries nothing. Recordings hold these numbers.
enum class Hinge : std::int32_t { none = 0, first = 1, second = 2, broken = 3, middle = 4, both = 7 };

/// Whether there is one at Element::hinge_place[place].
inline bool has_hinge(Hinge hinge, int place) {
  return hinge == Hinge::both ||
         (place == 0 ? hinge == Hinge::first || hinge == Hinge::middle : hinge == Hinge::second);
}

/// Part of State, one per element.
struct ElementState {
  Hinge hinge = Hinge::none;
  /// Bit k: Element::hinge_place[k] is held, it stays elastic; bit 2 + k: it was, and is let flow. Of statics
  /// while an equilibrium is sought (hold_joints); 0 in a State.
  std::int32_t held = 0;
  /// Strain at the elastic stress point at which the section forces vanish: what flowed so far.
  BeamStrain offset{Vec3::Zero(), Vec3::Zero()};
};

}  // namespace topple
