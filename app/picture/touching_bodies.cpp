#include "app/picture/touching_bodies.h"

#include <algorithm>
#include <limits>
#include <set>

#include "app/picture/row.h"
#include "solver/contact/nearest_places.h"
#include "solver/contact/panel_place.h"
#include "solver/contact/proximity.h"

namespace topple::app {
namespace {

/// An element or a panel that something touches.
struct TouchedPart {
  int part;
  std::size_t body;
  Vec3 force, place;             // on it; in the floor's frame
  std::vector<Vec3> corner;      // of its nodes
  std::set<std::size_t> others;  // touched parts that it touches
};

double distance(const TouchedPart& part, const Vec3& p) {
  const std::vector<Vec3>& c = part.corner;
  if (c.size() == 4) return nearest_on_panel(p, {c[0], c[1], c[2], c[3]}).between.norm();
  return nearest_points(p, c[0], c[1]).between.norm();
}

std::vector<TouchedPart> touched_parts(const Model& model, const io::FrameRow& row) {
  std::vector<TouchedPart> out;
  const auto add = [&](int part, const float* on, double u) {
    const Vec3 force(on[0], on[1], on[2]);
    if (force.isZero(0)) return;
    TouchedPart one{part, static_cast<std::size_t>(body_of(model, part)), force, Vec3::Zero(), {}, {}};
    each_share(model, part, on[3], u, [&](int node, double share) {
      one.corner.push_back(position(row, node));
      one.place += share * one.corner.back();
    });
    out.push_back(std::move(one));
  };
  const std::size_t elements = row.member_contact.size() / 4, panels = row.panel_contact.size() / 5;
  for (std::size_t e = 0; e < elements; ++e) add(static_cast<int>(e), &row.member_contact[4 * e], 0);
  for (std::size_t k = 0; k < panels; ++k)
    add(static_cast<int>(model.elements.size() + k), &row.panel_contact[5 * k], row.panel_contact[5 * k + 4]);
  return out;
}

void join_nearest(std::vector<TouchedPart>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::size_t nearest = i;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < parts.size(); ++j) {
      if (parts[j].body == parts[i].body) continue;
      const double away = distance(parts[j], parts[i].place);
      if (away < least) least = away, nearest = j;
    }
    if (nearest == i) continue;
    parts[i].others.insert(nearest);
    parts[nearest].others.insert(i);
  }
}

/// The force between parts that touch: of one that touches no third its own, which is taken off the other; in
/// a ring that of the first. f(part, other, force on part).
template <class F>
void each_pair(std::vector<TouchedPart>& parts, F f) {
  for (;;) {
    const auto fewest = [](const TouchedPart& part) {
      return part.others.empty() ? std::numeric_limits<std::size_t>::max() : part.others.size();
    };
    const auto next = std::ranges::min_element(parts, {}, fewest);
    if (next == parts.end() || next->others.empty()) return;
    const std::size_t i = static_cast<std::size_t>(next - parts.begin()), j = *next->others.begin();
    const Vec3 force = next->force;
    f(i, j, force);
    parts[i].force.setZero();
    parts[j].force += force;
    parts[i].others.erase(j);
    parts[j].others.erase(i);
  }
}

void add(BodyTouch& touch, const Vec3& force, const Vec3& place, double& weight) {
  const double size = force.norm();
  if (!(size > 0)) return;
  weight += size;
  touch.force += force;
  touch.place += size / weight * (place - touch.place);
}

}  // namespace

std::vector<BodyTouch> touches(const Model& model, const io::FrameRow& row, std::size_t body) {
  const Body& own = model.bodies[body];
  const std::size_t planes = model.planes.size();
  std::vector<BodyTouch> all;
  for (const Plane& plane : model.planes) all.push_back({plane.name});
  for (const Body& other : model.bodies) all.push_back({other.name});
  std::vector<double> weight(all.size(), 0);
  for (std::size_t c = 0; c < model.contact_points.size() * planes; ++c) {
    const int node = model.contact_points[c / planes].node;
    if (node < own.first_node || node >= own.first_node + own.node_count) continue;
    const float* const on = &row.contact_force[3 * c];
    add(all[c % planes], Vec3(on[0], on[1], on[2]), position(row, node), weight[c % planes]);
  }
  std::vector<TouchedPart> parts = touched_parts(model, row);
  join_nearest(parts);
  each_pair(parts, [&](std::size_t i, std::size_t j, const Vec3& force) {
    for (const auto& [part, other, sign] : {std::tuple(i, j, 1.), std::tuple(j, i, -1.)})
      if (parts[part].body == body)
        add(all[planes + parts[other].body], sign * force, parts[i].place,
            weight[planes + parts[other].body]);
  });
  std::vector<BodyTouch> out;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (weight[k] > 0) out.push_back(std::move(all[k]));
  return out;
}

}  // namespace topple::app
