// Bodies that start within a floor, a wall or each other.
#include <algorithm>
#include <array>
#include <cmath>

#include "solver/contact/panel_place.h"
#include "solver/contact/proximity.h"
#include "solver/io/common/units.h"
#include "solver/io/scene/scene_read.h"

namespace topple::io {
namespace {

constexpr double k_deep = 0.5;  // of L, of the distance of centre lines

std::array<Vec3, 4> corners_of(const Panel& panel, const std::vector<Vec3>& x) {
  return {x[panel.node[0]], x[panel.node[1]], x[panel.node[2]], x[panel.node[3]]};
}

// Whether a point is inside a body of panels all around, nodes at x.
bool is_inside(const Model& model, const std::vector<Vec3>& x, const Vec3& point, int body) {
  const Body& solid = model.bodies[body];
  Vec3 middle = Vec3::Zero();
  for (int i = 0; i < solid.node_count; ++i) middle += x[solid.first_node + i] / solid.node_count;
  for (int k = solid.first_panel; k < solid.first_panel + solid.panel_count; ++k) {
    const auto& node = model.panels[k].node;
    const Vec3 normal = (x[node[2]] - x[node[0]]).cross(x[node[3]] - x[node[1]]);
    if ((point - x[node[0]]).dot(normal) * (middle - x[node[0]]).dot(normal) < 0) return false;
  }
  return true;
}

/// Calls found(member, other member, body) on a member that is within one of another body, or, with -1, that
/// has its tip within a panel of it, crosses one or is inside a solid body.
template <class F>
void find_overlaps(const Model& model, const std::vector<Vec3>& x, F found) {
  NearSearch search(model);
  for (const ElementPair& pair : search.find(x, 0)) {
    const double deep = k_deep * contact_length(model, pair);
    const auto& a = model.elements[pair.a].node;
    const int member = model.elements[pair.a].member;
    if (const Panel* const panel = panel_of(model, pair.b)) {
      const std::array<Vec3, 4> corner = corners_of(*panel, x);
      for (int end = 0; end < 2; ++end)
        if (is_tip(model, pair.a, end) && nearest_on_panel(x[a[end]], corner).between.norm() <= deep)
          found(member, -1, panel->body);
    } else if (const auto& b = model.elements[pair.b].node;
               nearest_points(x[a[0]], x[a[1]], x[b[0]], x[b[1]]).between.norm() <= deep) {
      found(member, model.elements[pair.b].member, body_of(model, pair.b));
    }
  }
  if (!model.surfaces) return;
  std::vector<Eigen::AlignedBox3d> boxes(model.bodies.size());
  for (int i = 0; i < model.node_total(); ++i) boxes[model.node_body[i]].extend(x[i]);
  for (const Panel& panel : model.panels) {
    const std::array<Vec3, 4> corner = corners_of(panel, x);
    for (int b = 0; b < static_cast<int>(boxes.size()); ++b) {
      if (b == panel.body || !boxes[b].intersects(boxes[panel.body])) continue;
      const Body& body = model.bodies[b];
      for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
        if (const auto& node = model.elements[e].node; crosses_panel(x[node[0]], x[node[1]], corner))
          found(model.elements[e].member, -1, panel.body);
    }
  }
  for (int s = 0; s < static_cast<int>(boxes.size()); ++s)
    for (int b = 0; b < static_cast<int>(boxes.size()); ++b)
      if (b != s && model.bodies[s].solid && boxes[b].intersects(boxes[s]) &&
          is_inside(model, x, x[model.bodies[b].first_node], s))
        found(model.bodies[b].first_member, -1, s);
}

}  // namespace

void check_planes(const std::vector<Entry>& entries, const Setup& setup) {
  const Model& model = setup.model;
  const State start = start_state(model, setup.starts);
  for (std::size_t b = 0; b < entries.size(); ++b)
    for (const Plane& plane : model.planes) {
      double deepest = 0;
      const Body& body = model.bodies[b];
      for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p) {
        const ContactPoint& point = model.contact_points[p];
        const double within = point.width / 2 - plane.normal.dot(start.position[point.node] - plane.point);
        if (within > k_deep * contact_length(point, plane)) deepest = std::max(deepest, within);
      }
      if (deepest > 0)
        entries[b].fail("starts " + short_number(1e3 * deepest) + " mm within \"" + plane.name + "\"");
    }
}

void check_overlap(const std::vector<Entry>& entries, const Setup& setup) {
  const Model& model = setup.model;
  if (model.bodies.size() < 2) return;
  find_overlaps(model, start_state(model, setup.starts).position,
                [&](int member, int other_member, int other) {
                  const int body = model.members[member].body;
                  const auto [first, later] = std::minmax(body, other);
                  const auto named = [&](int b, int m) {
                    const std::string& name = model.bodies[b].name;
                    return '"' + name + '"' +
                           (m < 0 || model.bodies[b].solid ? "" : " (" + model.members[m].name + ")");
                  };
                  entries[later < static_cast<int>(entries.size()) ? later : first].fail(
                      "the bodies " + named(body, member) + " and " + named(other, other_member) +
                      " overlap at the start");
                });
}

}  // namespace topple::io
