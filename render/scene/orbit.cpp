#include "render/scene/orbit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/scene/drawable.h"

namespace topple::render {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr float k_pi = std::numbers::pi_v<float>;
constexpr float k_lowest = -k_pi / 3;  // the floor seen from below hides nothing, but shows little
constexpr float k_highest = k_pi / 2;
constexpr float k_nearest = 0.02f;       // distance in sizes of the scene
constexpr float k_farthest = 20;         // the same
constexpr float k_target_reach = 5;      // the same, of the target from the scene's middle
constexpr float k_turn_per_px = 0.006f;  // rad
constexpr Room k_room{-0.92f, 0.92f, -0.92f, 0.92f};

/// Height of what one pixel shows at the target's depth, m.
float pixel_size(const Orbit& orbit, float height) {
  return 2 * std::tan(k_vertical_fov / 2) * orbit.distance / height;
}

/// The same direction in -pi..pi.
float wrapped(float angle) {
  return std::remainder(angle, 2 * k_pi);
}

void limit(Orbit& orbit) {
  orbit.sight.azimuth = wrapped(orbit.sight.azimuth);
  orbit.sight.elevation = std::clamp(orbit.sight.elevation, k_lowest, k_highest);
  orbit.distance = std::clamp(orbit.distance, k_nearest * orbit.size, k_farthest * orbit.size);
  const Vector3f away = orbit.target - orbit.middle;
  const float reach = k_target_reach * orbit.size;
  if (away.norm() > reach) orbit.target = orbit.middle + reach * away.normalized();
}

}  // namespace

Orbit Orbit::fit(NamedView view, const SceneFrame& frame, float aspect) {
  const auto [low, high] = drawable_bounds(frame);
  Orbit orbit;
  orbit.set_bounds(frame);
  orbit.sight = sight_of(view);
  const Matrix3f axes = sight_axes(orbit.sight);
  const Vector3f back = axes.row(2);
  const Vector3f eye = fit_box(axes, low, high, k_room, aspect).eye;
  orbit.distance = back.dot(eye - orbit.middle);
  orbit.target = eye - orbit.distance * back;
  limit(orbit);
  return orbit;
}

void Orbit::set_bounds(const SceneFrame& frame) {
  const auto [low, high] = drawable_bounds(frame);
  middle = (low + high) / 2;
  size = (high - low).norm();
}

void Orbit::rotate(float dx, float dy) {
  if (!std::isfinite(dx) || !std::isfinite(dy)) return;
  sight.azimuth -= k_turn_per_px * dx;
  sight.elevation += k_turn_per_px * dy;
  limit(*this);
}

void Orbit::pan(float dx, float dy, float height) {
  const Matrix3f axes = sight_axes(sight);
  const float m = pixel_size(*this, height);
  const Vector3f to = target - m * dx * axes.row(0).transpose() + m * dy * axes.row(1).transpose();
  if (!to.allFinite()) return;
  target = to;
  limit(*this);
}

void Orbit::zoom(float factor, float x, float y, float width, float height) {
  if (!(factor > 0) || !std::isfinite(factor)) return;
  Orbit to = *this;
  to.distance = distance / factor;
  limit(to);
  // The point stays when what it is off the middle by, in m, shrinks with the distance.
  const float off = pixel_size(*this, height) - pixel_size(to, height);
  const Matrix3f axes = sight_axes(sight);
  to.target += off * ((x - width / 2) * axes.row(0) - (y - height / 2) * axes.row(1)).transpose();
  if (!to.target.allFinite() || !std::isfinite(to.distance)) return;
  limit(to);
  *this = to;
}

void Orbit::keep(std::span<const Vector3f> points, float aspect, float share) {
  if (points.empty()) return;
  const Matrix3f axes = sight_axes(sight);
  const Eigen::Array2f half = std::tan(k_vertical_fov / 2) * Eigen::Array2f(aspect, 1);
  Eigen::Array2f low = Eigen::Array2f::Constant(std::numeric_limits<float>::max()), high = -low;
  for (const Vector3f& point : points) {
    if (!point.allFinite()) return;
    const Vector3f off = axes * (point - target);  // right, up, towards the eye
    const float depth = std::max(distance - off.z(), 0.05f * distance);
    const Eigen::Array2f at = off.head<2>().array() / (depth * half);
    low = low.min(at);
    high = high.max(at);
  }
  const float wide = ((high - low) / (2 * k_room.right)).maxCoeff();
  Eigen::Array2f aside = (high + low) / 2;  // of what fits: no farther than its edge asks for
  if (wide <= 1) aside = (high - k_room.right).max(0) + (low + k_room.right).min(0);
  if (wide <= 1 && (aside == 0).all()) return;
  const Vector3f by(aside.x() * half.x(), aside.y() * half.y(), 0);
  target += share * distance * axes.transpose() * by;
  distance *= 1 + share * (std::max(wide, 1.0f) - 1);
  limit(*this);
}

float Orbit::distance_for(float aspect, float seen) const {
  const float narrower = std::max(seen / aspect, 1.0f);
  const float behind = std::max(sight_axes(sight).row(2).dot(target - middle) + size / 2, 0.0f);
  return narrower * distance + (narrower - 1) * behind;  // what is behind the target nears the edges
}

Camera Orbit::camera(float aspect) const {
  const Matrix3f axes = sight_axes(sight);
  const Vector3f back = axes.row(2);
  const Vector3f eye = target + distance * back;
  const float depth = back.dot(eye - middle);
  // As far before the eye as nothing of the scene is lost: near planes cost precision of depth.
  const float near = std::max(0.2f * (depth - size / 2), 0.002f * size);
  return camera_at(eye, axes, aspect, near, std::max(depth, 0.0f) + 30 * size);
}

Orbit Orbit::between(const Orbit& a, const Orbit& b, float u) {
  if (!(u > 0)) return a;
  if (u >= 1) return b;
  const float s = u * u * (3 - 2 * u);
  Orbit orbit = b;
  orbit.target = a.target + s * (b.target - a.target);
  orbit.distance = a.distance * std::pow(b.distance / a.distance, s);
  orbit.sight.azimuth = wrapped(a.sight.azimuth + s * wrapped(b.sight.azimuth - a.sight.azimuth));
  orbit.sight.elevation = a.sight.elevation + s * (b.sight.elevation - a.sight.elevation);
  return orbit;
}

}  // namespace topple::render
