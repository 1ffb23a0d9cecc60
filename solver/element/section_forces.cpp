#include "solver/element/section_forces.h"

#include <algorithm>
#include <cmath>

namespace topple {

SectionForces section_forces(const Element& element, const BeamStrain& elastic) {
  return {element.normal_stiffness.cwiseProduct(elastic.gamma),
          element.bending_stiffness.cwiseProduct(elastic.kappa)};
}

double section_energy(const Element& element, const SectionForces& forces) {
  return element.length / 2 *
         (forces.normal.cwiseAbs2().cwiseQuotient(element.normal_stiffness).sum() +
          forces.moment.cwiseAbs2().cwiseQuotient(element.bending_stiffness).sum());
}

double equivalent_stress(const Section& section, const SectionForces& forces) {
  const double normal = std::abs(forces.normal.x()) / section.area +
                        std::abs(forces.moment.y()) * section.fibre_z() / section.iy +
                        std::abs(forces.moment.z()) * section.fibre_y() / section.iz;
  const double shear =
      std::abs(forces.moment.x()) * std::max(section.fibre_y(), section.fibre_z()) / section.j;
  return std::sqrt(normal * normal + 3 * shear * shear);
}

}  // namespace topple
