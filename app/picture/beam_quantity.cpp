#include "app/picture/beam_quantity.h"

#include <algorithm>
#include <cmath>

#include "app/picture/row.h"
#include "app/picture/window_words.h"
#include "solver/element/plasticity.h"

namespace topple::app {
namespace {

constexpr QuantityName k_names[k_beam_quantities] = {
    {"stress", window_words::k_stress, "MPa", 1e6, false},
    {"yield-ratio", window_words::k_yield_ratio, "", 1, false},
    {"axial", window_words::k_axial, "N", 1, true},
    {"moment", window_words::k_moment, "N m", 1, false},
    {"torsion", window_words::k_torsion, "N m", 1, true},
    {"displacement", window_words::k_displacement, "mm", 1e-3, false},
};

}  // namespace

const QuantityName& name_of(BeamQuantity quantity) {
  return k_names[static_cast<std::size_t>(quantity)];
}

std::optional<BeamQuantity> beam_quantity_named(std::string_view option) {
  for (std::size_t i = 0; i < k_beam_quantities; ++i)
    if (option == k_names[i].option) return static_cast<BeamQuantity>(i);
  return std::nullopt;
}

double value_of(BeamQuantity quantity, const Model& model, std::size_t e, const SectionForces& forces) {
  const Element& element = model.elements[e];
  switch (quantity) {
    case BeamQuantity::stress:
      return equivalent_stress(model.sections[model.members[element.member].section], forces);
    case BeamQuantity::yield_ratio:
      return std::sqrt(std::max(yield_function(element, forces) + 1, 0.));
    case BeamQuantity::axial:
      return forces.normal.x();
    case BeamQuantity::moment:
      return std::hypot(forces.moment.y(), forces.moment.z());
    case BeamQuantity::torsion:
      return forces.moment.x();
    case BeamQuantity::displacement:
      break;
  }
  return 0;
}

std::array<double, k_beam_quantities> peaks_of(const Model& model, const io::FrameRow& row) {
  std::array<double, k_beam_quantities> peaks{};
  const auto take = [&](BeamQuantity quantity, double value) {
    double& peak = peaks[static_cast<std::size_t>(quantity)];
    peak = std::max(peak, std::abs(value));
  };
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    if (model.bodies[model.members[model.elements[e].member].body].ground) continue;
    for (const double xi : {-1., 1.}) {
      const SectionForces forces = forces_at(model, row, e, xi);
      for (std::size_t q = 0; q < k_beam_quantities; ++q)
        take(static_cast<BeamQuantity>(q), value_of(static_cast<BeamQuantity>(q), model, e, forces));
    }
  }
  const RigidFit fit = rigid_fit(model, row);
  for (int i = 0; i < model.node_total(); ++i)
    if (!model.bodies[model.node_body[i]].ground)
      take(BeamQuantity::displacement, displacement(model, row, fit, i).norm());
  return peaks;
}

std::optional<double> least_yield(const Model& model) {
  std::optional<double> least;
  for (const Member& member : model.members) {
    const double yield = model.materials[member.material].yield;
    if (!model.bodies[member.body].ground && yield > 0) least = std::min(least.value_or(yield), yield);
  }
  return least;
}

}  // namespace topple::app
