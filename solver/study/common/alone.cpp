#include "solver/study/common/alone.h"

#include <algorithm>
#include <cmath>

namespace topple::study {
namespace {

constexpr double k_level = 1 - 1e-9;  // z of the normal of a horizontal plane
constexpr double k_gap = 1e-3;        // m, between a body that stands and its floor
constexpr double k_same = 1e-9;       // relative, or m, of what is alike

template <typename T>
std::vector<T> part(const std::vector<T>& all, int first, int count) {
  return {all.begin() + first, all.begin() + first + count};
}

bool same_nodes(const Model& model, const Body& a, const Body& b) {
  const Vec3 shift = b.centre_of_gravity - a.centre_of_gravity;
  for (int i = 0; i < a.node_count; ++i) {
    const int m = a.first_node + i, n = b.first_node + i;
    if ((model.node_position[n] - model.node_position[m] - shift).norm() > k_same ||
        std::abs(model.node_mass[m] - model.node_mass[n]) > k_same * a.mass ||
        (model.node_inertia[m] - model.node_inertia[n]).norm() > k_same * a.inertia.norm())
      return false;
  }
  return true;
}

bool same_elements(const Model& model, const Body& a, const Body& b) {
  for (int e = 0; e < a.element_count; ++e) {
    const Element &m = model.elements[a.first_element + e], &n = model.elements[b.first_element + e];
    if (m.node[0] - a.first_node != n.node[0] - b.first_node ||
        m.node[1] - a.first_node != n.node[1] - b.first_node || m.s != n.s || m.capacity != n.capacity ||
        !m.normal_stiffness.isApprox(n.normal_stiffness, k_same) ||
        !m.bending_stiffness.isApprox(n.bending_stiffness, k_same) || !m.triad.isApprox(n.triad, k_same))
      return false;
  }
  return true;
}

bool same_contacts(const Model& model, const Body& a, const Body& b) {
  for (int k = 0; k < a.contact_point_count; ++k) {
    const ContactPoint &m = model.contact_points[a.first_contact_point + k],
                       &n = model.contact_points[b.first_contact_point + k];
    if (m.node - a.first_node != n.node - b.first_node || m.width != n.width) return false;
  }
  return true;
}

}  // namespace

std::optional<Plane> floor_of(const Model& model) {
  for (const Plane& plane : model.planes)
    if (plane.normal.z() > k_level) return plane;
  return std::nullopt;
}

bool holds(const Model& model, const Anchor& anchor, int body) {
  constexpr double k_beside = 0.05;  // m, between the bases of bodies that stand side by side
  const auto base = [&](int b) { return model.bodies[b].base_centre.z(); };
  return anchor.body == body || (anchor.other.body == body && base(anchor.body) < base(body) + k_beside);
}

std::string why_not_standing(const Model& model, int index) {
  const Body& body = model.bodies[index];
  const auto floor = floor_of(model);
  if (!floor) return "has no level floor below it";
  for (const Support& support : model.supports)
    if (model.node_body[support.node] == index) return "is held by supports";
  if (body.support_polygon.size() < 3 || body.base_points.empty()) return "has no base";
  const std::vector<Vec3>& corners = body.support_polygon;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 edge = corners[(i + 1) % corners.size()] - corners[i];
    if (!(Vec3(edge.y(), -edge.x(), 0).dot(corners[i] - body.centre_of_gravity) > 0))
      return "has its centre of gravity beside its base";
  }
  for (const int point : body.base_points) {
    const ContactPoint& contact = model.contact_points[point];
    const double gap = model.node_position[contact.node].z() - floor->point.z() - contact.width / 2;
    if (std::abs(gap) < k_gap) return "";
  }
  return "does not touch the floor";
}

Setup alone(const Setup& scene, int index, bool walls) {
  const Model& from = scene.model;
  Setup setup{
      .model = {}, .parameters = scene.parameters, .starts = {BodyStart{}}, .run = scene.run, .probes = {}};
  setup.parameters.shakes.clear();
  setup.parameters.models = {BodyModel::frame};  // trials push its nodes; a block stays rigid
  setup.run.settle = true;
  setup.run.stop_when = StopWhen::never;
  Body body = from.bodies[index];
  Model& to = setup.model;
  to.scheme = from.scheme;
  to.materials = from.materials;
  to.sections = from.sections;
  to.node_position = part(from.node_position, body.first_node, body.node_count);
  to.node_mass = part(from.node_mass, body.first_node, body.node_count);
  to.node_inertia = part(from.node_inertia, body.first_node, body.node_count);
  to.node_body.assign(static_cast<std::size_t>(body.node_count), 0);
  to.elements = part(from.elements, body.first_element, body.element_count);
  for (Element& element : to.elements) {
    for (int& node : element.node) node -= body.first_node;
    element.member -= body.first_member;
  }
  to.members = part(from.members, body.first_member, body.member_count);
  for (Member& member : to.members) {
    member.body = 0;
    member.first_element -= body.first_element;
  }
  to.contact_points = part(from.contact_points, body.first_contact_point, body.contact_point_count);
  for (ContactPoint& point : to.contact_points) point.node -= body.first_node;
  for (int& point : body.base_points) point -= body.first_contact_point;
  to.surfaces = from.surfaces;
  to.panels = part(from.panels, body.first_panel, body.panel_count);
  for (Panel& panel : to.panels) {
    panel.body = 0;
    for (int& node : panel.node) node -= body.first_node;
  }
  body.first_node = body.first_element = body.first_member = body.first_contact_point = body.first_panel = 0;
  to.bodies = {std::move(body)};
  to.planes = walls ? from.planes : std::vector<Plane>{floor_of(from).value()};
  return setup;
}

std::string why_not_frames(const Model& model) {
  const auto block = std::ranges::find_if(model.bodies, &Body::solid);
  return block == model.bodies.end() ? "" : block->name + " is a block, which is never a frame";
}

bool alike(const Model& model, int index_a, int index_b) {
  const Body &a = model.bodies[index_a], &b = model.bodies[index_b];
  return a.node_count == b.node_count && a.element_count == b.element_count &&
         a.contact_point_count == b.contact_point_count && a.grip == b.grip && same_nodes(model, a, b) &&
         same_elements(model, a, b) && same_contacts(model, a, b);
}

}  // namespace topple::study
