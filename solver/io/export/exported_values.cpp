#include "solver/io/export/exported_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "solver/element/plasticity.h"
#include "solver/element/section_forces.h"
#include "solver/io/recording/recording_format.h"
#include "solver/math/rotation.h"

namespace topple::io {

ElementLoading element_loading(const Model& model, const FrameRow& row, std::size_t e) {
  const Element& element = model.elements[e];
  const Member& member = model.members[static_cast<std::size_t>(element.member)];
  const float* f = row.section_force.data() + 6 * e;
  const SectionForces forces{.normal = {f[0], f[1], f[2]}, .moment = {f[3], f[4], f[5]}};
  const Section& section = model.sections[static_cast<std::size_t>(member.section)];
  double greatest = -1, peak = 0;
  for (const double end : {-1., 1.}) {
    const SectionForces there = forces_along(forces, element.length, row.s[e], end);
    greatest = std::max(greatest, yield_function(element, there));
    peak = std::max(peak, equivalent_stress(section, there));
  }
  return {.stress = equivalent_stress(section, forces),
          .peak = peak,
          .yield_ratio = static_cast<float>(std::sqrt(greatest + 1))};
}

NodeMotion::NodeMotion(const Model& model, const FrameRow& row) {
  for (std::size_t n = 0; n < model.node_position.size(); ++n) {
    const float *x = row.position.data() + 3 * n, *q = row.rotation.data() + 4 * n;
    const Vec3 moved = Vec3(x[0], x[1], x[2]) - model.node_position[n];
    const Vec3 turned = log_quaternion(Quat(q[0], q[1], q[2], q[3]).normalized());
    displacement.insert(displacement.end(), {moved.x(), moved.y(), moved.z()});
    rotation.insert(rotation.end(), {turned.x(), turned.y(), turned.z()});
  }
}

ElementPlaces::ElementPlaces(const Model& model) {
  for (const Element& element : model.elements) {
    nodes.insert(nodes.end(), {element.node[0], element.node[1]});
    member.push_back(element.member);
    body.push_back(model.members[static_cast<std::size_t>(element.member)].body);
  }
}

bool each_frame(const Recording& recording, const Model& model, const Proceed& proceed,
                const std::function<void(const FrameRow&)>& each) {
  for (const std::int64_t i : recording.frames_on_way_to(recording.newest_branch())) {
    if (proceed && !proceed()) return false;
    const FrameRow row = recording.frame(i);
    expect_same_model(model, row);
    each(row);
  }
  return true;
}

std::string shortest(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace topple::io
