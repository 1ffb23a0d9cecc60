#include "app/furnish/snap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace topple::app {
namespace {

constexpr double k_turn_reach = 0.35;  // m, of a back from its wall
constexpr double k_parallel = 1e-6;

Vec2 front_of(double yaw) {
  return {std::cos(yaw), std::sin(yaw)};
}

double on_grid(double x) {
  return std::round(x / k_grid) * k_grid;
}

/// The shortest way that any of them offers, within k_snap_reach; none: they offer none.
class Shortest {
 public:
  void offer(double way) {
    if (std::abs(way) <= k_snap_reach && (!way_ || std::abs(way) < std::abs(*way_))) way_ = way;
  }
  /// However far it is.
  void force(double way) { way_ = way; }
  const std::optional<double>& way() const { return way_; }

 private:
  std::optional<double> way_;
};

bool parallel(const Footprint& a, const Footprint& b) {
  return std::abs(std::sin(2 * (a.spot.yaw - b.spot.yaw))) < k_parallel;
}

/// Turns its back to the nearest wall, and to none that is far.
void turn_to_wall(Footprint& piece, std::span<const WallLine> walls) {
  double nearest = k_turn_reach;
  for (const WallLine& wall : walls) {
    const double gap = wall.normal.dot(piece.spot.at - wall.at) - piece.half.x();
    if (gap >= nearest) continue;
    nearest = gap;
    piece.spot.yaw = std::atan2(wall.normal.y(), wall.normal.x());
  }
}

}  // namespace

double half_along(const Footprint& of, const Vec2& direction) {
  const Vec2 front = front_of(of.spot.yaw), left(-front.y(), front.x());
  return of.half.x() * std::abs(front.dot(direction)) + of.half.y() * std::abs(left.dot(direction));
}

bool backs_wall(const Footprint& piece, std::span<const WallLine> walls) {
  return std::ranges::any_of(walls, [&](const WallLine& wall) {
    const double gap = wall.normal.dot(piece.spot.at - wall.at) - piece.half.x();
    return gap < k_snap_reach && wall.normal.dot(front_of(piece.spot.yaw)) > 1 - k_parallel;
  });
}

std::vector<WallLine> wall_lines(const Model& model) {
  std::vector<WallLine> walls;
  for (const Plane& plane : model.planes)
    if (std::abs(plane.normal.z()) < 1e-9) walls.push_back({plane.point.head<2>(), plane.normal.head<2>()});
  return walls;
}

Vec2 off_walls(const Footprint& piece, std::span<const WallLine> walls) {
  Vec2 at = piece.spot.at;
  for (const WallLine& wall : walls) {
    const double gap = wall.normal.dot(at - wall.at) - half_along(piece, wall.normal);
    if (gap < k_gap_at_wall) at += (k_gap_at_wall - gap) * wall.normal;
  }
  return at;
}

Spot snapped(const Footprint& piece, std::span<const Footprint> others, std::span<const WallLine> walls,
             bool turns) {
  Footprint now = piece;
  if (turns) turn_to_wall(now, walls);
  const Vec2 front = front_of(now.spot.yaw);
  const std::array<Vec2, 2> axes{front, Vec2(-front.y(), front.x())};
  std::array<std::optional<double>, 2> ways;
  for (std::size_t k = 0; k < 2; ++k) {
    Shortest to_wall;
    for (const WallLine& wall : walls) {
      const double cosine = wall.normal.dot(axes[k]);
      if (std::abs(cosine) < 1 - k_parallel) continue;
      const double gap = wall.normal.dot(now.spot.at - wall.at) - now.half[static_cast<int>(k)];
      const double way = (k_gap_at_wall - gap) * std::copysign(1., cosine);
      gap < k_gap_at_wall ? to_wall.force(way) : to_wall.offer(way);
    }
    ways[k] = to_wall.way();
  }
  for (std::size_t k = 0; k < 2; ++k) {
    Shortest beside, in_line;
    for (const Footprint& other : others) {
      if (!parallel(now, other)) continue;
      const Vec2 between = other.spot.at - now.spot.at;
      const double along = between.dot(axes[k]), across = between.dot(axes[1 - k]);
      const double apart = half_along(now, axes[k]) + half_along(other, axes[k]);
      const double faces = half_along(now, axes[1 - k]) + half_along(other, axes[1 - k]);
      if (std::abs(across) < faces) beside.offer(along - std::copysign(apart + k_gap_at_piece, along));
      // in line with what stands right next to it
      if (std::abs(std::abs(across) - faces) < k_gap_at_piece + k_snap_reach) {
        const double differ = half_along(now, axes[k]) - half_along(other, axes[k]);
        for (const double shift : {differ, 0., -differ}) in_line.offer(along + shift);
      }
    }
    if (!ways[k]) ways[k] = beside.way() ? beside.way() : in_line.way();
  }
  Vec2 at = now.spot.at;
  for (std::size_t k = 0; k < 2; ++k)
    if (ways[k]) at += *ways[k] * axes[k];
  // the grid is the room's: along an axis of the piece that is one of it
  for (int c = 0; c < 2; ++c) {
    bool held = false;
    for (std::size_t k = 0; k < 2; ++k) held = held || (ways[k] && std::abs(axes[k][c]) > k_parallel);
    if (!held) at[c] = on_grid(at[c]);
  }
  return {at, now.spot.yaw};
}

}  // namespace topple::app
