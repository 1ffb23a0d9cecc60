// Who is within another body: what tests of surfaces count.
#pragma once

#include "solver/body/model_level.h"
#include "solver/contact/panel_place.h"
#include "solver/state/state.h"

namespace topple::test {

/// How many elements cross panels of another body.
inline int panel_crossings(const Model& model, State state) {
  place_nodes(model, state);
  const auto& x = state.position;
  int count = 0;
  for (const Panel& panel : model.panels) {
    const std::array<Vec3, 4> corner{x[panel.node[0]], x[panel.node[1]], x[panel.node[2]], x[panel.node[3]]};
    Eigen::AlignedBox3d box;
    for (const Vec3& at : corner) box.extend(at);
    for (const Element& element : model.elements) {
      const Vec3 &from = x[element.node[0]], &to = x[element.node[1]];
      if (model.members[element.member].body != panel.body &&
          box.intersects(Eigen::AlignedBox3d(from.cwiseMin(to), from.cwiseMax(to))) &&
          crosses_panel(from, to, corner))
        ++count;
    }
  }
  return count;
}

}  // namespace topple::test
