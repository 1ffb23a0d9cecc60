// Anchors of a scene.
#include <algorithm>
#include <array>
#include <cmath>

#include "solver/contact/proximity.h"
#include "solver/io/common/units.h"
#include "solver/io/scene/scene_read.h"

namespace topple::io {
namespace {

// Of the body's reach, from the nearest member: what a fitting may bridge.
constexpr double k_nowhere = 0.1;

std::string millimetres(double metres) {
  return short_number(std::round(1e4 * metres) / 10) + " mm";
}

/// Nearest member of a body to a point, and how far it is, m.
struct NearestMember {
  int member = -1;
  double distance = 0;
};

NearestMember nearest_member(const Model& model, const Body& body, const State& start, const Vec3& point) {
  NearestMember nearest;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    const Vec3 &a = start.position[element.node[0]], &b = start.position[element.node[1]];
    const double distance = nearest_points(point, a, b).between.norm();
    if (nearest.member >= 0 && distance >= nearest.distance) continue;
    nearest = {element.member, distance};
  }
  return nearest;
}

/// Whether a point lies within `margin`, m, of a triangle's plane and over the triangle.
bool lies_on(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point, double margin) {
  const Vec3 normal = (b - a).cross(c - a), p = point - a;
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0) || std::abs(p.dot(normal)) > margin * std::sqrt(area2)) return false;
  const double u = p.cross(c - a).dot(normal) / area2, v = (b - a).cross(p).dot(normal) / area2;
  return u >= 0 && v >= 0 && u + v <= 1;
}

/// A sheet of a cabinet carries what is screwed to it.
bool lies_on_panel(const Model& model, int body, const State& start, const Vec3& point, double margin) {
  return std::ranges::any_of(model.panels, [&](const Panel& panel) {
    if (panel.body != body) return false;
    const auto x = [&](int k) -> const Vec3& { return start.position[panel.node[k]]; };
    return lies_on(x(0), x(1), x(2), point, margin) || lies_on(x(0), x(2), x(3), point, margin);
  });
}

// What pulls may not lead through the face of a floor or wall. `width`: contact width of the member there.
void check_faces(const Entry& root, const Entry& entry, const Anchor& anchor, const Vec3& point,
                 double width) {
  if (anchor.type == Anchor::Type::pole) return;
  const auto check = [&](const Entry& face, const std::string& name, const Vec3& at, const Vec3& normal) {
    const double own = is_beams(face) ? 0 : face.number("width");
    const double behind = normal.dot(at - anchor.to);
    if (behind <= (own > 0 ? own : width) || normal.dot(point - anchor.to) <= 0) return;
    entry.fail("to", "lies " + millimetres(behind) + " behind the face of " + name +
                         ", into which it would pull the body");
  };
  if (const Entry floor = root.entry("floor"); floor.present())
    check(floor, "the floor", Vec3::Zero(), Vec3::UnitZ());
  for (const Entry& wall : root.entries("wall")) {
    const std::vector<double> at = wall.numbers("at");
    check(wall, "wall \"" + wall.name() + "\"", Vec3(at[0], at[1], 0), wall.direction("normal"));
  }
}

}  // namespace

void read_anchors(const Entry& root, Setup& setup) {
  Model& model = setup.model;
  const State start = start_state(model, setup.starts);
  for (const Entry& entry : root.entries("anchor")) {
    Anchor anchor;
    anchor.name = entry.name();
    anchor.body = find_body(entry, model);
    const Body& body = model.bodies[anchor.body];
    if (body.ground) entry.fail("body", "\"" + body.name + "\" is no furniture");
    const Vec3 point = entry.vector("point");
    anchor.to = entry.vector("to");
    anchor.type = entry.chosen("type", k_anchor_types);
    anchor.stiffness = entry.number("stiffness");
    if (entry.has("strength")) anchor.strength = entry.number("strength");
    anchor.length = (point - anchor.to).norm();

    const auto [member, distance] = nearest_member(model, body, start, point);
    const double width = model.sections[model.members[member].section].width;
    if (distance > std::max(k_nowhere * body.reach, width) &&
        !lies_on_panel(model, anchor.body, start, point, width))
      entry.fail("point", "an anchor to nowhere: the nearest member of \"" + body.name + "\", \"" +
                              model.members[member].name + "\", is " + millimetres(distance) + " away");
    if (!(anchor.length > 1e-6)) entry.fail("to", "is where `point` is: the anchor has no length");
    check_faces(root, entry, anchor, point, width);

    const auto first = start.position.begin() + body.first_node;
    const auto node = std::min_element(first, first + body.node_count, [&](const Vec3& a, const Vec3& b) {
      return (a - point).squaredNorm() < (b - point).squaredNorm();
    });
    anchor.node = static_cast<int>(node - start.position.begin());
    anchor.arm = start.rotation[anchor.node].conjugate() * (point - *node);
    model.anchors.push_back(anchor);
    setup.parameters.anchors.push_back(entry.flag("on"));
  }
}

}  // namespace topple::io
