#include "render/output/stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "tests/unit/render/off_screen.h"
#include "tests/unit/render/read_png.h"
#include "tests/unit/render/scratch.h"
#include "tests/unit/render/staged.h"

namespace topple::render {
namespace {

double mean_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(double{1} * a.rgba[i] - b.rgba.at(i));
  return sum / static_cast<double>(a.rgba.size());
}

/// The scene's region of a shot without an interface.
Image region(Staged& staged) {
  return staged.stage.shot({k_scene_width, k_scene_height}, staged.no_interface());
}

Image scene(Staged& staged, const SceneFrame& frame, Quality quality = Quality::still) {
  staged.draw_scene(frame, quality);
  return region(staged);
}

TEST(Stage, a_portrait_leaves_what_was_drawn_and_survives_as_a_file) {
  Staged staged(off_screen());
  const SceneFrame other = synthetic_cabinet(2);
  const Image first = scene(staged, synthetic_cabinet(6));
  const Image portrait =
      staged.stage.portrait(other, fit_camera(NamedView::iso, other, 1.6f), ColourMap::viridis, 320, 200);
  EXPECT_TRUE(region(staged) == first);
  const Scratch scratch;
  write_png(scratch / "portrait.png", portrait);
  EXPECT_TRUE(load_png(scratch / "portrait.png") == portrait);
  std::ofstream(scratch / "broken.png") << file_bytes(scratch / "portrait.png").substr(0, 300);
  EXPECT_FALSE(load_png(scratch / "broken.png").has_value());
  EXPECT_FALSE(load_png(scratch / "none.png").has_value());
}

TEST(Stage, shows_the_same_twice_whatever_was_drawn_between) {
  Staged staged(off_screen());
  for (const Quality quality : {Quality::interactive, Quality::still}) {
    staged.draw_scene(synthetic_cabinet(6), quality);
    const Image first = staged.stage.shot(k_surface, staged.panel());
    EXPECT_TRUE(staged.stage.shot(k_surface, staged.panel()) == first);
    staged.stage.draw_scene(synthetic_cabinet(2), {}, ColourMap::cividis, 200, 100, Quality::still);
    staged.stage.shot({300, 200}, staged.panel());
    staged.draw_scene(synthetic_cabinet(6), quality);
    EXPECT_TRUE(staged.stage.shot(k_surface, staged.panel()) == first);
  }
}

TEST(Stage, a_still_scene_is_the_picture_without_its_overlay) {
  const SceneFrame frame = synthetic_cabinet(6);
  Picture picture(off_screen(), k_scene_width, k_scene_height);
  const Image wanted =
      picture.draw(frame, fit_camera(NamedView::iso, frame, picture.aspect()), {ColourMap::viridis, false});
  Staged staged(off_screen());
  EXPECT_TRUE(scene(staged, frame) == wanted);
}

// No scene is drawn in no time, every one in a minute.
TEST(Stage, draws_coarser_what_takes_longer_than_its_budget) {
  Staged staged(off_screen());
  if (!staged.stage.software()) GTEST_SKIP() << "draws at full size";
  const SceneFrame frame = synthetic_cabinet(6);
  const Image full = scene(staged, frame, Quality::interactive);
  staged.stage.set_budget(0);
  EXPECT_TRUE(scene(staged, frame, Quality::interactive) == full);  // from the next one on
  const Image coarser = scene(staged, frame, Quality::interactive);
  EXPECT_EQ(coarser.width, full.width);
  EXPECT_FALSE(coarser == full);
  EXPECT_LT(mean_difference(coarser, full), 3);
  const Image still = scene(staged, frame);
  staged.stage.set_budget(60);
  for (int i = 0; i < 2; ++i) scene(staged, frame, Quality::interactive);
  EXPECT_TRUE(scene(staged, frame, Quality::interactive) == full);
  staged.stage.set_budget(0);
  for (int i = 0; i < 8; ++i) scene(staged, frame, Quality::interactive);
  EXPECT_TRUE(scene(staged, frame) == still);  // at its best whatever the budget
  staged.stage.set_budget(std::nullopt);
  EXPECT_TRUE(scene(staged, frame, Quality::interactive) == full);
}

TEST(Stage, an_interactive_scene_is_close_to_the_still_one) {
  Staged staged(off_screen());
  const SceneFrame frame = synthetic_cabinet(6);
  const Image still = scene(staged, frame);
  EXPECT_LT(mean_difference(scene(staged, frame, Quality::interactive), still), 3);
  if (staged.stage.software()) {
    EXPECT_FALSE(scene(staged, frame, Quality::interactive) == still);
  }
}

TEST(Stage, puts_the_scene_into_its_region_and_the_interface_over_it) {
  Staged staged(off_screen());
  const Image alone = scene(staged, synthetic_cabinet(6));
  const Image whole = staged.stage.shot(k_surface, staged.no_interface());
  const Image with_panel = staged.stage.shot(k_surface, staged.panel());
  const std::array<int, 3> background{237, 240, 242};
  for (int y = 0; y < k_staged_height; ++y) {
    for (int x = 0; x < k_staged_width; ++x) {
      const int u = x - k_surface.scene_left;
      const int v = y - k_surface.scene_top;
      const bool inside = u >= 0 && v >= 0 && u < k_scene_width && v < k_scene_height;
      ASSERT_EQ(colour_at(whole, {x, y}), inside ? colour_at(alone, {u, v}) : background) << x << ", " << y;
      if (x < 398 || x > 602 || y < 48 || y > 252) {
        ASSERT_EQ(colour_at(with_panel, {x, y}), colour_at(whole, {x, y})) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(brightness(whole, {430, 150}, 5), brightness(with_panel, {430, 150}, 5) + 100);
}

TEST(Stage, without_a_scene_shows_the_interface_alone) {
  Staged staged(off_screen());
  const Image image = staged.stage.shot(k_surface, staged.no_interface());
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) ASSERT_EQ(image.rgba[i], 237);
}

TEST(Stage, a_region_without_pixels_is_refused) {
  Staged staged(off_screen());
  const SceneFrame frame;
  const Camera camera = fit_camera(NamedView::iso, frame, 1);
  EXPECT_THROW(staged.stage.draw_scene(frame, camera, ColourMap::viridis, 0, 100, Quality::still),
               std::runtime_error);
  EXPECT_THROW(staged.stage.draw_scene(frame, camera, ColourMap::viridis, 100, 9000, Quality::still),
               std::runtime_error);
}

TEST(Highlight, outlines_the_member_and_changes_nothing_else) {
  Staged staged(off_screen());
  SceneFrame frame = synthetic_cabinet(6);
  const Image plain = scene(staged, frame);
  frame.highlighted_member = 1000;
  EXPECT_TRUE(scene(staged, frame) == plain);
  frame.highlighted_member = frame.tubes[5].member;
  const Image outlined = scene(staged, frame);
  const Camera camera = fit_camera(NamedView::iso, frame, static_cast<float>(k_scene_width) / k_scene_height);
  const auto end = [&](std::uint32_t station) {
    const Eigen::Vector3f p(frame.stations[frame.tubes[5].first_station + station].position.data());
    const Pixel at = seen_at(camera, p, k_scene_width, k_scene_height);
    return Eigen::Vector2f(static_cast<float>(at.x), static_cast<float>(at.y));
  };
  const Eigen::Vector2f from = end(0);
  const Eigen::Vector2f along = end(8) - from;
  int magenta = 0;
  for (int y = 0; y < k_scene_height; ++y) {
    for (int x = 0; x < k_scene_width; ++x) {
      const auto c = colour_at(outlined, {x, y});
      magenta += c[0] > 180 && c[1] < 60 && c[2] > 80;
      if (c == colour_at(plain, {x, y})) continue;
      const Eigen::Vector2f p = Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - from;
      const float share = std::clamp(p.dot(along) / along.squaredNorm(), 0.0f, 1.0f);
      EXPECT_LT((p - share * along).norm(), 14) << x << ", " << y;
    }
  }
  EXPECT_GT(magenta, 2 * along.norm());  // a line on both sides, more than a pixel wide
}

TEST(Ghost, shows_translucent_once_and_behind_a_body_that_it_coincides_with) {
  Staged staged(off_screen());
  const auto body = [](float left) {
    SceneFrame frame;
    frame.profiles = {box_profile(0.2f)};
    add_beam(frame, {0, left - 0.3f, 1}, {0, left + 0.3f, 1}, {0, 0, 0}, 0, 0, 0);
    return frame;
  };
  SceneFrame frame = body(-0.5f);
  const Image alone = scene(staged, frame);
  frame.ghost_stations = frame.stations;
  frame.ghost_tubes = frame.tubes;
  EXPECT_LT(mean_difference(scene(staged, frame), alone), 0.02);  // the samples on edges

  const SceneFrame other = body(0.5f);
  frame.ghost_stations = other.stations;
  frame.ghost_tubes = other.tubes;
  const Image once = scene(staged, frame);
  const Camera camera = fit_camera(NamedView::iso, frame, static_cast<float>(k_scene_width) / k_scene_height);
  const Pixel at = seen_at(camera, {0.2f, 0.5f, 1}, k_scene_width, k_scene_height);
  EXPECT_LT(brightness(once, at, 2), brightness(alone, at, 2) - 20);
  EXPECT_GT(brightness(once, at, 2), 0.4 * brightness(alone, at, 2));
  frame.ghost_tubes.push_back(frame.ghost_tubes[0]);
  EXPECT_TRUE(scene(staged, frame) == once);

  frame.ghost_stations[2].position[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(scene(staged, frame) == alone);
  EXPECT_EQ(staged.stage.left_out().tubes, 2);
}

}  // namespace
}  // namespace topple::render
