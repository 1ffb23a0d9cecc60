#include "render/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "render/drawable.h"

namespace topple::render {
namespace {

using Eigen::Matrix3f;
using Eigen::Matrix4f;
using Eigen::Vector3f;

/// Part of the picture that the bodies may take, in normalized device coordinates (-1..1).
struct Window {
  float left, right, bottom, top;
};

/// Rows: right, up, and towards the viewer.
Matrix3f axes(NamedView view) {
  struct Angles {
    float azimuth, elevation;  // degrees, of the direction from the target to the eye
  };
  Angles angles{-62, 16};
  if (view == NamedView::front) angles = {0, 4};
  if (view == NamedView::side) angles = {-90, 4};
  Matrix3f rows;
  if (view == NamedView::top) {
    rows.setIdentity();
    return rows;
  }
  const float azimuth = angles.azimuth * std::numbers::pi_v<float> / 180;
  const float elevation = angles.elevation * std::numbers::pi_v<float> / 180;
  const Vector3f back(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                      std::sin(elevation));
  const Vector3f right(-std::sin(azimuth), std::cos(azimuth), 0);
  rows.row(0) = right;
  rows.row(1) = back.cross(right);
  rows.row(2) = back;
  return rows;
}

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

Matrix4f view_matrix(const Matrix3f& rows, const Vector3f& eye) {
  Matrix4f view = Matrix4f::Identity();
  view.topLeftCorner<3, 3>() = rows;
  view.topRightCorner<3, 1>() = -rows * eye;
  return view;
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

/// The nearest camera that shows all points inside the window, and centred in it.
Camera fitted(const Matrix3f& rows, const std::array<Vector3f, 8>& points, const Window& window,
              float aspect) {
  const float half = std::tan(k_vertical_fov / 2);
  AxisFit across;
  across.low = window.left * half * aspect;
  across.high = window.right * half * aspect;
  AxisFit upward;
  upward.low = window.bottom * half;
  upward.high = window.top * half;
  float foremost = -std::numeric_limits<float>::infinity();
  for (const Vector3f& point : points) {
    const Vector3f p = rows * point;
    across.add(p.x(), p.z());
    upward.add(p.y(), p.z());
    foremost = std::max(foremost, p.z());
  }
  const float size = (points[7] - points[0]).norm();
  const float back = std::max({across.nearest(), upward.nearest(), foremost + 0.1f * size});
  const Vector3f eye = rows.transpose() * Vector3f(across.centred(back), upward.centred(back), back);
  const float near = std::max(0.2f * (back - foremost), 0.01f * size);
  return {view_matrix(rows, eye), perspective(aspect, near, back - foremost + 30 * size), eye};
}

}  // namespace

std::optional<NamedView> view_named(std::string_view name) {
  if (name == "front") return NamedView::front;
  if (name == "side") return NamedView::side;
  if (name == "top") return NamedView::top;
  if (name == "iso") return NamedView::iso;
  return std::nullopt;
}

Camera look_at(const Vector3f& eye, const Vector3f& target, const Vector3f& up, float aspect, float near,
               float far) {
  Matrix3f rows;
  rows.row(2) = (eye - target).normalized();
  rows.row(0) = up.cross(Vector3f(rows.row(2))).normalized();
  rows.row(1) = Vector3f(rows.row(2)).cross(Vector3f(rows.row(0)));
  return {view_matrix(rows, eye), perspective(aspect, near, far), eye};
}

Camera fit_camera(NamedView view, const SceneFrame& frame, float aspect) {
  const auto [low, high] = drawable_bounds(frame);
  const std::array<Vector3f, 8> points = corners(low, high);
  const Matrix3f rows = axes(view);
  Window window{-0.92f, 0.92f, -0.84f, 0.72f};
  if (!frame.legend.quantity.empty()) window.right = 0.68f;
  const Camera whole = fitted(rows, points, window, aspect);
  if (frame.trace.time_s.empty()) return whole;
  // The trace takes the lower left corner: bodies that would stand behind it go beside or above it,
  // whichever shows them larger.
  constexpr float k_trace_right = -0.36f;
  constexpr float k_trace_top = -0.52f;
  const bool covered = std::ranges::any_of(points, [&](const Vector3f& point) {
    const Eigen::Vector4f clip = whole.projection * (whole.view * point.homogeneous());
    return clip.x() < k_trace_right * clip.w() && clip.y() < k_trace_top * clip.w();
  });
  if (!covered) return whole;
  Window beside = window;
  beside.left = k_trace_right;
  Window above = window;
  above.bottom = k_trace_top;
  const Camera right_of_it = fitted(rows, points, beside, aspect);
  const Camera over_it = fitted(rows, points, above, aspect);
  const Vector3f back = rows.row(2);
  return back.dot(right_of_it.eye) <= back.dot(over_it.eye) ? right_of_it : over_it;
}

}  // namespace topple::render
