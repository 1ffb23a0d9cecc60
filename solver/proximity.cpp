#include "solver/proximity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace topple {
namespace {

using Box = Eigen::AlignedBox3d;

Box element_box(const Model& model, const Element& element, std::span<const Vec3> position, double margin) {
  Box box(position[element.node[0]]);
  box.extend(position[element.node[1]]);
  const Vec3 reach =
      Vec3::Constant((model.sections[model.members[element.member].section].width + margin) / 2);
  box.min() -= reach;
  box.max() += reach;
  return box;
}

using Cell = std::array<int, 3>;
struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::size_t sum = 0;
    for (int k : cell) sum = sum * 0x9e3779b97f4a7c15ull + static_cast<std::size_t>(static_cast<unsigned>(k));
    return sum ^ sum >> 32;
  }
};

// Pairs of bodies, not both held, whose boxes overlap.
std::vector<std::pair<int, int>> near_bodies(const std::vector<Box>& boxes, const std::vector<bool>& held) {
  double cell = 1e-3;
  std::vector<int> free, still;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
    (held[i] ? still : free).push_back(i);
    if (!held[i]) cell = std::max(cell, boxes[i].sizes().maxCoeff());
  }
  std::vector<std::pair<int, int>> found;
  const auto meet = [&](int i, int j) {
    if (boxes[i].intersects(boxes[j])) found.emplace_back(std::min(i, j), std::max(i, j));
  };
  const auto cell_of = [&](const Box& box) {
    const Vec3 x = box.center() / cell;
    Cell at;
    for (int k = 0; k < 3; ++k) at[k] = static_cast<int>(std::floor(std::clamp(x[k], -1e9, 1e9)));
    return at;
  };
  // Centres of boxes that overlap are at most one cell apart.
  std::unordered_map<Cell, std::vector<int>, CellHash> grid;
  for (int i : free) {
    const Cell at = cell_of(boxes[i]);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz)
          if (const auto it = grid.find({at[0] + dx, at[1] + dy, at[2] + dz}); it != grid.end())
            for (int j : it->second) meet(i, j);
    grid[at].push_back(i);
    for (int j : still) meet(i, j);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void add_near_elements(const Model& model, std::span<const Vec3> position, int a, int b, const Box& common,
                       double margin, std::vector<ElementPair>& found) {
  const auto inside = [&](const Body& body) {
    std::vector<std::pair<int, Box>> elements;
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
      if (const Box box = element_box(model, model.elements[e], position, margin); box.intersects(common))
        elements.emplace_back(e, box);
    return elements;
  };
  const auto of_a = inside(model.bodies[a]), of_b = inside(model.bodies[b]);
  for (const auto& [i, box_i] : of_a)
    for (const auto& [j, box_j] : of_b) {
      if (!box_i.intersects(box_j)) continue;
      const int *m = model.elements[i].node, *n = model.elements[j].node;
      const double l =
          nearest_points(position[m[0]], position[m[1]], position[n[0]], position[n[1]]).between.norm();
      if (l <= contact_length(model, {i, j}) + margin) found.push_back({i, j});
    }
}

}  // namespace

NearestPoints nearest_points(const Vec3& p, const Vec3& b0, const Vec3& b1) {
  const Vec3 along = b1 - b0;
  const double t = std::clamp((p - b0).dot(along) / along.squaredNorm(), 0., 1.);
  return {0, t, false, t > 0 && t < 1, p - b0 - t * along};
}

NearestPoints nearest_points(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 u = a1 - a0, v = b1 - b0, r = a0 - b0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
  const double det = uu * vv - uv * uv;
  // of parallel lines any pair of points opposite each other is nearest
  double s = det > 1e-14 * uu * vv ? std::clamp((uv * vr - vv * ur) / det, 0., 1.) : 0.5;
  double t = std::clamp((uv * s + vr) / vv, 0., 1.);
  s = std::clamp((uv * t - ur) / uu, 0., 1.);
  t = std::clamp((uv * s + vr) / vv, 0., 1.);
  return {s, t, s > 0 && s<1, t> 0 && t < 1, r + s * u - t * v};
}

double contact_length(const Model& model, const ElementPair& pair) {
  const auto width = [&](int e) {
    return model.sections[model.members[model.elements[e].member].section].width;
  };
  return (width(pair.a) + width(pair.b)) / 2;
}

std::vector<bool> held_bodies(const Model& model) {
  std::vector<unsigned> fixed(model.node_position.size(), 0u);
  for (const Support& support : model.supports) fixed[support.node] |= support.fixed;
  std::vector<bool> held(model.bodies.size(), true);
  for (int i = 0; i < model.node_total(); ++i)
    if (fixed[i] != 63u) held[model.node_body[i]] = false;
  return held;
}

std::vector<ElementPair> near_elements(const Model& model, std::span<const Vec3> position, double margin) {
  std::vector<Box> boxes;
  for (const Body& body : model.bodies) {
    Box box;
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
      box.extend(element_box(model, model.elements[e], position, margin));
    boxes.push_back(box);
  }
  std::vector<ElementPair> found;
  for (const auto& [a, b] : near_bodies(boxes, held_bodies(model)))
    add_near_elements(model, position, a, b, boxes[a].intersection(boxes[b]), margin, found);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace topple
