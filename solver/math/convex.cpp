#include "solver/math/convex.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "solver/math/ranges.h"

namespace topple {
namespace {

/// Of the line from a to b.
Vec2 nearest_on(const Vec2& a, const Vec2& b, const Vec2& point) {
  const Vec2 along = b - a;
  const double square = along.squaredNorm();
  return square > 0 ? Vec2(a + std::clamp(along.dot(point - a) / square, 0., 1.) * along) : a;
}

bool holds(const Convex& shape, const Vec2& point) {
  if (shape.size() < 3) return false;
  for (std::size_t k = 0; k < shape.size(); ++k)
    if (cross(shape[(k + 1) % shape.size()] - shape[k], point - shape[k]) < 0) return false;
  return true;
}

/// Calls f(begin, end) for every side; for a point, once.
template <class F>
void for_sides(const Convex& shape, F&& f) {
  const std::size_t sides = shape.size() > 2 ? shape.size() : 1;
  for (std::size_t k = 0; k < sides; ++k) f(shape[k], shape[(k + 1) % shape.size()]);
}

std::optional<Vec2> crossing(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 ab = b - a, cd = d - c;
  const double area = cross(ab, cd);
  if (area == 0) return std::nullopt;
  const double t = cross(c - a, cd) / area, u = cross(c - a, ab) / area;
  return t >= 0 && t <= 1 && u >= 0 && u <= 1 ? std::optional<Vec2>(a + t * ab) : std::nullopt;
}

std::optional<Vec2> common_point(const Convex& a, const Convex& b) {
  std::optional<Vec2> found;
  for_sides(a, [&](const Vec2& p, const Vec2& q) {
    for_sides(b, [&](const Vec2& r, const Vec2& s) {
      if (!found) found = crossing(p, q, r, s);
    });
  });
  if (found) return found;
  if (holds(b, a.front())) return a.front();
  if (holds(a, b.front())) return b.front();
  return std::nullopt;
}

}  // namespace

Convex convex_hull(std::vector<Vec2> points) {
  ranges::sort(points,
               [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Convex hull;
  const auto add_chain = [&hull](const auto& chain) {
    const std::size_t begin = hull.size();
    for (const Vec2& point : chain) {
      while (hull.size() > begin + 1 && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // begins the other chain
  };
  add_chain(points);
  ranges::reverse(points);
  add_chain(points);
  return hull;
}

NearestPoints2 nearest_points(const Convex& a, const Convex& b) {
  if (const std::optional<Vec2> common = common_point(a, b)) return {0, *common, *common};
  NearestPoints2 nearest{std::numeric_limits<double>::infinity(), a.front(), b.front()};
  const auto take = [&nearest](const Vec2& of_a, const Vec2& of_b) {
    const double between = (of_a - of_b).norm();
    if (between < nearest.distance) nearest = {between, of_a, of_b};
  };
  for (const Vec2& corner : a)
    for_sides(b, [&](const Vec2& p, const Vec2& q) { take(corner, nearest_on(p, q, corner)); });
  for (const Vec2& corner : b)
    for_sides(a, [&](const Vec2& p, const Vec2& q) { take(nearest_on(p, q, corner), corner); });
  return nearest;
}

double distance(const Convex& shape, const Vec2& point) {
  if (holds(shape, point)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for_sides(shape, [&](const Vec2& p, const Vec2& q) {
    least = std::min(least, (nearest_on(p, q, point) - point).norm());
  });
  return least;
}

Vec2 middle(const Convex& shape) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& corner : shape) sum += corner;
  return sum / static_cast<double>(shape.size());
}

}  // namespace topple
