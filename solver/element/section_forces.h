// Forces in the sections of members, and the stress that they make.
#pragma once

#include "solver/element/beam.h"
#include "solver/model/model.h"

namespace topple {

/// Section forces of an elastic strain: EA, kGAy, kGAz times gamma; GJ, EIy, EIz times kappa.
SectionForces section_forces(const Element& element, const BeamStrain& elastic);

/// Section forces at xi in -1..1 along the element from those at the stress point r = -s, by equilibrium:
///   My(xi) = My(r) + Vz (L/2)(xi - r), Mz(xi) = Mz(r) - Vy (L/2)(xi - r).
inline SectionForces forces_along(const SectionForces& at_point, double length, double s, double xi) {
  SectionForces out = at_point;
  const double arm = length / 2 * (xi + s);
  out.moment.y() += out.normal.z() * arm;
  out.moment.z() -= out.normal.y() * arm;
  return out;
}

/// Elastic energy of an element under these forces at its stress point, J.
double section_energy(const Element& element, const SectionForces& forces);

/// Equivalent stress of a section after von Mises, Pa: extreme-fibre normal stress with torsional shear.
///   sqrt(sigma^2 + 3 tau^2),  sigma = |N|/A + |My| cz/Iy + |Mz| cy/Iz,  tau = |Mx| max(cy, cz)/J,
/// cy, cz: fibre_y, fibre_z. Shear forces do not count, nor does yielding.
double equivalent_stress(const Section& section, const SectionForces& forces);

}  // namespace topple
