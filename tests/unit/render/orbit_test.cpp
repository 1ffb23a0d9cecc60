#include "render/scene/orbit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

namespace topple::render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr NamedView k_views[] = {NamedView::front, NamedView::side, NamedView::top, NamedView::iso};
constexpr float k_width = 800;
constexpr float k_height = 500;
constexpr float k_aspect = k_width / k_height;

SceneFrame room() {
  SceneFrame frame;
  frame.bounds_min = {-0.5f, -2, 0};
  frame.bounds_max = {0.7f, 1, 2.1f};
  return frame;
}

/// px from the upper left corner of the region.
Vector2f seen(const Orbit& orbit, const Vector3f& point) {
  const Camera camera = orbit.camera(k_aspect);
  const Eigen::Vector4f clip = camera.projection * (camera.view * point.homogeneous());
  return {k_width * (0.5f + 0.5f * clip.x() / clip.w()), k_height * (0.5f - 0.5f * clip.y() / clip.w())};
}

/// The point at the target's depth that is seen at a pixel.
Vector3f at_target_depth(const Orbit& orbit, float x, float y) {
  const Eigen::Matrix3f axes = sight_axes(orbit.sight);
  const float m = 2 * std::tan(k_vertical_fov / 2) * orbit.distance / k_height;
  return orbit.target + m * ((x - k_width / 2) * axes.row(0) - (y - k_height / 2) * axes.row(1)).transpose();
}

TEST(Orbit, fitted_views_look_as_fit_camera_does_and_hold_the_whole_bounds) {
  const SceneFrame frame = room();
  for (const NamedView view : k_views) {
    for (const float aspect : {0.5f, 1.0f, 1.6f, 3.0f}) {
      SCOPED_TRACE(testing::Message() << "view " << static_cast<int>(view) << " aspect " << aspect);
      const Camera camera = Orbit::fit(view, frame, aspect).camera(aspect);
      const Camera wanted = fit_camera(view, frame, aspect);
      EXPECT_TRUE((camera.view.topLeftCorner<3, 3>().isApprox(wanted.view.topLeftCorner<3, 3>(), 1e-5f)));
      EXPECT_EQ(camera.projection(0, 0), wanted.projection(0, 0));
      EXPECT_EQ(camera.projection(1, 1), wanted.projection(1, 1));
      float reach = 0;
      for (int i = 0; i < 8; ++i) {
        const Vector3f corner(i & 1 ? frame.bounds_max[0] : frame.bounds_min[0],
                              i & 2 ? frame.bounds_max[1] : frame.bounds_min[1],
                              i & 4 ? frame.bounds_max[2] : frame.bounds_min[2]);
        const Eigen::Vector4f clip = camera.projection * (camera.view * corner.homogeneous());
        reach = std::max(reach, (clip.head<3>() / clip.w()).head<2>().cwiseAbs().maxCoeff());
        EXPECT_LT(std::abs(clip.z()), clip.w());
      }
      EXPECT_NEAR(reach, 0.92f, 1e-3f);
    }
  }
}

TEST(Orbit, pan_moves_the_target_by_the_pixels) {
  for (const NamedView view : k_views) {
    Orbit orbit = Orbit::fit(view, room(), k_aspect);
    const Vector3f point = orbit.target;
    const Vector2f before = seen(orbit, point);
    orbit.pan(37, -21, k_height);
    EXPECT_TRUE((seen(orbit, point) - before).isApprox(Vector2f(37, -21), 1e-3f))
        << "moved by " << (seen(orbit, point) - before).transpose();
  }
}

TEST(Orbit, zoom_keeps_the_point_under_the_cursor_and_its_inverse_takes_it_back) {
  for (const NamedView view : k_views) {
    for (const float factor : {1.25f, 0.7f, 3.0f}) {
      const Orbit fitted = Orbit::fit(view, room(), k_aspect);
      Orbit orbit = fitted;
      const Vector3f point = at_target_depth(orbit, 610, 120);
      orbit.zoom(factor, 610, 120, k_width, k_height);
      EXPECT_NEAR(orbit.distance, fitted.distance / factor, 1e-4f * fitted.distance);
      EXPECT_LT((seen(orbit, point) - Vector2f(610, 120)).norm(), 0.05f);
      orbit.zoom(1 / factor, 610, 120, k_width, k_height);
      EXPECT_LT((orbit.target - fitted.target).norm(), 1e-4f);
      EXPECT_NEAR(orbit.distance, fitted.distance, 1e-4f);
    }
  }
}

TEST(Orbit, zoom_at_its_limit_changes_nothing) {
  Orbit orbit = Orbit::fit(NamedView::iso, room(), k_aspect);
  orbit.zoom(1e9f, k_width / 2, k_height / 2, k_width, k_height);
  const Orbit nearest = orbit;
  orbit.zoom(1.5f, 10, 10, k_width, k_height);
  EXPECT_EQ(orbit.distance, nearest.distance);
  EXPECT_EQ(orbit.target, nearest.target);
}

TEST(Orbit, rotation_turns_the_scene_with_the_hand_about_the_target) {
  Orbit orbit = Orbit::fit(NamedView::front, room(), k_aspect);
  const Vector3f target = orbit.target;
  const Vector2f middle = seen(orbit, target);
  const Vector3f in_front = target + 0.3f * Vector3f(sight_axes(orbit.sight).row(2));
  orbit.rotate(20, 10);
  EXPECT_GT(seen(orbit, in_front).x(), middle.x() + 1);
  EXPECT_GT(seen(orbit, in_front).y(), middle.y() + 1);
  EXPECT_LT((seen(orbit, target) - middle).norm(), 0.05f);
  EXPECT_EQ(orbit.target, target);
  for (int i = 0; i < 50; ++i) orbit.rotate(0, 30);
  EXPECT_NEAR(orbit.sight.elevation, 1.5707963f, 1e-6f);
  for (int i = 0; i < 50; ++i) orbit.rotate(0, -30);
  EXPECT_LT(orbit.sight.elevation, -0.5f);
  EXPECT_GT(orbit.sight.elevation, -1.5f);
}

TEST(Orbit, between_starts_and_ends_exactly_and_goes_the_shorter_way) {
  Orbit a = Orbit::fit(NamedView::iso, room(), k_aspect);
  Orbit b = Orbit::fit(NamedView::top, room(), k_aspect);
  a.sight.azimuth = 3.0f;
  b.sight.azimuth = -3.0f;
  for (const bool end : {false, true}) {
    const Orbit& wanted = end ? b : a;
    const Orbit at = Orbit::between(a, b, end ? 1.0f : 0.0f);
    EXPECT_EQ(at.camera(k_aspect).view, wanted.camera(k_aspect).view);
  }
  EXPECT_GT(std::abs(Orbit::between(a, b, 0.5f).sight.azimuth), 3);
  float last = a.sight.elevation;
  for (float u = 0.05f; u < 1; u += 0.05f) {
    const float elevation = Orbit::between(a, b, u).sight.elevation;
    EXPECT_GT(elevation, last);
    last = elevation;
  }
}

TEST(Orbit, keeps_what_moves_in_the_picture_and_else_stands_still) {
  for (const NamedView view : k_views) {
    Orbit orbit = Orbit::fit(view, room(), k_aspect);
    const Orbit before = orbit;
    const Vector3f stands[] = {{0.1f, 0, 0.2f}, {0, -0.3f, 1.5f}};
    orbit.keep(stands, k_aspect, 0.2f);
    EXPECT_EQ(orbit.target, before.target);
    EXPECT_EQ(orbit.distance, before.distance);
    const Vector3f scattered[] = {{0.1f, 0, 0.2f}, {4, -3, 0}, {-2, 5, 1}};
    for (int i = 0; i < 60; ++i) orbit.keep(scattered, k_aspect, 0.2f);
    for (const Vector3f& point : scattered) {
      const Vector2f at = seen(orbit, point);
      EXPECT_TRUE(at.x() > 0 && at.x() < k_width && at.y() > 0 && at.y() < k_height) << at.transpose();
    }
    EXPECT_EQ(orbit.sight.azimuth, before.sight.azimuth);
    const Vector3f lost[] = {{std::numeric_limits<float>::quiet_NaN(), 0, 0}};
    orbit.keep(lost, k_aspect, 0.2f);
    EXPECT_TRUE(orbit.target.allFinite());
  }
}

TEST(Orbit, no_movement_makes_it_infinite) {
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> wild = {0, -1, 1e-30f, 1e30f, -1e30f, 3e38f, infinity, -infinity, std::nanf("")};
  SceneFrame broken = room();
  broken.bounds_max[1] = infinity;
  for (const float x : wild) {
    for (const float y : wild) {
      for (int move = 0; move < 5; ++move) {
        Orbit orbit = Orbit::fit(NamedView::iso, broken, k_aspect);
        if (move == 0) orbit.rotate(x, y);
        if (move == 1) orbit.pan(x, y, k_height);
        if (move == 2) orbit.pan(30, 20, y);
        if (move == 3) orbit.zoom(x, y, 100, k_width, k_height);
        if (move == 4) orbit.zoom(2, 100, x, k_width, y);
        const Camera camera = orbit.camera(k_aspect);
        EXPECT_TRUE(finite(camera)) << "move " << move << " by " << x << ", " << y;
        EXPECT_LE((orbit.target - orbit.middle).norm(), 5.001f * orbit.size);
      }
    }
  }
  EXPECT_TRUE(
      finite(Orbit::between(Orbit(), Orbit::fit(NamedView::top, room(), 1), std::nanf("")).camera(1)));
}

}  // namespace
}  // namespace topple::render
