#include "solver/io/scene/scene_fittings.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/proximity.h"
#include "solver/io/common/units.h"
#include "solver/math/ranges.h"

namespace topple::io {
namespace {

constexpr double k_one_point = 1e-6;  // m

/// Whether a point lies within `margin`, m, of a triangle's plane and over the triangle.
bool lies_on(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point, double margin) {
  const Vec3 normal = (b - a).cross(c - a), p = point - a;
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0) || std::abs(p.dot(normal)) > margin * std::sqrt(area2)) return false;
  const double u = p.cross(c - a).dot(normal) / area2, v = (b - a).cross(p).dot(normal) / area2;
  return u >= 0 && v >= 0 && u + v <= 1;
}

/// A sheet carries what is screwed to it.
bool lies_on_panel(const Model& model, int body, const State& start, const Vec3& point, double margin) {
  return ranges::any_of(model.panels, [&](const Panel& panel) {
    if (panel.body != body) return false;
    const auto x = [&](int k) -> const Vec3& { return start.position[panel.node[k]]; };
    return lies_on(x(0), x(1), x(2), point, margin) || lies_on(x(0), x(2), x(3), point, margin);
  });
}

}  // namespace

std::string millimetres(double metres) {
  return short_number(std::round(1e4 * metres) / 10) + " mm";
}

double width_of(const Model& model, int member) {
  return model.sections[model.members[member].section].width;
}

NearestMember nearest_member(const Model& model, int index, const State& start, const Vec3& point) {
  const Body& body = model.bodies[index];
  NearestMember nearest;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    const Vec3 &a = start.position[element.node[0]], &b = start.position[element.node[1]];
    const double distance = nearest_points(point, a, b).between.norm();
    if (nearest.member >= 0 && distance >= nearest.distance) continue;
    nearest = {element.member, distance};
  }
  if (lies_on_panel(model, index, start, point, width_of(model, nearest.member))) nearest.distance = 0;
  return nearest;
}

AnchorEnd end_at(const Model& model, int index, const State& start, const Vec3& point) {
  const Body& body = model.bodies[index];
  const auto first = start.position.begin() + body.first_node;
  const auto node = std::min_element(first, first + body.node_count, [&](const Vec3& a, const Vec3& b) {
    return (a - point).squaredNorm() < (b - point).squaredNorm();
  });
  const int number = static_cast<int>(node - start.position.begin());
  return {index, number, start.rotation[number].conjugate() * (point - *node)};
}

void add_anchor(const Entry& entry, const State& start, const Vec3& point, double preload, Anchor anchor,
                Setup& setup) {
  const Model& model = setup.model;
  const AnchorEnd own = end_at(model, anchor.body, start, point);
  anchor.node = own.node;
  anchor.arm = own.arm;
  if (anchor.other.body >= 0) {
    if (held_bodies(model)[anchor.other.body])
      anchor.other = {};  // it stays where it is
    else
      anchor.other = end_at(model, anchor.other.body, start, anchor.to);
  }
  const bool pushes = anchor.type == Anchor::Type::pole;
  const double length = (point - anchor.to).norm(), longer = (pushes ? 1 : -1) * preload / anchor.stiffness;
  const bool pin =
      (anchor.type == Anchor::Type::bracket || !anchor.fixing.empty()) && !(length > k_one_point);
  if (pin && preload > 0)
    entry.fail("preload", "a pin, whose two ends are one point, has no direction to pull in");
  if (!pin && !(length > k_one_point)) entry.fail("to", "is where `point` is: the anchor has no length");
  if (!pin && !(length + longer > 0))
    entry.fail("preload",
               "stretches it by " + millimetres(-longer) + ", its whole length is " + millimetres(length));
  anchor.length = pin ? 0 : length + longer;
  setup.model.anchors.push_back(std::move(anchor));
  setup.parameters.anchors.push_back(entry.flag("on"));
}

}  // namespace topple::io
