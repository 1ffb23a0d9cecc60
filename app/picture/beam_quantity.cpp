#include "app/picture/beam_quantity.h"

#include <algorithm>
#include <cmath>

#include "app/picture/row.h"
#include "app/picture/window_words.h"
#include "solver/element/plasticity.h"

namespace topple::app {
namespace {

constexpr BeamQuantityTraits k_quantities[] = {
    {BeamQuantity::stress, "stress", window_words::k_stress, "MPa", 1e6, false,
     [](const Model& model, std::size_t e, const SectionForces& forces) {
       return equivalent_stress(model.sections[model.members[model.elements[e].member].section], forces);
     },
     [](double stress) { return stress; }},
    {BeamQuantity::yield_ratio, "yield-ratio", window_words::k_yield_ratio, "", 1, false,
     [](const Model& model, std::size_t e, const SectionForces& forces) {
       return std::sqrt(std::max(yield_function(model.elements[e], forces) + 1, 0.));
     },
     [](double) { return 1.; }},
    {BeamQuantity::axial, "axial", window_words::k_axial, "N", 1, true,
     [](const Model&, std::size_t, const SectionForces& forces) { return forces.normal.x(); }, nullptr},
    {BeamQuantity::moment, "moment", window_words::k_moment, "N m", 1, false,
     [](const Model&, std::size_t, const SectionForces& forces) {
       return std::hypot(forces.moment.y(), forces.moment.z());
     },
     nullptr},
    {BeamQuantity::torsion, "torsion", window_words::k_torsion, "N m", 1, true,
     [](const Model&, std::size_t, const SectionForces& forces) { return forces.moment.x(); }, nullptr},
    {BeamQuantity::displacement, "displacement", window_words::k_displacement, "mm", 1e-3, false, nullptr,
     nullptr},
};

}  // namespace

std::span<const BeamQuantityTraits> beam_quantities() {
  return k_quantities;
}

std::vector<double> peaks_of(const Model& model, const io::FrameRow& row) {
  std::vector<double> peaks(std::size(k_quantities));
  const auto take = [](double value, double& peak) { peak = std::max(peak, std::abs(value)); };
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    if (model.bodies[model.members[model.elements[e].member].body].ground) continue;
    for (const double xi : {-1., 1.}) {
      const SectionForces forces = forces_at(model, row, e, xi);
      for (std::size_t q = 0; q < peaks.size(); ++q)
        if (k_quantities[q].value) take(k_quantities[q].value(model, e, forces), peaks[q]);
    }
  }
  const RigidFit fit = rigid_fit(model, row);
  for (int i = 0; i < model.node_total(); ++i)
    if (!model.bodies[model.node_body[i]].ground)
      take(displacement(model, row, fit, i).norm(), peaks[place_of(BeamQuantity::displacement)]);
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
