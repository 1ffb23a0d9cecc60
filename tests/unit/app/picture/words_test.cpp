// What captions say: the instant, the shakes, what holds a body.
#include "app/picture/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "app/picture/window_words.h"
#include "app/support/terms.h"
#include "app/support/title_words.h"
#include "solver/io/recording/observer.h"
#include "solver/io/scene/scene.h"
#include "solver/io/scene/scene_file.h"
#include "solver/run/edit.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

TEST(Words, a_second_shake_is_not_left_out) {
  const io::Scene one = io::parse_scene(k_shaken, "s.toml");
  EXPECT_EQ(shake_in_words(one.setup.parameters, 0), "floor: 2 Hz, 400 gal");
  const std::string shake =
      "[[shake]]\nname = \"other\"\nfrequency = 1\namplitude = 1\ndirection = [0, 1, 0]\n";
  const io::Scene two = io::parse_scene(k_shaken + shake, "s.toml");
  EXPECT_EQ(shake_in_words(two.setup.parameters, 0), "floor: 2 Hz, 400 gal, and 1 more");
}

TEST(Words, a_shake_that_shakes_nothing_now_says_when_it_does) {
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml", {"shake.1.start=1", "shake.1.cycles=4"});
  EXPECT_EQ(shake_in_words(scene.setup.parameters, 0.5), "floor: 2 Hz, 400 gal, from 1 s on");
  EXPECT_EQ(shake_in_words(scene.setup.parameters, 2), "floor: 2 Hz, 400 gal");
  EXPECT_EQ(shake_in_words(scene.setup.parameters, 3.5), "floor: 2 Hz, 400 gal, over since 3 s");
}

TEST(Words, a_scene_whose_values_are_set_says_that_it_was_changed) {
  const auto title = [](const io::Scene& scene) {
    Parameters parameters = scene.setup.parameters;
    const std::string read = title_in_words(scene, parameters);
    apply({.key = Edit::Key::amplitude, .value = Vec3(2, 0, 0)}, scene.setup.model, 0, parameters);
    return std::pair(read, title_in_words(scene, parameters));
  };
  using Titles = std::pair<std::string, std::string>;
  const std::string plain = io::load_scene("paper-a").title, changed = plain + " (changed)";
  EXPECT_EQ(title(io::load_scene("paper-a")), Titles(plain, changed));
  EXPECT_EQ(title(io::load_scene("paper-a", {"run.duration=1"})), Titles(changed, changed));
  EXPECT_EQ(title(io::load_scene("paper-a", {"run.duration=1", "title=\"Two\""})),
            Titles("Two", "Two (changed)"));
}

TEST(Words, titles_of_built_in_scenes_are_in_the_language_of_the_window) {
  std::set<std::string> titles;
  for (const io::BuiltinScene& builtin : io::builtin_scenes())
    titles.insert(io::load_scene(std::string(builtin.name)).title);
  for (const Phrase& title : title_words::k_titles)
    EXPECT_EQ(titles.erase(std::string(title.english)), 1u) << title.english;
  EXPECT_EQ(titles, std::set<std::string>());
  window_language() = Language::japanese;
  const io::Scene scene = io::load_scene("cantilever", {"run.duration=1"});
  const std::string changed = title_in_words(scene, scene.setup.parameters);
  const std::string own = in_window_language("A cantilever of mine");
  window_language() = Language::english;
  EXPECT_EQ(changed, "先端に急に荷重がかかる片持ち梁（変更あり）");
  EXPECT_EQ(own, "A cantilever of mine");
}

TEST(Words, of_many_all_stand_and_others_stand_beside_those_that_do_not) {
  const io::Scene scene = io::load_scene("classroom");
  const Model& model = scene.setup.model;
  const topple::Run run(scene.setup);
  io::FrameRow row = io::frame_row(run);
  const Vec3& gravity = scene.setup.parameters.gravity;
  const int all = model.furniture_total();
  ASSERT_GT(all, 5);
  EXPECT_EQ(bodies_in_words(model, gravity, row), std::vector{fmt::format("all {} stand", all)});
  row.body[0].tilt = 80 / k_degrees;
  const std::vector<std::string> lines = bodies_in_words(model, gravity, row);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], model.bodies[0].name + ": fallen, tilt 80°");
  EXPECT_EQ(lines[1], fmt::format("{} others stand", all - 1));
  EXPECT_EQ(most_lines_of_bodies(model), 6);
}

TEST(Words, a_shake_that_is_on_its_way_to_another_amplitude_says_what_it_is_now) {
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml");
  Parameters parameters = scene.setup.parameters;
  apply({.key = Edit::Key::amplitude, .value = Vec3(2, 0, 0)}, scene.setup.model, 0.1, parameters);
  EXPECT_EQ(shake_in_words(parameters, 0.1), "floor: 2 Hz, 200 gal, still 400 gal");
  EXPECT_EQ(shake_in_words(parameters, 0.1 + 0.5 / 8), "floor: 2 Hz, 200 gal, still 300 gal");
  EXPECT_EQ(shake_in_words(parameters, 0.1 + 0.5 / 4), "floor: 2 Hz, 200 gal");
}

// Its peak may have passed by then.
TEST(Words, a_record_that_is_scaled_on_its_way_tells_the_factor_and_no_peak) {
  const io::Scene scene = io::load_scene("near-fault");
  Parameters parameters = scene.setup.parameters;
  ASSERT_EQ(shake_in_words(parameters, 6), "floor: record 10 s, peak 339.3 gal");
  apply({.key = Edit::Key::scale, .value = Vec3(0.5, 0, 0)}, scene.setup.model, 6, parameters);
  EXPECT_EQ(shake_in_words(parameters, 6), "floor: record 10 s, times 0.5 since 6.00 s, still times 1");
  EXPECT_EQ(shake_in_words(parameters, 9), "floor: record 10 s, times 0.5 since 6.00 s");
}

// A cabinet turns about the edge of its base by 30 degrees, which moves the middle of the base by b (1 - cos
// 30), 25 mm, and then slides 7 mm.
TEST(Words, what_turns_about_an_edge_has_not_slid) {
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml");
  const Model& model = scene.setup.model;
  const Body& body = model.bodies[0];
  const double angle = 30 / k_degrees;
  Vec3 edge = body.base_centre;
  for (const Vec3& corner : body.support_polygon) edge.x() = std::max(edge.x(), corner.x());
  for (const double slid : {0., 0.007}) {
    io::FrameRow row = io::frame_row(topple::Run(scene.setup));
    const Quat turn(std::cos(angle / 2), 0, std::sin(angle / 2), 0);
    const Vec3 centre = edge + turn * (body.centre_of_gravity - edge) + slid * Vec3::UnitY();
    io::BodyNumbers& now = row.body[0];
    now.x = centre.x(), now.y = centre.y(), now.z = centre.z();
    now.qw = turn.w(), now.qx = turn.x(), now.qy = turn.y(), now.qz = turn.z();
    now.tilt = angle;
    EXPECT_TRUE(body_in_words(model, scene.setup.parameters.gravity, row, 0).starts_with("free: tilt 30.0°"));
    row.step = 1;  // before, everything is at rest, on whatever it will fall from
    now.slide = (edge - body.base_centre).norm() * (1 - std::cos(angle));
    EXPECT_GT(now.slide, 0.02);
    EXPECT_EQ(body_in_words(model, scene.setup.parameters.gravity, row, 0),
              fmt::format("free: tipped, rests at 30.0° (critical {:.1f}°){}", now.critical_angle * k_degrees,
                          slid > 0 ? ", foot slid 7 mm" : ""));
  }
}

TEST(Words, what_falls_has_not_fallen_before_it_lies) {
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml");
  const Model& model = scene.setup.model;
  const Vec3& gravity = scene.setup.parameters.gravity;
  io::FrameRow row = io::frame_row(topple::Run(scene.setup));
  row.body[0].critical_angle = 12 / k_degrees;
  row.body[0].tilt = 66 / k_degrees;
  EXPECT_EQ(body_in_words(model, gravity, row, 0), "free: fallen, tilt 66°");
  row.body[0].energy += 0.5 * model.bodies[0].mass * 1.5 * 1.5;  // at 1.5 m/s
  EXPECT_EQ(body_in_words(model, gravity, row, 0), "free: beyond critical, 66.0° of 12.0°");
  row.body[0].tilt = 90 / k_degrees;  // slides about
  EXPECT_EQ(body_in_words(model, gravity, row, 0), "free: fallen, tilt 90°");
}

TEST(Words, what_nothing_touches_does_not_stand) {
  const io::Scene scene = io::parse_scene(
      "topple = 1\nfloor = {}\nrun = { duration = 1, settle = false }\n"
      "block = [{ name = \"cube\", size = [0.2, 0.2, 0.2], mass = 8, at = [0, 0, 0.5] }]\n",
      "s.toml");
  topple::Run run(scene.setup);
  const auto words = [&] {
    return body_in_words(scene.setup.model, scene.setup.parameters.gravity, io::frame_row(run), 0);
  };
  while (run.time() < 0.2) ASSERT_TRUE(run.advance().ok());
  EXPECT_EQ(words(), "cube: in the air, tilt 0°");
  // what trembles on an edge bears nothing at times
  io::FrameRow low = io::frame_row(run);
  double least = 1e9;
  for (std::size_t i = 2; i < low.position.size(); i += 3) least = std::min(least, double{low.position[i]});
  for (const double gap : {1e-3, 1e-2}) {
    io::FrameRow there = low;
    for (std::size_t i = 2; i < low.position.size(); i += 3)
      there.position[i] += static_cast<float>(gap - least + scene.setup.model.contact_points[0].width / 2);
    EXPECT_EQ(body_in_words(scene.setup.model, scene.setup.parameters.gravity, there, 0) ==
                  "cube: in the air, tilt 0°",
              gap > 5e-3);
  }
  io::FrameRow without_contacts = io::frame_row(run);
  without_contacts.knows_contacts = false;
  EXPECT_EQ(body_in_words(scene.setup.model, scene.setup.parameters.gravity, without_contacts, 0)
                .find("in the air"),
            std::string::npos);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  EXPECT_EQ(words(), "cube: standing");
}

TEST(Words, an_instant_has_the_digits_of_its_rows) {
  io::FrameRow row;
  row.time = 1.245;
  io::Scene scene = io::parse_scene(k_shaken, "s.toml");
  scene.setup.run.output_rate = 200;
  EXPECT_EQ(instant_in_words(scene.setup, row), "t = 1.245 s");
  scene.setup.run.output_rate = 50;
  row.time = 1.24;
  EXPECT_EQ(instant_in_words(scene.setup, row), "t = 1.24 s");
}

TEST(Words, a_bracket_without_force_holds_and_a_strap_is_slack) {
  const io::Scene scene = io::parse_scene(k_shaken + k_straps, "s.toml");
  Model model = scene.setup.model;
  const topple::Run run(scene.setup);
  io::FrameRow row = io::frame_row(run);
  row.anchor[1] = {.tension = 0, .energy = 0, .natural_length = 0.4f, .state = io::k_anchor_slack};
  EXPECT_EQ(anchor_in_words(model, row, 1), "strap strong: without force");
  model.anchors[1].type = Anchor::Type::bracket;
  EXPECT_EQ(anchor_in_words(model, row, 1), "bracket strong: holding");
  row.anchor[1].tension = -12;
  row.anchor[1].state = io::k_anchor_holds;
  EXPECT_EQ(anchor_in_words(model, row, 1), "bracket strong: pushes 12 N");
}

}  // namespace
}  // namespace topple::app
