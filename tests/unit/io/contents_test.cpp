// What lies on the shelves of an open cabinet: at rest, and sliding off.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "scene_samples.h"
#include "solver/io/scene/scene.h"
#include "solver/math/rotation.h"
#include "solver/run/run.h"
#include "unit/solver/panel_crossings.h"

namespace topple::io {
namespace {

/// An open cabinet with a shelf whose surface is 515 mm high.
const std::string k_open =
    "topple = 1\n[floor]\n[run]\ntime_step = \"auto\"\nwant = [\"motion\"]\n"
    "[[material]]\nname = \"steel\"\nyoung = \"205 GPa\"\npoisson = 0.3\ndensity = \"7850 kg/m^3\"\n"
    "[[section]]\nname = \"tube\"\nshape = \"box\"\nsize = [\"25 mm\", \"25 mm\"]\nthickness = \"1.2 mm\"\n"
    "[[cabinet]]\nname = \"cabinet\"\nsize = [0.38, 0.78, 0.98]\nmass = 22\nsection = \"tube\"\n"
    "material = \"steel\"\nshelves = 1\nfront = \"open\"\n";
const std::string k_box =
    "[[block]]\nname = \"box\"\nsize = [0.19, 0.24, 0.22]\nmass = 5\nat = [0, -0.15, 0.515]\n";
const std::string k_case =
    "[[cabinet]]\nname = \"case\"\nsize = [0.18, 0.24, 0.2]\nmass = 3\nsection = \"tube\"\n"
    "material = \"steel\"\nat = [0, 0.2, 0.515]\n";

/// In the axes of the cabinet, m: centre of gravity of a body against the cabinet's.
Vec3 place_in_cabinet(const State& state, int body) {
  const BodyState& cabinet = state.bodies[0];
  return cabinet.rotation.conjugate() * (state.bodies[body].position - cabinet.position);
}

// What settling leaves decays, and the stick springs hold.
TEST(Contents, lie_still_on_a_shelf_for_ten_seconds) {
  for (const auto& [model, duration] : {std::pair("auto", 10.), {"rigid", 10.}, {"frame", 0.5}}) {
    const Scene scene = parse_scene(k_open + "model = \"" + model + "\"\n" + k_case + k_box, "shelf.toml",
                                    {"run.duration=" + std::to_string(duration)});
    topple::Run run(scene.setup);
    ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
    const State start = run.state();
    while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
    for (const int body : {1, 2}) {
      const Vec3 moved = place_in_cabinet(run.state(), body) - place_in_cabinet(start, body);
      EXPECT_LT(moved.norm(), 1e-6) << model << ' ' << scene.setup.model.bodies[body].name;
    }
  }
}

/// Brackets at its back hold the cabinet, whose floor is pushed backwards at `push` m/s^2.
Scene pushed(const std::string& model, const std::string& contents, double friction, double push) {
  std::string text =
      k_open + "model = \"" + model + "\"\n" + contents +
      "[[shake]]\ntype = \"pulse\"\nshape = \"rectangle\"\ndirection = [-1, 0, 0]\nduration = 2\n";
  for (const std::string place :
       {"0.39, 0.0125]\n", "-0.39, 0.0125]\n", "0.39, 0.9925]\n", "-0.39, 0.9925]\n"})
    text += "[[anchor]]\nbody = \"cabinet\"\npoint = [-0.19, " + place + "to = [-0.3, " + place +
            "type = \"bracket\"\nstiffness = 1e7\n";
  return parse_scene(text, "pushed.toml",
                     {"contact.friction=" + std::to_string(friction),
                      "shake.1.amplitude=" + std::to_string(push), "run.duration=1.2"});
}

// From where the springs of friction are full, which is before 20 mm: v t + (a - mu g) t^2/2. The cabinet
// quivers on its brackets by 3 um at 3 mm/s, 1 % of the speed of what slides: friction, which follows it,
// makes 0.02 mm of that. Where the front corners cross the front member of the shelf, at 95 mm, a bump by
// their depth takes 2 mm/s more.
TEST(Contents, slide_off_an_open_shelf_by_coulombs_law) {
  constexpr double k_push = 4, k_from = 0.02, k_corners = 0.09, k_edge = 0.19;
  for (const char* const model : {"rigid", "frame"})
    for (const std::string& contents : {k_box, k_case})
      for (const double friction : {0.1, 0.3}) {
        SCOPED_TRACE(model + contents + std::to_string(friction));
        const Scene scene = pushed(model, contents, friction, k_push);
        topple::Run run(scene.setup);
        ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
        const Vec3 start = place_in_cabinet(run.state(), 1);
        Vec3 moved = Vec3::Zero();
        double since = 0, from = 0, speed = 0, on_panel = 0, on_edge = 0;
        while (!run.over()) {
          ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
          moved = place_in_cabinet(run.state(), 1) - start;
          if (moved.x() < k_from || moved.x() > k_edge) continue;
          if (since == 0) {
            since = run.time();
            from = moved.x();
            speed = run.state().bodies[1].velocity.x();
          }
          const double t = run.time() - since,
                       way = from + speed * t + (k_push - friction * k_standard_gravity) * t * t / 2;
          double& off = moved.x() < k_corners ? on_panel : on_edge;
          off = std::max(off, std::abs(moved.x() - way));
          EXPECT_LT(std::abs(moved.z()), 1e-4);
        }
        EXPECT_LT(on_panel, 5e-5);
        EXPECT_LT(on_edge, 5e-4);
        EXPECT_GT(since, 0);
        EXPECT_GT(moved.x(), 0.5);  // it lies before the cabinet
        EXPECT_LT(run.energy().balance_error(), 1e-3);
      }
}

// 100 g on contacts that are stiff enough for the cabinet: it bounces 700 times a second, and nothing of that
// is seen. Steps follow the frame's motion, and lead to where 6000 equal ones do within a tolerance of 1e-3
// of the way.
TEST(Contents, a_light_block_on_a_frames_shelf_does_not_shorten_its_steps) {
  std::array<Vec3, 2> end;
  std::array<long, 2> steps{};
  for (const int fixed : {0, 1}) {
    const Scene scene = parse_scene(
        k_open + "model = \"frame\"\n[[block]]\nname = \"box\"\nsize = [0.06, 0.08, 0.04]\nmass = 0.1\n" +
            "at = [0, -0.15, 0.515]\n[[shake]]\ntype = \"sine\"\nfrequency = 2\namplitude = 5\n",
        "light.toml",
        {"contact.friction=0.35", "run.duration=0.3",
         fixed == 1 ? "run.time_step=5e-5" : "run.time_step=auto"});
    topple::Run run(scene.setup);
    for (; !run.over(); ++steps[fixed]) ASSERT_TRUE(run.advance().ok());
    end[fixed] = run.state().bodies[1].position;
    EXPECT_LT(run.energy().balance_error(), 1e-4);
    EXPECT_GT(run.outcome().bodies()[1].peak_slide, 0.01);
  }
  EXPECT_LT(steps[0], steps[1] / 10);
  EXPECT_LT((end[0] - end[1]).norm(), 1e-5);
}

// Three frames apart, each with a block on its shelf: whoever advances them.
TEST(Contents, threads_do_not_change_a_bit) {
  const Scene scene =
      parse_scene(k_open + "model = \"frame\"\ncopies = [[0, 0, 0], [0, 4, 0], [0, 8, 0]]\n" + k_box +
                      "copies = [[0, 0, 0], [0, 4, 0], [0, 8, 0]]\n[[shake]]\ntype = \"sine\"\nfrequency = "
                      "2\namplitude = 6\n",
                  "apart.toml", {"run.duration=0.2"});
  const auto last = [&](int workers) {
    topple::Run run(scene.setup);
    if (workers > 1)
      run.share({workers, [&](int count, const std::function<void(int, int)>& f) {
                   for (int task = count - 1; task >= 0; --task) f(task, task % workers);
                 }});
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    EXPECT_FALSE(run.state().member_sticks.empty());
    return hash(run.state());
  };
  const auto alone = last(1);
  for (const int workers : {2, 4}) EXPECT_EQ(last(workers), alone);
}

/// Against the closed cabinet, widths of both 1 mm.
Scene thrown(const char* model, double turn, const std::string& at, const std::string& velocity) {
  std::string text =
      replaced(k_open, "shape = \"box\"\nsize = [\"25 mm\", \"25 mm\"]\nthickness = \"1.2 mm\"\n",
               "shape = \"custom\"\nsize = [0.025, 0.025]\narea = 1.14e-4\niy = 1.08e-8\niz = 1.08e-8\n"
               "j = 1.6e-8\nky = 0.44\nkz = 0.44\nwidth = \"1 mm\"\n");
  text = replaced(text, "front = \"open\"\n", "panel_thickness = \"1 mm\"\n");
  text += std::string("model = \"") + model + "\"\n[[block]]\nname = \"box\"\nsize = [0.12, 0.11, 0.1]\n" +
          "mass = 1.2\nwidth = \"1 mm\"\nyaw = " + std::to_string(turn) +
          "\ntilt = " + std::to_string(0.7 * turn) + "\nat = [" + at + "]\nvelocity = [" + velocity + "]\n";
  return parse_scene(text, "thrown.toml", {"run.settle=false", "run.duration=0.1"});
}

// From behind, from before and from above at 20 m/s, which are 240 J on contacts that hold 5 J each before
// they harden. A face that hits flat may end the run, which says who cannot go on and when.
TEST(Contents, nobody_passes_a_panel_of_one_millimetre_at_20_metres_a_second) {
  constexpr double k_interval = 1e-3;  // s, in which it moves by less than its size
  for (const auto& [model, turns] : {std::pair("rigid", std::vector{0., 0.3, 0.6, 0.9}), {"frame", {0.3}}})
    for (const double turn : turns)
      for (const auto& [at, velocity] : {std::pair("-0.7, 0.13, 0.2", "20, 0, 0"),
                                         {"0.7, 0.13, 0.2", "-20, 0, 0"},
                                         {"0.05, 0.1, 1.3", "0, 0, -20"}}) {
        SCOPED_TRACE(std::string(model) + ' ' + std::to_string(turn) + ' ' + at);
        const Scene scene = thrown(model, turn, at, velocity);
        topple::Run run(scene.setup);
        double next = k_interval;
        while (!run.over() && run.advance().ok())
          for (; next < run.time(); next += k_interval)
            ASSERT_EQ(test::panel_crossings(scene.setup.model, run.state()), 0) << run.time() << " s";
        EXPECT_EQ(test::panel_crossings(scene.setup.model, run.state()), 0);
        EXPECT_LT(run.energy().balance_error(), 1e-3);
        EXPECT_GT(run.outcome().bodies()[1].peak_pinch, 0.9);
        if (run.status().ok()) continue;
        EXPECT_EQ(turn, 0);
        EXPECT_EQ(
            run.status().message(scene.setup.model).find("no step is short enough for the tolerance at 0.0"),
            0u);
        EXPECT_NE(run.status().message(scene.setup.model).find("body \""), std::string::npos);
      }
}

// A box that is wider than what it stands on is borne within its base, by the half next to each side.
TEST(Contents, a_box_that_overhangs_its_shelf_lifts_when_it_tips) {
  const Scene scene = parse_scene(
      "topple = 1\n[run]\nduration = 2.2\nwant = [\"motion\"]\n[floor]\n[[shake]]\ntype = \"sine\"\n"
      "frequency = 2\namplitude = 15\nstart = 1.5\ndirection = [0.1, 1, 0]\n[[furniture]]\n"
      "kind = \"bookshelf\"\nat = [0, 0]\nyaw = \"90 deg\"\n[[block]]\nname = \"box\"\n"
      "size = [0.25, 0.3, 0.2]\nmass = 8\nat = [0, 0, 1.8]\n",
      "overhang.toml");
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const BodyOutcome& box = run.outcome().bodies()[1];
  ASSERT_TRUE(box.first_uplift);
  EXPECT_GT(*box.first_uplift, *run.outcome().bodies()[0].first_uplift);
}

// Deformations that make an elastic body a frame come back with every half period: it stays one meanwhile.
TEST(Contents, a_cabinet_that_sways_does_not_change_its_model_with_every_half_period) {
  const Scene scene = parse_scene(
      "topple = 1\n[run]\nduration = 1.5\naccuracy = 1e-4\n[floor]\n[[shake]]\ntype = \"sine\"\n"
      "frequency = 2\namplitude = 1.2\ncycles = 6\ntaper = 1\n[[cabinet]]\nname = \"c\"\n"
      "size = [0.4, 1.2, 1.8]\nmass = 200\nsection = \"box 30x1\"\nmaterial = \"steel\"\nshelves = 4\n"
      "bracing = \"none\"\n",
      "sways.toml");
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  EXPECT_EQ(run.outcome().bodies()[0].level_changes.size(), 2u);  // elastic, frame
}

}  // namespace
}  // namespace topple::io
