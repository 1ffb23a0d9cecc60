#include "render/scene/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace topple::render {
namespace {

constexpr NamedView k_views[] = {NamedView::front, NamedView::side, NamedView::top, NamedView::iso};

Eigen::Vector3f seen(const Camera& camera, const Eigen::Vector3f& point) {
  const Eigen::Vector4f clip = camera.projection * (camera.view * point.homogeneous());
  return clip.head<3>() / clip.w();
}

TEST(Camera, every_named_view_holds_the_whole_bounds_and_touches_their_limits) {
  const Float3 boxes[][2] = {{{-1, -1, 0}, {1, 1, 2}},
                             {{-0.3f, -0.5f, 0}, {0.4f, 0.5f, 1.9f}},
                             {{10, -40, 0}, {60, 40, 1}},
                             {{-0.01f, -0.01f, 0}, {0.01f, 0.01f, 5}}};
  for (const bool with_words : {false, true}) {
    for (const auto& box : boxes) {
      SceneFrame frame;
      frame.bounds_min = box[0];
      frame.bounds_max = box[1];
      if (with_words) {
        frame.legend.quantity = "stress";
        frame.trace.at = {0, 1};
        frame.trace.value = {0, 1};
      }
      for (const NamedView view : k_views) {
        for (const float aspect : {0.5f, 1.0f, 4.0f / 3, 16.0f / 9, 3.0f}) {
          const Camera camera = fit_camera(view, frame, aspect);
          float reach = 0;  // 1: at the border of the part of the picture that bodies may take
          for (int i = 0; i < 8; ++i) {
            const Eigen::Vector3f corner(box[i & 1][0], box[(i >> 1) & 1][1], box[(i >> 2) & 1][2]);
            const Eigen::Vector3f p = seen(camera, corner);
            SCOPED_TRACE(testing::Message()
                         << "view " << static_cast<int>(view) << " aspect " << aspect << " corner "
                         << corner.transpose() << " seen at " << p.transpose());
            EXPECT_LE(p.cwiseAbs().maxCoeff(), 1.0f);
            reach = std::max({reach, std::abs(p.x()) / 0.92f, p.y() / 0.72f, -p.y() / 0.84f});
          }
          if (!with_words && box[1][2] < 3) {  // before a tower seen from above the eye keeps its distance
            EXPECT_NEAR(reach, 1, 1e-3f) << "view " << static_cast<int>(view) << " aspect " << aspect;
          }
        }
      }
    }
  }
}

// The words of draw_overlay on 720 lines: 22 px a line below the title, some 430 px wide.
TEST(Camera, bodies_do_not_stand_behind_the_words_of_the_caption) {
  for (const int lines : {3, 6, 10})
    for (const NamedView view : k_views)
      for (const float aspect : {4.0f / 3, 16.0f / 9}) {
        SceneFrame frame;
        frame.bounds_min = {-3, -4, 0};
        frame.bounds_max = {3, 4, 2};
        frame.legend.quantity = "stress";
        frame.caption.most_lines = lines;
        const Camera camera = fit_camera(view, frame, aspect);
        const float right = -1 + 2 * 429 / (720 * aspect);
        const float bottom = 1 - 2 * (63 + 22 * static_cast<float>(lines) - 1) / 720;
        for (int i = 0; i < 8; ++i) {
          const Eigen::Vector3f p = seen(camera, {i & 1 ? 3.f : -3.f, i & 2 ? 4.f : -4.f, i & 4 ? 2.f : 0.f});
          EXPECT_FALSE(p.x() < right && p.y() > bottom)
              << lines << " lines, view " << static_cast<int>(view) << " at " << p.transpose();
        }
      }
}

TEST(Camera, views_look_where_the_header_says) {
  SceneFrame frame;
  const Eigen::Vector3f o(0, 0, 1);
  const auto moves = [&](NamedView view, const Eigen::Vector3f& by) {
    const Camera camera = fit_camera(view, frame, 1.5f);
    return Eigen::Vector3f(seen(camera, o + 0.1f * by) - seen(camera, o));
  };
  EXPECT_GT(moves(NamedView::front, {0, 1, 0}).x(), 0.01f);
  EXPECT_GT(moves(NamedView::side, {1, 0, 0}).x(), 0.01f);
  EXPECT_GT(moves(NamedView::top, {1, 0, 0}).x(), 0.01f);
  EXPECT_GT(moves(NamedView::top, {0, 1, 0}).y(), 0.01f);
  EXPECT_GT(moves(NamedView::iso, {1, 0, 0}).x(), 0.01f);
  for (const NamedView view : {NamedView::front, NamedView::side, NamedView::iso}) {
    EXPECT_GT(moves(view, {0, 0, 1}).y(), 0.01f);
  }
  EXPECT_GT(fit_camera(NamedView::front, frame, 1.5f).eye.x(), 1);
  EXPECT_LT(fit_camera(NamedView::side, frame, 1.5f).eye.y(), -1);
  EXPECT_GT(fit_camera(NamedView::top, frame, 1.5f).eye.z(), 2);
  EXPECT_GT(fit_camera(NamedView::iso, frame, 1.5f).eye.x(), 0);
}

TEST(Camera, look_at_puts_the_target_in_the_middle) {
  const Camera camera = look_at({3, -4, 2}, {0.5f, 0.2f, 1}, {0, 0, 1}, 1.6f, 0.1f, 50);
  const Eigen::Vector3f p = seen(camera, {0.5f, 0.2f, 1});
  EXPECT_NEAR(p.x(), 0, 1e-5f);
  EXPECT_NEAR(p.y(), 0, 1e-5f);
  EXPECT_GT(seen(camera, {0.5f, 0.2f, 1.1f}).y(), 0);
}

TEST(Camera, bounds_that_are_not_finite_give_the_default_view) {
  SceneFrame broken;
  broken.bounds_max[1] = std::numeric_limits<float>::quiet_NaN();
  const Camera camera = fit_camera(NamedView::iso, broken, 1.5f);
  EXPECT_EQ(camera.view, fit_camera(NamedView::iso, SceneFrame(), 1.5f).view);
}

TEST(Camera, names_are_known) {
  EXPECT_EQ(view_named("side"), NamedView::side);
  EXPECT_FALSE(view_named("Side").has_value());
}

}  // namespace
}  // namespace topple::render
