#include "solver/io/export/exported_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "solver/contact/proximity.h"
#include "solver/element/plasticity.h"
#include "solver/element/section_forces.h"
#include "solver/io/recording/recording_format.h"
#include "solver/math/rotation.h"

namespace topple::io {
namespace {

Vec3 vector_at(const std::vector<float>& values, std::size_t first) {
  return {values[first], values[first + 1], values[first + 2]};
}

/// Calls f(point, plane, force) where a plane pushes a contact point.
template <class F>
void each_plane_force(const Model& model, const FrameRow& row, F f) {
  const std::size_t planes = model.planes.size();
  for (std::size_t c = 0; c < model.contact_points.size() * planes; ++c)
    if (const Vec3 force = vector_at(row.contact_force, 3 * c); !force.isZero(0))
      f(model.contact_points[c / planes], model.planes[c % planes], force);
}

/// Calls f(part, t, u, force) where other bodies push an element or a panel (each_share).
template <class F>
void each_part_force(const Model& model, const FrameRow& row, F f) {
  const std::size_t elements = row.member_contact.size() / 4, panels = row.panel_contact.size() / 5;
  for (std::size_t e = 0; e < elements; ++e)
    if (const Vec3 force = vector_at(row.member_contact, 4 * e); !force.isZero(0))
      f(static_cast<int>(e), row.member_contact[4 * e + 3], 0., force);
  for (std::size_t k = 0; k < panels; ++k)
    if (const Vec3 force = vector_at(row.panel_contact, 5 * k); !force.isZero(0))
      f(static_cast<int>(model.elements.size() + k), row.panel_contact[5 * k + 3],
        row.panel_contact[5 * k + 4], force);
}

}  // namespace

std::vector<ContactForce> contact_forces(const Model& model, const FrameRow& row) {
  std::vector<ContactForce> all;
  const auto at = [&](int node) { return vector_at(row.position, 3 * static_cast<std::size_t>(node)); };
  each_plane_force(model, row, [&](const ContactPoint& point, const Plane& plane, const Vec3& force) {
    const int body = model.node_body[static_cast<std::size_t>(point.node)];
    const int node = point.node - model.bodies[static_cast<std::size_t>(body)].first_node;
    all.push_back({body, "node " + std::to_string(node), plane.name, at(point.node), force});
  });
  each_part_force(model, row, [&](int part, double t, double u, const Vec3& force) {
    const int body = body_of(model, part);
    const auto name = [&]() -> std::string {
      const Panel* const panel = panel_of(model, part);
      if (!panel)
        return model.members[static_cast<std::size_t>(model.elements[static_cast<std::size_t>(part)].member)]
            .name;
      const auto first = std::ranges::find(model.panels, body, &Panel::body);
      return "panel " + std::to_string(panel - &*first);
    };
    Vec3 place = Vec3::Zero();
    each_share(model, part, t, u, [&](int node, double share) { place += share * at(node); });
    all.push_back({body, name(), "", place, force});
  });
  return all;
}

std::vector<double> contact_on_nodes(const Model& model, const FrameRow& row) {
  std::vector<double> sum(3 * model.node_position.size(), 0);
  const auto add = [&](int node, const Vec3& force) {
    for (int k = 0; k < 3; ++k) sum[static_cast<std::size_t>(3 * node + k)] += force[k];
  };
  each_plane_force(model, row, [&](const ContactPoint& point, const Plane&, const Vec3& force) {
    add(point.node, force);
  });
  each_part_force(model, row, [&](int part, double t, double u, const Vec3& force) {
    each_share(model, part, t, u, [&](int node, double share) { add(node, share * force); });
  });
  return sum;
}

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

std::vector<std::int64_t> exported_frames(const Recording& recording, const Setup& setup) {
  const std::vector<std::int64_t> way = recording.frames_on_way_to(recording.newest_branch());
  const std::vector<FrameKey>& keys = recording.index();
  std::vector<std::int64_t> found;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const double multiple = keys[way[k]].time * setup.run.output_rate;
    const bool even = std::abs(multiple - std::round(multiple)) < k_row_slack;
    const bool begins = k > 0 && k + 1 < way.size() && keys[way[k]].branch != keys[way[k - 1]].branch;
    if (even || !begins || setup.run.analysis == Analysis::statics) found.push_back(way[k]);
  }
  return found;
}

bool each_frame(const Recording& recording, const Setup& setup, const Proceed& proceed,
                const std::function<void(const FrameRow&)>& each) {
  for (const std::int64_t i : exported_frames(recording, setup)) {
    if (proceed && !proceed()) return false;
    const FrameRow row = recording.frame(i);
    expect_same_model(setup.model, row);
    each(row);
  }
  return true;
}

std::string shortest(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace topple::io
