#include "render/scene/pick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/render/off_screen.h"
#include "tests/unit/render/synthetic_cabinet.h"

namespace topple::render {
namespace {

constexpr int k_width = 640;
constexpr int k_height = 360;
constexpr float k_aspect = static_cast<float>(k_width) / k_height;

/// A beam in front of another one, seen from the front; one more on the right.
SceneFrame three_beams() {
  SceneFrame frame;
  frame.profiles = {box_profile(0.05f)};
  add_beam(frame, {-0.5f, -0.5f, 1}, {-0.5f, 0.5f, 1}, {0, 0, 0}, 0, 0, 0);
  add_beam(frame, {0.5f, -0.2f, 1}, {0.5f, 0.2f, 1}, {0, 0, 0}, 0, 0, 0);
  add_beam(frame, {0, 0.8f, 0.2f}, {0, 0.8f, 1.8f}, {0, 0, 0}, 0, 0, 0);
  for (Tube& tube : frame.tubes) {
    tube.member += 70;
    tube.body = tube.member - 60;
  }
  return frame;
}

std::optional<Pick> picked(const SceneFrame& frame, const Camera& camera, const Eigen::Vector3f& point,
                           float right = 0, float down = 0) {
  const Eigen::Vector4f clip = camera.projection * (camera.view * point.homogeneous());
  return pick(frame, camera, k_width, k_height, (0.5f + 0.5f * clip.x() / clip.w()) * k_width + right,
              (0.5f - 0.5f * clip.y() / clip.w()) * k_height + down);
}

TEST(Pick, names_the_tube_its_member_its_body_and_the_place_along_it) {
  const SceneFrame frame = three_beams();
  const Camera camera = fit_camera(NamedView::front, frame, k_aspect);
  for (const float share : {0.0f, 0.1f, 0.33f, 0.5f, 0.97f}) {
    const auto hit = picked(frame, camera, {0.05f, 0.8f, 0.2f + 1.6f * share});
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->tube, 2u);
    EXPECT_EQ(hit->member, 72u);
    EXPECT_EQ(hit->body, 12u);
    EXPECT_NEAR((static_cast<float>(hit->station) + hit->share) / 8, share, 2e-3f);
  }
}

TEST(Pick, what_is_seen_wins_over_what_it_hides) {
  const SceneFrame frame = three_beams();
  const Camera camera = look_at({5, 0, 1}, {0, 0, 1}, {0, 0, 1}, k_aspect, 0.5f, 20);
  EXPECT_EQ(picked(frame, camera, {0.55f, 0, 1})->tube, 1u);
  EXPECT_EQ(picked(frame, camera, {-0.45f, 0, 1})->tube, 1u);
  EXPECT_EQ(picked(frame, camera, {-0.45f, 0.45f, 1})->tube, 0u);  // beside the one before it
}

TEST(Pick, a_near_miss_takes_the_nearest_and_the_empty_background_nothing) {
  const SceneFrame frame = three_beams();
  const Camera camera = fit_camera(NamedView::front, frame, k_aspect);
  const Eigen::Vector3f edge(0.05f, 0.85f, 1);
  EXPECT_EQ(picked(frame, camera, edge, 4, 0)->tube, 2u);
  EXPECT_FALSE(picked(frame, camera, edge, 9, 0).has_value());
  EXPECT_FALSE(pick(frame, camera, k_width, k_height, 5, 5).has_value());
  EXPECT_FALSE(pick(frame, camera, k_width, k_height, -1e9f, 5).has_value());
}

TEST(Pick, nothing_behind_the_camera_nor_by_numbers_that_are_not_finite) {
  SceneFrame frame = three_beams();
  const Camera away = look_at({5, 0, 1}, {9, 0, 1}, {0, 0, 1}, k_aspect, 0.5f, 20);
  for (float x = 0; x < k_width; x += 16) {
    for (float y = 0; y < k_height; y += 16) {
      ASSERT_FALSE(pick(frame, away, k_width, k_height, x, y).has_value()) << x << ", " << y;
    }
  }
  Camera camera = fit_camera(NamedView::front, frame, k_aspect);
  EXPECT_FALSE(pick(frame, camera, k_width, k_height, std::nanf(""), 5).has_value());
  frame.stations[3].position[0] = std::nanf("");
  EXPECT_FALSE(picked(frame, camera, {-0.45f, 0.45f, 1}).has_value());
  camera.eye[0] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(picked(frame, camera, {0.55f, 0, 1}).has_value());
}

TEST(Pick, a_beam_that_passes_the_eye_is_picked_where_it_is_seen) {
  SceneFrame frame;
  frame.profiles = {box_profile(0.05f)};
  add_beam(frame, {-5, 0, 0.8f}, {5, 0, 0.8f}, {0, 0, 0}, 0, 0, 0, 0, 2);
  const Camera camera = look_at({0, 0, 1}, {1, 0, 1}, {0, 0, 1}, k_aspect, 0.01f, 20);
  const auto hit = picked(frame, camera, {3, 0, 0.85f});
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->share, 0.8f, 1e-3f);
}

TEST(Pick, agrees_with_the_picture_about_every_pixel) {
  SceneFrame frame = synthetic_cabinet(6);
  frame.panels.clear();
  frame.grounds.clear();
  Picture picture(off_screen(), k_width, k_height);
  const Camera camera = fit_camera(NamedView::iso, frame, k_aspect);
  const PictureOptions plain{ColourMap::viridis, false};
  const Image image = picture.draw(frame, camera, plain);
  SceneFrame nothing = frame;
  nothing.tubes.clear();
  const Image backdrop = picture.draw(nothing, camera, plain);
  int pixels = 0;
  int hidden = 0;
  for (int y = 0; y < k_height; y += 4) {
    for (int x = 0; x < k_width; x += 4) {
      if (colour_at(image, {x, y}) == colour_at(backdrop, {x, y})) continue;
      const auto hit =
          pick(frame, camera, k_width, k_height, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      ASSERT_TRUE(hit.has_value()) << x << ", " << y;
      ++pixels;
      if (pixels % 10 != 0) continue;
      SceneFrame without = frame;
      without.tubes.erase(without.tubes.begin() + static_cast<std::ptrdiff_t>(hit->tube));
      hidden += colour_at(picture.draw(without, camera, plain), {x, y}) == colour_at(image, {x, y});
    }
  }
  EXPECT_LE(hidden, pixels / 10 / 20);  // where the beams of a joint coincide, either may be named
  EXPECT_GT(pixels, 300);
}

}  // namespace
}  // namespace topple::render
