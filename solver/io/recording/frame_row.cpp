#include "solver/io/recording/frame_row.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace topple::io {

const char* anchor_word(float state) {
  if (state == k_anchor_away) return "away";
  if (state == k_anchor_slack) return "slack";
  return state == k_anchor_holds ? "holds" : "broken";
}

namespace {

template <typename Numbers>
bool all_finite(const Numbers& numbers) {
  return std::all_of(std::begin(numbers), std::end(numbers), [](auto x) { return std::isfinite(x); });
}

template <typename Array, typename Row>
bool all_finite(const std::vector<Row>& rows) {
  return std::ranges::all_of(rows, [](const Row& row) { return all_finite(std::bit_cast<Array>(row)); });
}

}  // namespace

bool is_finite(const FrameRow& row) {
  return std::isfinite(row.time) && all_finite(row.position) && all_finite(row.rotation) &&
         all_finite(row.section_force) && all_finite(row.s) && all_finite(row.contact_depth) &&
         all_finite(row.contact_force) && all_finite(row.member_contact) && all_finite(row.energy) &&
         all_finite<BodyArray>(row.body) && all_finite(row.floor_acceleration) &&
         all_finite(row.floor_displacement) && std::isfinite(row.load_factor) &&
         all_finite<AnchorArray>(row.anchor);
}

RowShape row_shape(const Model& model) {
  return {.nodes = model.node_position.size(),
          .elements = model.elements.size(),
          .contacts = model.contact_points.size() * model.planes.size(),
          .touched = model.bodies.size() > 1 ? model.elements.size() : 0,
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
  row.energy.resize(shape.anchors > 0 ? k_released + 1 : k_anchor);
  row.body.resize(shape.bodies);
  row.level.resize(shape.bodies);
  row.anchor.resize(shape.anchors);
  return row;
}

}  // namespace topple::io
