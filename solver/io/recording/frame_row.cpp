#include "solver/io/recording/frame_row.h"

#include <algorithm>
#include <cmath>

#include "solver/math/bits.h"
#include "solver/math/ranges.h"

namespace topple::io {

bool has_stresses(const FrameRow& row, int body) {
  return traits(static_cast<ModelLevel>(row.level[static_cast<std::size_t>(body)])).has_stresses;
}

float anchor_state(const Anchor& anchor, const AnchorNumbers& now) {
  return now.state == k_anchor_slack && !can_slacken(anchor) ? k_anchor_holds : now.state;
}

const char* anchor_word(float state) {
  if (state == k_anchor_away) return "away";
  if (state == k_anchor_slack) return "slack";
  return state == k_anchor_holds ? "holds" : "broken";
}

namespace {

constexpr EnergyTraits k_energies[] = {
    {k_input, "input", "J", [](const EnergyLedger& e) { return e.input; }},
    {k_kinetic, "kinetic", "J", [](const EnergyLedger& e) { return e.kinetic; }},
    {k_strain, "strain", "J", [](const EnergyLedger& e) { return e.strain; }},
    {k_gravity, "gravity", "J", [](const EnergyLedger& e) { return e.gravity; }},
    {k_contact, "contact", "J", [](const EnergyLedger& e) { return e.contact; }},
    {k_friction, "friction", "J", [](const EnergyLedger& e) { return e.friction; }},
    {k_normal_damping, "normal_damping", "J", [](const EnergyLedger& e) { return e.normal_damping; }},
    {k_numerical, "numerical", "J", [](const EnergyLedger& e) { return e.numerical; }},
    {k_plastic, "plastic", "J", [](const EnergyLedger& e) { return e.plastic; }},
    {k_damping, "damping", "J", [](const EnergyLedger& e) { return e.damping; }},
    {k_model_switch, "model_switch", "J", [](const EnergyLedger& e) { return e.model_switch; }},
    {k_balance_error, "balance_error", "1", [](const EnergyLedger& e) { return e.balance_error(); }},
    {k_anchor, "anchor", "J", [](const EnergyLedger& e) { return e.anchor; }},
    {k_released, "released", "J", [](const EnergyLedger& e) { return e.released; }},
};
static_assert([] {
  for (std::size_t column = 0; column < std::size(k_energies); ++column)
    if (k_energies[column].kind != column) return false;
  return true;
}());

template <typename Numbers>
bool all_finite(const Numbers& numbers) {
  return std::all_of(std::begin(numbers), std::end(numbers), [](auto x) { return std::isfinite(x); });
}

template <typename Array, typename Row>
bool all_finite(const std::vector<Row>& rows) {
  return ranges::all_of(rows, [](const Row& row) { return all_finite(bits_as<Array>(row)); });
}

}  // namespace

std::span<const EnergyTraits> energy_columns(bool anchors) {
  return std::span(k_energies).first(anchors ? std::size(k_energies) : std::size_t{k_anchor});
}

bool is_finite(const FrameRow& row) {
  return std::isfinite(row.time) && all_finite(row.position) && all_finite(row.rotation) &&
         all_finite(row.section_force) && all_finite(row.s) && all_finite(row.contact_depth) &&
         all_finite(row.contact_force) && all_finite(row.member_contact) && all_finite(row.panel_contact) &&
         all_finite(row.energy) && all_finite<BodyArray>(row.body) && all_finite(row.floor_acceleration) &&
         all_finite(row.floor_displacement) && std::isfinite(row.load_factor) &&
         all_finite<AnchorArray>(row.anchor);
}

RowShape row_shape(const Model& model) {
  return {.nodes = model.node_position.size(),
          .elements = model.elements.size(),
          .contacts = model.contact_points.size() * model.planes.size(),
          .touched = model.bodies.size() > 1 ? model.elements.size() : 0,
          .panels = model.bodies.size() > 1 && model.surfaces ? model.panels.size() : 0,
          .bodies = model.bodies.size(),
          .anchors = model.anchors.size()};
}

FrameRow blank_row(const RowShape& shape) {
  FrameRow row;
  row.position.resize(3 * shape.nodes);
  row.rotation.resize(4 * shape.nodes);
  row.section_force.resize(6 * shape.elements);
  row.s.resize(shape.elements);
  row.hinge.resize(shape.elements);
  row.contact_depth.resize(shape.contacts);
  row.contact_force.resize(3 * shape.contacts);
  row.member_contact.resize(4 * shape.touched);
  row.panel_contact.resize(5 * shape.panels);
  row.energy.resize(energy_columns(shape.anchors > 0).size());
  row.body.resize(shape.bodies);
  row.level.resize(shape.bodies);
  row.anchor.resize(shape.anchors);
  return row;
}

}  // namespace topple::io
