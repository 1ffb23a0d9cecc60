// What beams may be coloured by.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "app/picture/rigid_fit.h"
#include "app/support/language.h"
#include "solver/element/element_state.h"
#include "solver/model/table.h"

namespace topple::app {

/// stress: greatest equivalent stress of the section after von Mises; yield_ratio: loading of the section
/// over that at which it flows as a whole; axial: tension positive; moment: sqrt(My^2 + Mz^2); displacement:
/// from the rigid motion (rigid_fit.h).
enum class BeamQuantity { stress, yield_ratio, axial, moment, torsion, displacement };

/// A new one is a BeamQuantity and a row of the table in beam_quantity.cpp.
struct BeamQuantityTraits {
  BeamQuantity kind;
  const char* word;  ///< on the command line
  Phrase name;
  const char* unit;
  double per_unit;  ///< SI
  bool is_signed;
  /// Of element `e` under these forces, SI; null: of displacements, not of forces.
  double (*value)(const Model& model, std::size_t e, const SectionForces& forces);
  /// Its value at a yield stress, SI; null: it has none.
  double (*at_yield)(double stress);
};
std::span<const BeamQuantityTraits> beam_quantities();
inline const BeamQuantityTraits& traits(BeamQuantity quantity) {
  return row_of(beam_quantities(), quantity);
}
inline std::size_t place_of(BeamQuantity quantity) {
  return static_cast<std::size_t>(topple::place_of(beam_quantities(), quantity));
}

/// Greatest magnitude of each in the furniture of a row, SI, in the order of the table.
std::vector<double> peaks_of(const Model& model, const io::FrameRow& row);

/// Least yield stress of what the furniture is made of, Pa.
std::optional<double> least_yield(const Model& model);

}  // namespace topple::app
