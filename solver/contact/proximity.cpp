#include "solver/contact/proximity.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/nearest_places.h"
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

NearSearch::NearSearch(const Model& model) : model_(model), held_(held_bodies(model)) {
  for (const Element& element : model.elements)
    half_width_.push_back(model.sections[model.members[element.member].section].width / 2);
}

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

NearSearch::Extent::Extent(const Box& box)
    : low(Four::Vector{box.min().x(), box.min().y(), box.min().z(), 0}),
      high(Four::Vector{box.max().x(), box.max().y(), box.max().z(), 0}) {}

void NearSearch::find_inside(int body, const Extent& common, std::vector<int>& elements) const {
  elements.clear();
  const Body& b = model_.bodies[body];
  for (int e = b.first_element; e < b.first_element + b.element_count; ++e)
    if (extents_[e].meets(common)) elements.push_back(e);
}

// Pairs of of_a_ and of_b_, four at a time.
void NearSearch::find_elements(std::span<const Vec3> position, double margin) {
  std::array<ElementPair, 4> ahead;
  std::array<std::array<int, 4>, 4> nodes{};  // per end
  Four reach(0);
  int count = 0;
  const auto look = [&] {
    const Vec3* const x = position.data();
    const PackVector<Four> a = gather(x, nodes[0]), b = gather(x, nodes[2]), u = gather(x, nodes[1]) - a,
                           v = gather(x, nodes[3]) - b, r = a - b;
    const auto [s, t] = nearest_places(u, v, r);
    const PackVector<Four> between = r + s * u - t * v;
    const unsigned near = bits(dot(between, between) <= reach * reach);
    for (int k = 0; k < count; ++k)
      if (near >> k & 1) found_.push_back(ahead[k]);
    count = 0;
  };
  for (const int a : of_a_)
    for (const int b : of_b_) {
      if (!extents_[a].meets(extents_[b])) continue;
      const int *const m = model_.elements[a].node, *const n = model_.elements[b].node;
      nodes[0][count] = m[0];
      nodes[1][count] = m[1];
      nodes[2][count] = n[0];
      nodes[3][count] = n[1];
      reach.set(count, half_width_[a] + half_width_[b] + margin);
      ahead[count++] = {a, b};
      if (count == 4) look();
    }
  if (count > 0) look();
}

// Pairs of tips, ends of these elements, with panels of `other`.
void NearSearch::find_tips(const std::vector<int>& elements, int other, const Extent& common,
                           std::span<const Vec3> position, double margin) {
  const Body& b = model_.bodies[other];
  for (int k = b.first_panel; k < b.first_panel + b.panel_count; ++k) {
    const Panel& panel = model_.panels[k];
    const int part = static_cast<int>(model_.elements.size()) + k;
    std::array<Vec3, 4> corner;
    Box box;
    for (int i = 0; i < 4; ++i) box.extend(corner[i] = position[panel.node[i]]);
    const Vec3 wide = Vec3::Constant((panel.width + margin) / 2);
    const Extent extent(Box(box.min() - wide, box.max() + wide));
    if (!extent.meets(common)) continue;
    for (const int e : elements) {
      if (!extent.meets(extents_[e])) continue;
      for (int end = 0; end < 2; ++end) {
        if (!is_tip(model_, e, end)) continue;
        const Vec3& tip = position[model_.elements[e].node[end]];
        const double reach = contact_length(model_, {e, part}) + margin;
        if (box.squaredExteriorDistance(tip) <= reach * reach &&
            nearest_on_panel(tip, corner).between.norm() <= reach)
          tips_.push_back({e, part});
      }
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
  extents_.clear();
  for (const Body& body : model_.bodies) {
    Box box;
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
      const Box own = element_box(model_, model_.elements[e], position, margin);
      extents_.emplace_back(own);
      box.extend(own);
    }
    boxes_.push_back(box);
  }
  find_bodies();
  found_.clear();
  tips_.clear();
  for (const auto& [a, b] : pairs_) {
    const Extent common(boxes_[a].intersection(boxes_[b]));
    find_inside(a, common, of_a_);
    find_inside(b, common, of_b_);
    find_elements(position, margin);
    if (!model_.surfaces) continue;
    find_tips(of_a_, b, common, position, margin);
    find_tips(of_b_, a, common, position, margin);
  }
  sort();
  return sorted_;
}

}  // namespace topple
