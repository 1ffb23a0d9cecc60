#include "render/scene/pick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "render/scene/mesh.h"

namespace topple::render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr float k_reach = 6;     // px, beside a tube's picture
constexpr float k_same = 0.25f;  // px: what is as near as that is told apart by depth

/// The place of a triangle's picture that is nearest to a pixel.
struct Place {
  float away = std::numeric_limits<float>::infinity();   // px
  float depth = std::numeric_limits<float>::infinity();  // normalized device coordinate
  Vector2f at = Vector2f::Zero();                        // px

  bool before(const Place& other) const {
    return away < other.away - k_same || (away < other.away + k_same && depth < other.depth);
  }
};

float cross(const Vector2f& a, const Vector2f& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// px and depth of a point before the near plane.
using Corner = Vector3f;

/// The nearest place of a convex outline; x, y of the corners are counted from the pixel.
Place nearest(const std::array<Corner, 4>& corners, std::size_t count) {
  const Vector2f a = corners[0].head<2>();
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const Vector2f b = corners[i].head<2>();
    const Vector2f c = corners[i + 1].head<2>();
    const float area = cross(b - a, c - a);
    const float to_b = cross(-a, c - a) / area;
    const float to_c = cross(b - a, -a) / area;
    if (area != 0 && to_b >= 0 && to_c >= 0 && to_b + to_c <= 1) {
      const float depth = corners[0].z() + to_b * (corners[i].z() - corners[0].z()) +
                          to_c * (corners[i + 1].z() - corners[0].z());
      return {0, depth, Vector2f::Zero()};
    }
  }
  Place best;
  for (std::size_t i = 0; i < count; ++i) {
    const Corner& from = corners[i];
    const Corner along = corners[(i + 1) % count] - from;
    const float length2 = along.head<2>().squaredNorm();
    const float share =
        length2 > 0 ? std::clamp(-from.head<2>().dot(along.head<2>()) / length2, 0.0f, 1.0f) : 0.0f;
    const Corner at = from + share * along;
    const Place place{at.head<2>().norm(), at.z(), at.head<2>()};
    if (place.before(best)) best = place;
  }
  return best;
}

/// A pixel of a picture, and how points come to it.
struct Probe {
  Matrix4f to_clip;
  Vector2f half;  // of the picture, px
  Vector2f pixel;

  Vector4f clip(const Vector3f& point) const { return to_clip * point.homogeneous(); }

  Corner corner(const Vector4f& clip) const {
    const Vector3f device = clip.head<3>() / clip.w();
    return {half.x() * (1 + device.x()) - pixel.x(), half.y() * (1 - device.y()) - pixel.y(), device.z()};
  }

  Vector3f point(const Place& place) const {
    const Vector2f at = (place.at + pixel).cwiseQuotient(half);
    const Vector4f p = to_clip.inverse() * Vector4f(at.x() - 1, 1 - at.y(), place.depth, 1);
    return p.head<3>() / p.w();
  }

  /// The nearest place of a triangle's part beyond the near plane.
  Place place(const std::array<Vector4f, 3>& triangle) const {
    std::array<Corner, 4> corners;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector4f& a = triangle[i];
      const Vector4f& b = triangle[(i + 1) % 3];
      const float a_beyond = a.z() + a.w();
      const float b_beyond = b.z() + b.w();
      if (a_beyond > 0) corners[count++] = corner(a);
      if ((a_beyond > 0) != (b_beyond > 0))
        corners[count++] = corner(a + a_beyond / (a_beyond - b_beyond) * (b - a));
    }
    for (int axis = 0; axis < 2; ++axis) {
      const auto [low, high] =
          std::minmax_element(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count),
                              [=](const Corner& p, const Corner& q) { return p[axis] < q[axis]; });
      if (count < 3 || (*low)[axis] > k_reach || (*high)[axis] < -k_reach) return {};
    }
    return nearest(corners, count);
  }
};

/// Where along the tube's centre line a point of its surface lies.
void place_along(const SceneFrame& frame, const Tube& tube, const Vector3f& point, Pick& pick) {
  float least = std::numeric_limits<float>::infinity();
  for (std::uint32_t i = 0; i + 1 < tube.station_count; ++i) {
    const Vector3f from(frame.stations[tube.first_station + i].position.data());
    const Vector3f along = Vector3f(frame.stations[tube.first_station + i + 1].position.data()) - from;
    const float length2 = along.squaredNorm();
    const float share = length2 > 0 ? std::clamp((point - from).dot(along) / length2, 0.0f, 1.0f) : 0.0f;
    const float away = (from + share * along - point).norm();
    if (away < least) {
      least = away;
      pick.station = i;
      pick.share = share;
    }
  }
}

}  // namespace

std::optional<Pick> pick(const SceneFrame& frame, const Camera& camera, int width, int height, float x,
                         float y) {
  if (!finite(camera) || !std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
  const Probe probe{camera.projection * camera.view,
                    {static_cast<float>(width) / 2, static_cast<float>(height) / 2},
                    {x, y}};
  LeftOut left_out;
  const Mesh mesh = solid_mesh(frame, left_out);
  Place best;
  std::size_t hit = mesh.tubes.size();
  for (std::size_t t = 0; t < mesh.tubes.size(); ++t) {
    const IndexRange& range = mesh.tubes[t];
    for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
      std::array<Vector4f, 3> triangle;
      for (std::uint32_t c = 0; c < 3; ++c) {
        triangle[c] = probe.clip(mesh.vertices[mesh.indices[i + c]].position);
      }
      const Place place = probe.place(triangle);
      if (place.away <= k_reach && place.before(best)) {
        best = place;
        hit = t;
      }
    }
  }
  if (hit == mesh.tubes.size()) return std::nullopt;
  const Tube& tube = frame.tubes[hit];
  Pick pick{hit, tube.member, tube.body, 0, 0};
  place_along(frame, tube, probe.point(best), pick);
  return pick;
}

}  // namespace topple::render
