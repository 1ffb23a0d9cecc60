// Candidate pairs: elements of different bodies that may touch soon. And where centre lines are nearest.
#pragma once

#include <array>
#include <compare>
#include <span>
#include <utility>
#include <vector>

#include "solver/math/types.h"
#include "solver/model/model.h"

namespace topple {

/// Two elements of different bodies, a < b; indices into Model::elements.
struct ElementPair {
  int a = 0, b = 0;
  auto operator<=>(const ElementPair&) const = default;
};

/// Where two segments a0-a1 and b0-b1 are nearest: at a0 + s (a1 - a0) and b0 + t (b1 - b0), 0 <= s, t <= 1.
struct NearestPoints {
  double s, t;
  bool s_free, t_free;  ///< strictly between the ends: it slides along as the lines move
  Vec3 between;         ///< m, from the point on b to the point on a
};
NearestPoints nearest_points(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

/// The same for a point p in place of a; s = 0, not free.
NearestPoints nearest_points(const Vec3& p, const Vec3& b0, const Vec3& b1);

/// L of Eq. 2 for two elements: the mean of their members' contact widths, m.
double contact_length(const Model& model, const ElementPair& pair);

/// Per body: true when supports hold every direction of all its nodes.
std::vector<bool> held_bodies(const Model& model);

/// Search for candidate pairs; keeps its memory from one search to the next.
class NearSearch {
 public:
  explicit NearSearch(const Model& model);
  /// Pairs of elements of two bodies, not both held, whose surfaces are within `margin` (m) of each other, in
  /// order; valid until the next call. Bodies are sorted into a grid with cells as wide as the largest of
  /// them that is not held, so that the time is nearly linear in their number.
  const std::vector<ElementPair>& find(std::span<const Vec3> position, double margin);

 private:
  using Box = Eigen::AlignedBox3d;
  struct Placed {
    std::array<int, 3> cell;
    int body;
    friend auto operator<=>(const Placed&, const Placed&) = default;
  };
  void find_bodies();
  void find_inside(int body, const Box& common, std::span<const Vec3> position, double margin,
                   std::vector<std::pair<int, Box>>& elements) const;

  const Model& model_;
  const std::vector<bool> held_;
  std::vector<Box> boxes_;                        // per body
  std::vector<Placed> cells_;                     // free bodies by place
  std::vector<std::pair<int, int>> pairs_;        // bodies
  std::vector<std::pair<int, Box>> of_a_, of_b_;  // elements where two boxes overlap
  std::vector<ElementPair> found_;
};

}  // namespace topple
