// What beams may be coloured by.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "app/picture/rigid_fit.h"
#include "app/support/language.h"
#include "solver/element/element_state.h"

namespace topple::app {

/// stress: greatest equivalent stress of the section after von Mises; yield_ratio: loading of the section
/// over that at which it flows as a whole; axial: tension positive; moment: sqrt(My^2 + Mz^2); displacement:
/// from the rigid motion (rigid_fit.h).
enum class BeamQuantity : std::size_t { stress, yield_ratio, axial, moment, torsion, displacement };
inline constexpr std::size_t k_beam_quantities = 6;

struct QuantityName {
  const char* option;  ///< on the command line
  Phrase name;
  const char* unit;
  double per_unit;  ///< SI
  bool is_signed;
};
const QuantityName& name_of(BeamQuantity quantity);
std::optional<BeamQuantity> beam_quantity_named(std::string_view option);

/// Of element `e` under these forces, SI; not for displacement.
double value_of(BeamQuantity quantity, const Model& model, std::size_t e, const SectionForces& forces);

/// Greatest magnitude of each in the furniture of a row, SI.
std::array<double, k_beam_quantities> peaks_of(const Model& model, const io::FrameRow& row);

/// Least yield stress of what the furniture is made of, Pa.
std::optional<double> least_yield(const Model& model);

}  // namespace topple::app
