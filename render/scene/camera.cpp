#include "render/scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "render/scene/drawable.h"

namespace topple::render {
namespace {

using Eigen::Matrix3f;
using Eigen::Matrix4f;
using Eigen::Vector3f;

Matrix4f perspective(float aspect, float near, float far) {
  const float focal = 1 / std::tan(k_vertical_fov / 2);
  Matrix4f p = Matrix4f::Zero();
  p(0, 0) = focal / aspect;
  p(1, 1) = focal;
  p(2, 2) = (far + near) / (near - far);
  p(2, 3) = 2 * far * near / (near - far);
  p(3, 2) = -1;
  return p;
}

std::array<Vector3f, 8> corners(const Vector3f& low, const Vector3f& high) {
  std::array<Vector3f, 8> result;
  for (std::size_t i = 0; i < 8; ++i) {
    result[i] = {i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()};
  }
  return result;
}

/// Least range of `slope` s and offsets along one picture axis. A point (u, w) (across, towards the
/// viewer) is inside when low <= (u - u0) / (w0 - w) <= high, so u + high w <= u0 + high w0 and
/// u + low w >= u0 + low w0: two lines whose crossing gives the nearest eye.
struct AxisFit {
  float greatest = -std::numeric_limits<float>::infinity();  // of u + high w
  float least = std::numeric_limits<float>::infinity();      // of u + low w
  float low, high;

  void add(float u, float w) {
    greatest = std::max(greatest, u + high * w);
    least = std::min(least, u + low * w);
  }
  float nearest() const { return (greatest - least) / (high - low); }
  float centred(float w0) const { return ((greatest - high * w0) + (least - low * w0)) / 2; }
};

}  // namespace

Sight sight_of(NamedView view) {
  Sight degrees{-62, 16};
  if (view == NamedView::front) degrees = {0, 4};
  if (view == NamedView::side) degrees = {-90, 4};
  if (view == NamedView::top) degrees = {-90, 90};
  return {degrees.azimuth * std::numbers::pi_v<float> / 180,
          degrees.elevation * std::numbers::pi_v<float> / 180};
}

Matrix3f sight_axes(const Sight& sight) {
  const Vector3f back(std::cos(sight.azimuth) * std::cos(sight.elevation),
                      std::sin(sight.azimuth) * std::cos(sight.elevation), std::sin(sight.elevation));
  const Vector3f right(-std::sin(sight.azimuth), std::cos(sight.azimuth), 0);
  Matrix3f rows;
  rows.row(0) = right;
  rows.row(1) = back.cross(right);
  rows.row(2) = back;
  return rows;
}

Camera fit_box(const Matrix3f& axes, const Vector3f& low, const Vector3f& high, const Room& room,
               float aspect) {
  const float half = std::tan(k_vertical_fov / 2);
  AxisFit across;
  across.low = room.left * half * aspect;
  across.high = room.right * half * aspect;
  AxisFit upward;
  upward.low = room.bottom * half;
  upward.high = room.top * half;
  float foremost = -std::numeric_limits<float>::infinity();
  for (const Vector3f& point : corners(low, high)) {
    const Vector3f p = axes * point;
    across.add(p.x(), p.z());
    upward.add(p.y(), p.z());
    foremost = std::max(foremost, p.z());
  }
  const float size = (high - low).norm();
  const float back = std::max({across.nearest(), upward.nearest(), foremost + 0.1f * size});
  const Vector3f eye = axes.transpose() * Vector3f(across.centred(back), upward.centred(back), back);
  const float near = std::max(0.2f * (back - foremost), 0.01f * size);
  return camera_at(eye, axes, aspect, near, back - foremost + 30 * size);
}

Camera carried(const Camera& camera, const Vector3f& by) {
  Camera there = camera;
  there.eye += by;
  there.view.topRightCorner<3, 1>() -= camera.view.topLeftCorner<3, 3>() * by;
  return there;
}

bool finite(const Camera& camera) {
  return camera.view.allFinite() && camera.projection.allFinite() && camera.eye.allFinite();
}

std::optional<NamedView> view_named(std::string_view name) {
  if (name == "front") return NamedView::front;
  if (name == "side") return NamedView::side;
  if (name == "top") return NamedView::top;
  if (name == "iso") return NamedView::iso;
  return std::nullopt;
}

Camera camera_at(const Vector3f& eye, const Matrix3f& axes, float aspect, float near, float far) {
  Matrix4f view = Matrix4f::Identity();
  view.topLeftCorner<3, 3>() = axes;
  view.topRightCorner<3, 1>() = -axes * eye;
  return {view, perspective(aspect, near, far), eye};
}

Camera look_at(const Vector3f& eye, const Vector3f& target, const Vector3f& up, float aspect, float near,
               float far) {
  Matrix3f rows;
  rows.row(2) = (eye - target).normalized();
  rows.row(0) = up.cross(Vector3f(rows.row(2))).normalized();
  rows.row(1) = Vector3f(rows.row(2)).cross(Vector3f(rows.row(0)));
  return camera_at(eye, rows, aspect, near, far);
}

Camera fit_camera(NamedView view, const SceneFrame& frame, float aspect) {
  const std::pair<Vector3f, Vector3f> bounds = drawable_bounds(frame);
  const Vector3f &low = bounds.first, &high = bounds.second;
  // exactly along the axes from above, where rounding would turn the picture
  const Matrix3f rows = view == NamedView::top ? Matrix3f::Identity() : sight_axes(sight_of(view));
  Room room{-0.92f, 0.92f, -0.84f, 0.72f};
  if (!frame.legend.quantity.empty()) room.right = 0.68f;
  Camera whole = fit_box(rows, low, high, room, aspect);
  // What lies in the corners on the left: bodies that would stand behind it go beside it or to its other
  // side, whichever shows them larger.
  std::vector<Room> rooms{room};
  const auto keep_off = [&](float right, bool is_covered, float Room::*side, float edge) {
    if (!is_covered) return;
    for (std::size_t i = 0, count = rooms.size(); i < count; ++i) {
      rooms.push_back(rooms[i]);
      rooms.back().left = std::max(rooms.back().left, right);
      rooms[i].*side = edge;
    }
  };
  const auto covers = [&](float right, float sign, float edge) {
    const std::array<Vector3f, 8> points = corners(low, high);
    return std::any_of(points.begin(), points.end(), [&](const Vector3f& point) {
      const Eigen::Vector4f clip = whole.projection * (whole.view * point.homogeneous());
      return clip.x() < right * clip.w() && sign * clip.y() > sign * edge * clip.w();
    });
  };
  constexpr float k_trace_right = -0.36f;
  constexpr float k_trace_top = -0.52f;
  keep_off(k_trace_right, !frame.trace.at.empty() && covers(k_trace_right, -1, k_trace_top), &Room::bottom,
           k_trace_top);
  // Lines of words below a title of one, as they are drawn on 720 px of height; smaller in narrow pictures.
  constexpr float k_first_line = 63, k_line = 22, k_height = 720, k_line_width = 430;
  const float unit = 2 * std::min(1.f, 0.75f * aspect) / k_height;
  const float words_right = -1 + unit * k_line_width / aspect;
  const float words_bottom =
      1 - unit * (k_first_line + k_line * static_cast<float>(frame.caption.most_lines));
  const bool has_words = frame.caption.most_lines > 0 && words_bottom > 0;  // else they take most of it
  keep_off(words_right, has_words && covers(words_right, 1, words_bottom), &Room::top,
           std::min(words_bottom, room.top));
  const Vector3f back = rows.row(2);
  Camera nearest = fit_box(rows, low, high, rooms.front(), aspect);
  for (const Room& other : std::span(rooms).subspan(1)) {
    const Camera camera = fit_box(rows, low, high, other, aspect);
    if (back.dot(camera.eye) < back.dot(nearest.eye)) nearest = camera;
  }
  return nearest;
}

}  // namespace topple::render
