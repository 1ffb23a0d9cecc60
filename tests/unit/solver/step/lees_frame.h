// Lee's frame: two legs at a right angle, pinned; a load beside the corner snaps it through.
#pragma once

#include "solver/run/run.h"
#include "unit/solver/fixtures.h"

namespace topple::test {

// Two legs of 120, pinned; the load acts 24 from the corner.
inline topple::Setup lees_frame(int members) {
  topple::Setup setup;
  Material material = steel();
  material.young = 7.2e6;
  setup.model.materials.push_back(material);
  setup.model.sections.push_back(plain_section(6, 2, 4.5, 5, 1, 1));
  FrameSpec spec;
  spec.name = "lee";
  for (int i = 0; i <= members; ++i) spec.nodes.push_back({0, 0, 120. * i / members});
  for (int i = 1; i <= members; ++i) spec.nodes.push_back({120. * i / members, 0, 120});
  for (int i = 0; i < 2 * members; ++i) spec.members.push_back({{i, i + 1}, 0, 0});
  spec.supports = {{0, 0x2f}, {2 * members, 0x2f}};
  spec.loads.push_back({members + members / 5, {0, 0, -1000}, Vec3::Zero(), {}});
  setup.starts = add_frame(setup.model, spec);
  setup.parameters.gravity.setZero();
  setup.run = {.analysis = Analysis::statics, .settle = false};
  return setup;
}

}  // namespace topple::test
