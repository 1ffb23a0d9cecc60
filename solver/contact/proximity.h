// Candidate pairs: parts of different bodies that may touch soon.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "solver/contact/nearest_places.h"
#include "solver/math/types.h"
#include "solver/model/model.h"

namespace topple {

/// Two parts of different bodies, a < b: elements, by their index into Model::elements, or an element with a
/// tip and a panel. Panels are numbered from the number of elements on.
struct ElementPair {
  int a = 0, b = 0;
  std::uint64_t key() const {
    return std::uint64_t{static_cast<unsigned>(a)} << 32 | static_cast<unsigned>(b);
  }
  friend bool operator==(const ElementPair& x, const ElementPair& y) { return x.key() == y.key(); }
  friend auto operator<=>(const ElementPair& x, const ElementPair& y) { return x.key() <=> y.key(); }
};

/// Candidate pairs, in order. Copies share them, and are compared at once.
class CandidatePairs {
 public:
  CandidatePairs() = default;
  CandidatePairs(std::vector<ElementPair> pairs)
      : pairs_(std::make_shared<const std::vector<ElementPair>>(std::move(pairs))) {}
  std::span<const ElementPair> all() const {
    return pairs_ ? std::span<const ElementPair>(*pairs_) : std::span<const ElementPair>();
  }
  auto begin() const { return all().begin(); }
  auto end() const { return all().end(); }
  std::size_t size() const { return all().size(); }
  bool empty() const { return all().empty(); }
  friend bool operator==(const CandidatePairs& x, const CandidatePairs& y) {
    return x.pairs_ == y.pairs_ || std::equal(x.begin(), x.end(), y.begin(), y.end());
  }

 private:
  std::shared_ptr<const std::vector<ElementPair>> pairs_;
};

/// The panel that a part is; null: an element.
inline const Panel* panel_of(const Model& model, int part) {
  const int panel = part - static_cast<int>(model.elements.size());
  return panel < 0 ? nullptr : &model.panels[panel];
}
/// Of a part.
inline int body_of(const Model& model, int part) {
  const Panel* const panel = panel_of(model, part);
  return panel != nullptr ? panel->body : model.members[model.elements[part].member].body;
}
/// Its nodes: two or four.
inline std::span<const int> nodes_of(const Model& model, int part) {
  const Panel* const panel = panel_of(model, part);
  return panel != nullptr ? std::span<const int>(panel->node)
                          : std::span<const int>(model.elements[part].node);
}
/// Whether an end of an element, 0 or 1, is a tip of its member.
bool is_tip(const Model& model, int element, int end);

/// Calls f(node, share) of a place on a part: of an element at t, 0..1, of a panel at (t, u), PanelPlace::r.
template <class F>
void each_share(const Model& model, int part, double t, double u, F f) {
  const std::span<const int> node = nodes_of(model, part);
  if (node.size() == 2) {
    f(node[0], 1 - t);
    f(node[1], t);
    return;
  }
  f(node[0], (1 - t) * (1 - u));
  f(node[1], t * (1 - u));
  f(node[2], t * u);
  f(node[3], (1 - t) * u);
}

/// L of Eq. 2 for two parts: the mean of their contact widths, m.
double contact_length(const Model& model, const ElementPair& pair);

/// Per body: true when supports hold every direction of all its nodes.
std::vector<bool> held_bodies(const Model& model);

/// Search for candidate pairs; keeps its memory from one search to the next.
class NearSearch {
 public:
  explicit NearSearch(const Model& model);
  /// Pairs of parts of two bodies, not both held, whose surfaces are within `margin` (m) of each other, in
  /// order; valid until the next call. Bodies are sorted into a grid with cells as wide as the largest of
  /// them that is not held, so that the time is nearly linear in their number.
  const std::vector<ElementPair>& find(std::span<const Vec3> position, double margin);

 private:
  using Box = Eigen::AlignedBox3d;
  struct Placed {
    std::array<int, 3> cell;
    int body;
    friend bool operator==(const Placed&, const Placed&) = default;
    friend bool operator<(const Placed& a, const Placed& b) {
      return std::tie(a.cell, a.body) < std::tie(b.cell, b.body);
    }
  };
  // A box whose sides are compared at once; the fourth lane is 0.
  struct Extent {
    Four low, high;
    explicit Extent(const Box& box);
    bool meets(const Extent& other) const {
      return bits((low <= other.high) & (other.low <= high)) == k_all_lanes;
    }
  };
  void find_bodies();
  void find_inside(int body, const Extent& common, std::vector<int>& elements) const;
  void find_elements(std::span<const Vec3> position, double margin);
  void find_tips(const std::vector<int>& elements, int other, const Extent& common,
                 std::span<const Vec3> position, double margin);
  void sort();

  const Model& model_;
  const std::vector<bool> held_;
  std::vector<double> half_width_;          // m, per element
  std::vector<Box> boxes_;                  // per body
  std::vector<Extent> extents_;             // per element
  std::vector<Placed> cells_;               // free bodies by place
  std::vector<std::pair<int, int>> pairs_;  // bodies
  std::vector<int> of_a_, of_b_;            // elements where two boxes overlap
  std::vector<ElementPair> found_, tips_, sorted_;
  std::vector<int> starts_;  // per element: of its pairs in sorted_
};

}  // namespace topple
