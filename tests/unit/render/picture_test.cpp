#include "render/output/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include <Eigen/Geometry>

#include "render/output/canvas.h"
#include "tests/unit/render/off_screen.h"
#include "tests/unit/render/scratch.h"
#include "tests/unit/render/synthetic_cabinet.h"

namespace topple::render {
namespace {

constexpr int k_width = 640;
constexpr int k_height = 360;
constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

Image drawn(const SceneFrame& frame, NamedView view = NamedView::iso, LeftOut* left_out = nullptr) {
  Picture picture(off_screen(), k_width, k_height);
  Image image = picture.draw(frame, fit_camera(view, frame, picture.aspect()));
  if (left_out != nullptr) *left_out = picture.left_out();
  return image;
}

TEST(Picture, same_frame_gives_same_bytes_from_the_same_and_from_another_picture) {
  SceneFrame frame = synthetic_cabinet(6);
  add_words(frame);
  Picture picture(off_screen(), k_width, k_height);
  const Camera camera = fit_camera(NamedView::iso, frame, picture.aspect());
  const Image first = picture.draw(frame, camera);
  SceneFrame other = synthetic_cabinet(2);
  picture.draw(other, camera, {ColourMap::cividis, false});
  EXPECT_TRUE(picture.draw(frame, camera) == first);
  EXPECT_TRUE(drawn(frame) == first);
}

// Within the bodies' rectangle they are smooth; around it floor and walls are what they are without samples,
// with their shadows, and the line where a wall stands on the floor is smooth by itself.
TEST(Picture, samples_are_taken_where_bodies_are_and_nowhere_else) {
  const Gl gl = load_gl(off_screen());
  ScenePainter painter(gl);
  const SceneFrame frame = synthetic_cabinet(6);
  Canvas plain(gl, k_width, k_height, 0), smooth(gl, k_width, k_height, 4);
  const Camera camera = fit_camera(NamedView::iso, frame, float{k_width} / k_height);
  LeftOut left_out;
  for (Canvas* canvas : {&plain, &smooth})
    canvas->draw(painter, frame, camera, ColourMap::viridis, Quality::still, left_out);
  const Image a = plain.read(), b = smooth.read();
  Eigen::AlignedBox2i differs, bodies;
  for (int y = 0; y < k_height; ++y)
    for (int x = 0; x < k_width; ++x)
      if (colour_at(a, {x, y}) != colour_at(b, {x, y})) differs.extend(Eigen::Vector2i(x, y));
  for (const Tube& tube : frame.tubes) {
    for (std::uint32_t i = 0; i < tube.station_count; ++i) {
      const Pixel p = seen_at(camera, Eigen::Vector3f(frame.stations[tube.first_station + i].position.data()),
                              k_width, k_height);
      bodies.extend(Eigen::Vector2i(p.x, p.y));
    }
  }
  ASSERT_FALSE(differs.isEmpty());
  constexpr int k_thickness = 12;  // px, of beams and their end caps
  EXPECT_TRUE(Eigen::AlignedBox2i(bodies.min().array() - k_thickness, bodies.max().array() + k_thickness)
                  .contains(differs))
      << differs.min().transpose() << " to " << differs.max().transpose();
  EXPECT_GT(differs.sizes().y(), bodies.sizes().y() / 2) << "edges of beams are smooth";
}

TEST(Picture, colour_of_a_beam_comes_from_its_value) {
  SceneFrame frame;
  frame.profiles = {box_profile(0.2f)};
  add_beam(frame, {0, -0.8f, 1}, {0, 0.8f, 1}, {0, 0, 0}, 0, 10, 0);
  frame.legend.maximum = 10;
  for (const ColourMap map : {ColourMap::viridis, ColourMap::cividis}) {
    Picture picture(off_screen(), k_width, k_height);
    const Camera camera = fit_camera(NamedView::front, frame, picture.aspect());
    const Image image = picture.draw(frame, camera, {map, false});
    for (const float share : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f}) {
      const auto pixel =
          colour_at(image, seen_at(camera, {0.2f, -0.8f + 1.6f * share, 1}, k_width, k_height));
      const auto& wanted = colour_table(map)[static_cast<std::size_t>(share * 255)];
      // Light changes the length of the linear colour, not its direction.
      Eigen::Vector3d seen;
      Eigen::Vector3d table;
      for (std::size_t c = 0; c < 3; ++c) {
        seen[static_cast<int>(c)] = std::pow(pixel[c] / 255.0, 2.2);
        table[static_cast<int>(c)] = std::pow(wanted[c] / 255.0, 2.2);
      }
      EXPECT_GT(seen.normalized().dot(table.normalized()), 0.99) << "share " << share;
    }
  }
}

TEST(Picture, signed_legend_has_the_diverging_map) {
  SceneFrame frame;
  frame.profiles = {box_profile(0.2f)};
  add_beam(frame, {0, -0.8f, 1}, {0, 0.8f, 1}, {0, 0, 0}, -5, 5, 0);
  frame.legend.minimum = -5;
  frame.legend.maximum = 5;
  frame.legend.is_signed = true;
  Picture picture(off_screen(), k_width, k_height);
  const Camera camera = fit_camera(NamedView::front, frame, picture.aspect());
  const Image image = picture.draw(frame, camera);
  const auto low = colour_at(image, seen_at(camera, {0.2f, -0.7f, 1}, k_width, k_height));
  const auto high = colour_at(image, seen_at(camera, {0.2f, 0.7f, 1}, k_width, k_height));
  EXPECT_GT(low[2], low[0]);
  EXPECT_GT(high[0], high[2]);
}

TEST(Picture, what_is_not_finite_never_reaches_a_pixel) {
  SceneFrame clean = synthetic_cabinet(6);
  add_words(clean);
  const Image reference = drawn(clean);
  for (const float bad : {k_nan, k_infinity, -k_infinity, 1e30f}) {
    SceneFrame dirty = clean;
    const auto add_tube = [&](auto spoil) {
      add_beam(dirty, {0, 0, 0.5f}, {0.5f, 0.5f, 1}, {0, 0, 0}, 10, 20, 0);
      spoil(dirty.stations[dirty.tubes.back().first_station + 3]);
    };
    add_tube([&](Station& s) { s.position[2] = bad; });
    add_tube([&](Station& s) { s.rotation[1] = bad; });
    if (!std::isfinite(bad)) add_tube([&](Station& s) { s.value = bad; });
    dirty.panels.push_back(dirty.panels[0]);
    dirty.panels.back().corners[2][0] = bad;
    dirty.trails.push_back({{{0, 0, 0}, {0, 0, bad}}, {1, 1}, {1, 0, 0, 1}});
    dirty.labels.push_back({{0, bad, 0}, "nowhere"});
    dirty.arrows.push_back({{0, 0, bad}, {0, 0, 1}, {1, 0, 0, 1}});
    dirty.grounds.push_back({{0, 0, 0}, {0, bad, 1}, {1, 0, 0}, 4, 4, true});
    LeftOut left_out;
    EXPECT_TRUE(drawn(dirty, NamedView::iso, &left_out) == reference) << bad;
    EXPECT_EQ(left_out.tubes, std::isfinite(bad) ? 2 : 3) << bad;
    EXPECT_EQ(left_out.panels, 1) << bad;
    EXPECT_EQ(left_out.arrows, 1) << bad;
    EXPECT_EQ(left_out.trails, 1) << bad;
    EXPECT_EQ(left_out.grounds, 1) << bad;
  }
}

TEST(Picture, words_bear_numbers_that_are_not_finite) {
  SceneFrame frame = synthetic_cabinet(6);
  add_words(frame);
  frame.legend.maximum = k_nan;
  frame.legend.mark = k_infinity;
  frame.trace.value[7] = k_nan;
  frame.trace.at[9] = k_infinity;
  frame.trace.cursor = k_nan;
  LeftOut left_out;
  drawn(frame, NamedView::iso, &left_out);
  EXPECT_EQ(left_out.legends, 1);
  EXPECT_EQ(left_out.trace_points, 2);
  EXPECT_EQ(left_out.total(), 3);
}

TEST(Picture, camera_that_is_not_finite_is_replaced_by_the_fitted_one) {
  const SceneFrame frame = synthetic_cabinet(6);
  Picture picture(off_screen(), k_width, k_height);
  Camera broken = fit_camera(NamedView::iso, frame, picture.aspect());
  const Image reference = picture.draw(frame, broken);
  broken.view(1, 2) = k_nan;
  EXPECT_TRUE(picture.draw(frame, broken) == reference);
}

/// A block of 0.4 m on the floor, raised by `lift`, m.
SceneFrame block(float lift) {
  SceneFrame frame;
  frame.profiles = {box_profile(0.2f)};
  add_beam(frame, {0, 0, lift}, {0, 0, 0.4f + lift}, {0, 0, 0}, 0, 0, 0);
  frame.grounds.push_back({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 4, 4, true});
  frame.bounds_min = {-0.4f, -0.4f, 0};
  frame.bounds_max = {0.4f, 0.4f, 0.6f};
  return frame;
}

TEST(Picture, contact_shadow_tells_a_resting_block_from_one_raised_by_millimetres) {
  Picture picture(off_screen(), 1280, 720);
  const Camera camera = look_at({0.6f, -2.0f, 1.5f}, {0, 0, 0.1f}, {0, 0, 1}, picture.aspect(), 0.5f, 20);
  // The floor 8 mm in front of the block's foot, on the side that is lit.
  const Pixel foot = seen_at(camera, {0.03f, -0.208f, 0}, 1280, 720);
  const Pixel open_floor = seen_at(camera, {0.03f, -0.555f, 0}, 1280, 720);
  double last = 0;
  for (const float lift : {0.0f, 0.003f, 0.010f, 0.030f}) {
    const Image image = picture.draw(block(lift), camera, {ColourMap::viridis, false});
    const double share = brightness(image, foot, 0) / brightness(image, open_floor, 0);
    EXPECT_GT(share, last + 0.015) << "lift " << lift;
    last = share;
  }
  EXPECT_LT(last, 1);
}

TEST(Picture, key_shadow_leaves_the_foot_of_a_raised_block) {
  Picture picture(off_screen(), 1280, 720);
  const Camera camera = look_at({-1.0f, 2.5f, 2.0f}, {0, 0.2f, 0.1f}, {0, 0, 1}, picture.aspect(), 0.5f, 20);
  // Where only the shadow of a resting block falls, and where only that of a raised one does.
  const Pixel near = seen_at(camera, {-0.15f, 0.26f, 0}, 1280, 720);
  const Pixel far = seen_at(camera, {0.13f, 0.52f, 0}, 1280, 720);
  const Image resting = picture.draw(block(0), camera, {ColourMap::viridis, false});
  const Image raised = picture.draw(block(0.3f), camera, {ColourMap::viridis, false});
  EXPECT_GT(brightness(raised, near, 1), brightness(resting, near, 1) * 1.1);
  EXPECT_LT(brightness(raised, far, 1), brightness(resting, far, 1) * 0.9);
}

TEST(Picture, wall_seen_from_behind_hides_nothing) {
  SceneFrame frame = block(0);
  const Image without = drawn(frame, NamedView::side);
  frame.grounds.push_back({{0, -0.6f, 1}, {0, 1, 0}, {1, 0, 0}, 2, 1, false});  // between eye and block
  const Image with = drawn(frame, NamedView::side);
  double greatest = 0;
  for (std::size_t i = 0; i < with.rgba.size(); ++i) {
    greatest = std::max(greatest, std::abs(double{1} * with.rgba[i] - without.rgba[i]));
  }
  EXPECT_LT(greatest, 45);
}

TEST(Picture, empty_frame_is_a_calm_light_picture) {
  const Image image = drawn(SceneFrame());
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    ASSERT_GT(image.rgba[i], 220);
    ASSERT_EQ(image.rgba[i + 3], 255);
  }
}

TEST(Picture, size_that_will_not_do_is_refused) {
  EXPECT_THROW(Picture(off_screen(), 0, 100), std::runtime_error);
  EXPECT_THROW(Picture(off_screen(), 100, 100000), std::runtime_error);
}

std::string bytes_with_threads(const char* threads, const std::filesystem::path& path) {
  const std::string command =
      "LP_NUM_THREADS=" + std::string(threads) + " '" TOPPLE_DRAW_ONE "' '" + path.string() + "'";
  return std::system(command.c_str()) == 0 ? file_bytes(path) : std::string();
}

TEST(Picture, bytes_do_not_depend_on_the_number_of_threads) {
  const Scratch scratch;
  const std::string alone = bytes_with_threads("0", scratch / "a.png");
  ASSERT_FALSE(alone.empty());
  EXPECT_TRUE(alone == bytes_with_threads("1", scratch / "b.png"));
  EXPECT_TRUE(alone == bytes_with_threads("4", scratch / "c.png"));
}

}  // namespace
}  // namespace topple::render
