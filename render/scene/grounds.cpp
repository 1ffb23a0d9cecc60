#include "render/scene/grounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "render/scene/drawable.h"

namespace topple::render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int k_tiles = 16;  // along each side of what is seen of a floor or wall

struct PlaneAxes {
  Vector3f along, across, normal;
};

/// False when the ground has no plane or no area.
bool plane_axes(const Ground& ground, PlaneAxes& axes) {
  if (!drawable(ground.centre) || !drawable(ground.normal) || !drawable(ground.along) ||
      !drawable(ground.half_length) || !drawable(ground.half_width) || ground.half_length <= 0 ||
      ground.half_width <= 0) {
    return false;
  }
  const Vector3f normal(ground.normal.data());
  const Vector3f along(ground.along.data());
  const Vector3f across = normal.cross(along);
  if (across.norm() < 1e-6f) return false;
  axes.normal = normal.normalized();
  axes.across = across.normalized();
  axes.along = axes.across.cross(axes.normal);
  return true;
}

Eigen::Vector4f wall_before_which_the_floor_lies(const SceneFrame& frame, const Vector3f& eye) {
  for (const Ground& ground : frame.grounds) {
    PlaneAxes axes;
    if (ground.is_floor || !plane_axes(ground, axes)) continue;
    const float offset_m = axes.normal.dot(Vector3f(ground.centre.data()));
    if (axes.normal.dot(eye) > offset_m) return {axes.normal.x(), axes.normal.y(), axes.normal.z(), offset_m};
  }
  return {0, 0, 0, -1};
}

/// The part from..to in tiles, the shaded ones last.
void push_tiles(Grounds& grounds, DrawnGround& ground, const Vector2f& from, const Vector2f& to,
                const Shadows& shadows) {
  const auto corner = [&](int i, int j) -> Vector2f {
    return from + (to - from).cwiseProduct(Vector2f(i, j) / static_cast<float>(k_tiles));
  };
  std::vector<Vector2f> shaded;
  ground.lit.first = static_cast<std::uint32_t>(grounds.corners.size());
  for (int i = 0; i < k_tiles; ++i) {
    for (int j = 0; j < k_tiles; ++j) {
      const std::array<Vector2f, 4> tile{corner(i, j), corner(i + 1, j), corner(i, j + 1),
                                         corner(i + 1, j + 1)};
      std::array<Vector3f, 4> places;
      std::transform(tile.begin(), tile.end(), places.begin(), [&](const Vector2f& p) -> Vector3f {
        return ground.centre + p.x() * ground.along + p.y() * ground.across;
      });
      std::vector<Vector2f>& corners = shadows.may_fall_on(places) ? shaded : grounds.corners;
      for (const std::size_t k : {0u, 1u, 2u, 2u, 1u, 3u}) corners.push_back(tile[k]);
    }
  }
  ground.shaded.first = static_cast<std::uint32_t>(grounds.corners.size());
  ground.lit.count = ground.shaded.first - ground.lit.first;
  ground.shaded.count = static_cast<std::uint32_t>(shaded.size());
  grounds.corners.insert(grounds.corners.end(), shaded.begin(), shaded.end());
}

}  // namespace

FloorPlane floor_plane(const SceneFrame& frame, float height) {
  for (const Ground& ground : frame.grounds) {
    PlaneAxes axes;
    if (ground.is_floor && plane_axes(ground, axes)) {
      return {Vector3f(ground.centre.data()), axes.along, axes.across, axes.normal};
    }
  }
  FloorPlane level;
  level.point.z() = height;
  return level;
}

Grounds grounds_of(const SceneFrame& frame, const Vector3f& eye, bool walls_first, const Shadows& shadows,
                   LeftOut& left_out) {
  Grounds grounds;
  const auto [low, high] = drawable_bounds(frame);
  grounds.focus = (low + high) / 2;
  grounds.fade_radius = 2.2f * (high - low).norm();
  grounds.wall = wall_before_which_the_floor_lies(frame, eye);
  for (const Ground& ground : frame.grounds) {
    PlaneAxes axes;
    if (!plane_axes(ground, axes)) {
      ++left_out.grounds;
      continue;
    }
    Vector2f half(ground.half_length, ground.half_width);
    const bool upright = std::abs(axes.normal.z()) < 0.5f;
    if (upright && std::abs(axes.along.z()) > std::abs(axes.across.z())) {
      std::swap(axes.along, axes.across);
      std::swap(half.x(), half.y());
    }
    if (upright && axes.across.z() < 0) axes.across = -axes.across;
    const Vector3f centre(ground.centre.data());
    const Vector2f focus(axes.along.dot(grounds.focus - centre), axes.across.dot(grounds.focus - centre));
    const Vector2f from = (focus.array() - grounds.fade_radius).max(-half.array());
    const Vector2f to = (focus.array() + grounds.fade_radius).min(half.array());
    if ((from.array() >= to.array()).any()) continue;
    DrawnGround drawn{centre,
                      axes.along,
                      axes.across,
                      axes.normal,
                      half,
                      Vector2f(0, upright ? -half.y() : 0),
                      ground.is_floor,
                      axes.normal.dot(eye - centre) < 0,
                      {},
                      {}};
    push_tiles(grounds, drawn, from, to, shadows);
    grounds.grounds.push_back(drawn);
  }
  std::stable_partition(grounds.grounds.begin(), grounds.grounds.end(), [&](const DrawnGround& ground) {
    return walls_first ? !ground.is_floor && !ground.seen_from_behind : ground.is_floor;
  });
  return grounds;
}

}  // namespace topple::render
