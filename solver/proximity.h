// Which elements of different bodies are near each other, and where their centre lines are nearest.
#pragma once

#include <compare>
#include <span>
#include <vector>

#include "solver/model.h"
#include "solver/types.h"

namespace topple {

/// Two elements of different bodies, a < b; indices into Model::elements.
struct ElementPair {
  int a = 0, b = 0;
  auto operator<=>(const ElementPair&) const = default;
};

/// Where two straight lines a0-a1 and b0-b1 are nearest: at a0 + s (a1 - a0) and b0 + t (b1 - b0),
/// 0 <= s, t <= 1.
struct NearestPoints {
  double s, t;
  bool s_free, t_free;  ///< strictly between the ends: it moves as the lines do
  Vec3 between;         ///< m, from the point on b to the point on a
};
NearestPoints nearest_points(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

/// The same of the point p, in place of line a; s = 0.
NearestPoints nearest_points(const Vec3& p, const Vec3& b0, const Vec3& b1);

/// L of Eq. 2 of two elements: the mean of their members' contact widths, m.
double contact_length(const Model& model, const ElementPair& pair);

/// Pairs of elements whose surfaces are within `margin`, m, of each other, in order. Bodies are found on a
/// grid as wide as the largest free one, so that the time is linear in their number; bodies whose nodes are
/// all held do not meet each other.
std::vector<ElementPair> near_elements(const Model& model, std::span<const Vec3> position, double margin);

/// Per body: supports hold every direction of all its nodes.
std::vector<bool> held_bodies(const Model& model);

}  // namespace topple
