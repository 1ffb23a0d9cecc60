// Forces in the sections of members, and the stress that they make.
#pragma once

#include "solver/element/beam.h"
#include "solver/model/model.h"

namespace topple {

/// At an elastic strain.
SectionForces section_forces(const Element& element, const BeamStrain& elastic);

/// Those of the stress point r = -s at xi in -1..1 along the element, by equilibrium:
///   My(xi) = My(r) + Vz (L/2)(xi - r), Mz(xi) = Mz(r) - Vy (L/2)(xi - r).
SectionForces forces_along(const SectionForces& at_point, double length, double s, double xi);

/// Energy that an element holds under these forces at its stress point, J.
double section_energy(const Element& element, const SectionForces& forces);

/// Greatest equivalent stress of a section under these forces, Pa: extreme-fibre normal stress with torsional
/// shear after von Mises.
double equivalent_stress(const Section& section, const SectionForces& forces);

}  // namespace topple
