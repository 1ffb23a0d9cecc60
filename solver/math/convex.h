// Convex shapes in a plane.
#pragma once

#include <vector>

#include "solver/math/types.h"

namespace topple {

using Vec2 = Eigen::Vector2d;

/// Corners counter-clockwise; one or two are a point or a line.
using Convex = std::vector<Vec2>;

inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Convex hull by A. M. Andrew's monotone chain (Information Processing Letters 9, 1979, 216-219); points on
/// its sides are left out.
Convex convex_hull(std::vector<Vec2> points);

/// Where two shapes are nearest, one point of each; distance 0 and a common point where they overlap.
struct NearestPoints2 {
  double distance;
  Vec2 a, b;
};
NearestPoints2 nearest_points(const Convex& a, const Convex& b);

/// Distance of a point from a shape, 0 inside.
double distance(const Convex& shape, const Vec2& point);

/// The mean of the corners: a point within.
Vec2 middle(const Convex& shape);

}  // namespace topple
