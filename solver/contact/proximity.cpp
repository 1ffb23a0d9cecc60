#include "solver/contact/proximity.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/panel_place.h"

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

}  // namespace

bool is_tip(const Model& model, int element, int end) {
  const Member& member = model.members[model.elements[element].member];
  const int last = member.first_element + member.element_count - 1;
  return member.tip[end] && element == (end == 0 ? member.first_element : last);
}

double contact_length(const Model& model, const ElementPair& pair) {
  const auto width = [&](int part) {
    const Panel* const panel = panel_of(model, part);
    return panel != nullptr ? panel->width
                            : model.sections[model.members[model.elements[part].member].section].width;
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

NearSearch::NearSearch(const Model& model) : model_(model), held_(held_bodies(model)) {}

// Pairs of bodies, not both held, whose boxes overlap.
void NearSearch::find_bodies() {
  double cell = 1e-3;
  cells_.clear();
  pairs_.clear();
  const int count = static_cast<int>(boxes_.size());
  for (int i = 0; i < count; ++i)
    if (!held_[i]) cell = std::max(cell, boxes_[i].sizes().maxCoeff());
  for (int i = 0; i < count; ++i) {
    if (held_[i]) continue;
    const Vec3 x = boxes_[i].center() / cell;
    Placed placed{{}, i};
    for (int k = 0; k < 3; ++k)  // a NaN comes out as a number too
      placed.cell[k] = static_cast<int>(std::floor(std::fmax(std::fmin(x[k], 1e9), -1e9)));
    cells_.push_back(placed);
  }
  std::sort(cells_.begin(), cells_.end());
  const auto meet = [&](int i, int j) {
    if (boxes_[i].intersects(boxes_[j])) pairs_.emplace_back(std::min(i, j), std::max(i, j));
  };
  // Centres of boxes that overlap are at most one cell apart: in a row of three cells along z.
  for (const Placed& one : cells_) {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const std::array<int, 3> row{one.cell[0] + dx, one.cell[1] + dy, one.cell[2] - 1};
        for (auto other = std::lower_bound(cells_.begin(), cells_.end(), Placed{row, -1});
             other != cells_.end() && other->cell[0] == row[0] && other->cell[1] == row[1] &&
             other->cell[2] <= row[2] + 2;
             ++other)
          if (other->body < one.body) meet(one.body, other->body);
      }
    for (int j = 0; j < count; ++j)
      if (held_[j]) meet(one.body, j);
  }
  std::sort(pairs_.begin(), pairs_.end());
}

void NearSearch::find_inside(int body, const Box& common, std::span<const Vec3> position, double margin,
                             std::vector<std::pair<int, Box>>& elements) const {
  elements.clear();
  const Body& b = model_.bodies[body];
  for (int e = b.first_element; e < b.first_element + b.element_count; ++e)
    if (const Box box = element_box(model_, model_.elements[e], position, margin); box.intersects(common))
      elements.emplace_back(e, box);
}

// Pairs of tips, ends of these elements, with panels of `other`.
void NearSearch::find_tips(const std::vector<std::pair<int, Box>>& elements, int other, const Box& common,
                           std::span<const Vec3> position, double margin) {
  const Body& b = model_.bodies[other];
  for (int k = b.first_panel; k < b.first_panel + b.panel_count; ++k) {
    const Panel& panel = model_.panels[k];
    const int part = static_cast<int>(model_.elements.size()) + k;
    std::array<Vec3, 4> corner;
    Box box;
    for (int i = 0; i < 4; ++i) box.extend(corner[i] = position[panel.node[i]]);
    const Vec3 reach = Vec3::Constant((panel.width + margin) / 2);
    box.min() -= reach;
    box.max() += reach;
    if (!box.intersects(common)) continue;
    for (const auto& [e, element] : elements) {
      if (!box.intersects(element)) continue;
      for (int end = 0; end < 2; ++end)
        if (is_tip(model_, e, end) &&
            nearest_on_panel(position[model_.elements[e].node[end]], corner).between.norm() <=
                contact_length(model_, {e, part}) + margin)
          tips_.push_back({e, part});
    }
  }
}

// Of a part's pairs those with elements, then those with panels: both were found body after body.
void NearSearch::sort() {
  starts_.assign(model_.elements.size() + 1, 0);
  for (const auto* list : {&found_, &tips_})
    for (const ElementPair& pair : *list) ++starts_[pair.a + 1];
  for (std::size_t e = 1; e < starts_.size(); ++e) starts_[e] += starts_[e - 1];
  sorted_.resize(found_.size() + tips_.size());
  for (const auto* list : {&found_, &tips_})
    for (const ElementPair& pair : *list) sorted_[starts_[pair.a]++] = pair;
}

const std::vector<ElementPair>& NearSearch::find(std::span<const Vec3> position, double margin) {
  boxes_.clear();
  for (const Body& body : model_.bodies) {
    Box box;
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
      box.extend(element_box(model_, model_.elements[e], position, margin));
    boxes_.push_back(box);
  }
  find_bodies();
  found_.clear();
  tips_.clear();
  for (const auto& [a, b] : pairs_) {
    const Box common = boxes_[a].intersection(boxes_[b]);
    find_inside(a, common, position, margin, of_a_);
    find_inside(b, common, position, margin, of_b_);
    for (const auto& [i, box_i] : of_a_)
      for (const auto& [j, box_j] : of_b_) {
        if (!box_i.intersects(box_j)) continue;
        const int *m = model_.elements[i].node, *n = model_.elements[j].node;
        const double l =
            nearest_points(position[m[0]], position[m[1]], position[n[0]], position[n[1]]).between.norm();
        if (l <= contact_length(model_, {i, j}) + margin) found_.push_back({i, j});
      }
    if (!model_.surfaces) continue;
    find_tips(of_a_, b, common, position, margin);
    find_tips(of_b_, a, common, position, margin);
  }
  sort();
  return sorted_;
}

}  // namespace topple
