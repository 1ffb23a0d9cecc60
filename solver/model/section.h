// Cross-sections and materials of members.
#pragma once

#include <span>
#include <string>

#include "solver/model/table.h"

namespace topple {

/// Linear elastic, perfectly plastic material.
struct Material {
  std::string name;
  double young = 0;            ///< Pa
  double poisson = 0;          ///< -
  double density = 0;          ///< kg/m^3
  double yield = 0;            ///< Pa; 0: elastic
  double fracture_strain = 0;  ///< -; 0: never breaks
};

/// Cross-section in the local y-z plane of a member. `size = [a, b]` runs along y and z.
struct Section {
  enum class Shape { box, solid, pipe, custom };
  std::string name;
  Shape shape = Shape::box;
  double size_y = 0;     ///< m, outer; pipe: diameter
  double size_z = 0;     ///< m, outer; pipe: diameter
  double thickness = 0;  ///< m, wall; box and pipe
  double area = 0;       ///< m^2
  double iy = 0;         ///< m^4, second moment of area for bending in the local x-z plane
  double iz = 0;         ///< m^4, likewise in the local x-y plane
  double j = 0;          ///< m^4, torsion constant
  double ky = 0;         ///< -, shear coefficient in y
  double kz = 0;         ///< -, shear coefficient in z
  double zy = 0;         ///< m^3, plastic modulus of bending in the local x-z plane
  double zz = 0;         ///< m^3, likewise in the local x-y plane
  double zt = 0;         ///< m^3, plastic modulus of torsion: Mx0 = zt yield / sqrt(3)
  double width = 0;      ///< m, contact width: the L of Eq. 2 is the mean of two of these

  /// Distances of the extreme fibres from the centre line, m.
  double fibre_y() const { return size_y / 2; }
  double fibre_z() const { return size_z / 2; }
};

/// A shape of section. A new one is a Section::Shape and a row of the table in section.cpp.
struct SectionTraits {
  Section::Shape kind;
  const char* word;  ///< in scenes
  bool is_round;     ///< size_y is the diameter, size_z as well
  bool has_wall;     ///< uses thickness
  /// complete_section() but for the width; null: all numbers are given.
  void (*complete)(Section&, double poisson);
};
std::span<const SectionTraits> section_shapes();
inline const SectionTraits& traits(Section::Shape shape) {
  return row_of(section_shapes(), shape);
}

/// Fills area, iy, iz, j, ky, kz, width from shape, sizes and thickness (thin-walled Bredt torsion for the
/// box, Saint-Venant series for the solid, shear coefficients after Cowper 1966; width: mean of the sizes),
/// and the plastic moduli zy, zz, zt (torsion: Bredt with the wall at yield; solid and pipe: Nadai's sand
/// heap). Sizes > 0; 0 < 2 thickness < smaller size. A custom section stays as it is.
void complete_section(Section& section, double poisson);

}  // namespace topple
