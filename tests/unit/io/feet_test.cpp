// Friction of a body's feet: how far it slides, on every level and with every law.
#include <gtest/gtest.h>

#include "solver/io/scene/scene.h"
#include "solver/run/run.h"

namespace topple::io {
namespace {

/// Two low and wide bodies that slide apart; feet of the first have a friction of their own.
std::string sliding(const std::string& rest, const std::string& body) {
  const auto one = [&](const std::string& name, const std::string& y, const std::string& friction) {
    return body + "name = \"" + name + "\"\nat = [0, " + y + "]\nvelocity = [0.6, 0, 0]\n" + friction;
  };
  return "topple = 1\nfloor = {}\ncontact = { friction = 0.6, alpha = \"4000 kgf\" }\n" + rest +
         one("smooth", "0", "friction = 0.2\n") + one("rough", "2", "");
}

const char* const k_block = "[[block]]\nsize = [0.6, 0.6, 0.2]\nmass = 40\n";
const char* const k_cabinet =
    "[[cabinet]]\nsize = [0.6, 0.6, 0.2]\nmass = 40\nsection = \"box 30x1\"\nmaterial = \"steel\"\n";

std::vector<double> slides(const Scene& scene) {
  topple::Run run(scene.setup);
  EXPECT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
  while (!run.over())
    if (!run.advance().ok()) {
      ADD_FAILURE() << run.status().message(scene.setup.model);
      break;
    }
  std::vector<double> found;
  for (const BodyOutcome& body : run.outcome().bodies()) found.push_back(body.slide);
  return found;
}

struct Level {
  const char *name, *run, *model, *body;
};
class Feet : public ::testing::TestWithParam<Level> {};

// A body of velocity v slides by v^2/(2 mu g). Springs of the contact stand for the tolerance: before it
// slides it goes as far as they give, mu N/(10 alpha/L) = 0.1 mm, and what it has of pitch goes into them.
TEST_P(Feet, slide_as_far_as_their_own_friction_lets_them) {
  const Level& level = GetParam();
  const Scene scene = parse_scene(sliding("[run]\nsettle = false\nduration = 0.6\n" + std::string(level.run),
                                          level.body + std::string("model = \"") + level.model + "\"\n"),
                                  "s.toml");
  const std::vector<double> slid = slides(scene);
  const double of_smooth = 0.6 * 0.6 / (2 * 0.2 * k_standard_gravity), of_rough = of_smooth / 3;
  EXPECT_NEAR(slid[0], of_smooth, 0.02 * of_smooth);
  EXPECT_NEAR(slid[1], of_rough, 0.02 * of_rough);
}
INSTANTIATE_TEST_SUITE_P(
    Levels, Feet,
    ::testing::Values(Level{"planar", "", "planar", k_block}, Level{"rigid", "", "rigid", k_block},
                      Level{"elastic", "", "elastic", k_cabinet}, Level{"frame", "", "frame", k_cabinet},
                      Level{"explicit_frame", "integrator = \"central-difference\"\ntime_step = 2e-5\n",
                            "frame", k_cabinet}),
    [](const auto& of) { return std::string(of.param.name); });

TEST(FeetErrors, need_a_friction_of_the_scene_of_which_theirs_is_a_share) {
  try {
    parse_scene(
        "topple = 1\nfloor = {}\ncontact = { friction = 0 }\n" + std::string(k_block) + "friction = 0.2\n",
        "s.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "s.toml:7:12: block.1.friction: contact.friction is 0, of which it is a share; write a small "
        "one there");
  }
}

// Nodes of a frame may be given on the floor, half a width within it.
TEST(Feet, a_rack_with_its_nodes_on_the_floor_comes_to_rest_on_it) {
  using std::to_string;
  std::string nodes, members, masses;
  const double heavy[] = {0, 2.5, 5, 15, 27.5};
  for (int level = 0; level < 5; ++level)
    for (int corner = 0; corner < 4; ++corner) {
      const int node = 4 * level + corner, next = 4 * level + (corner + 1) % 4;
      nodes += std::string("[") + (corner % 3 == 0 ? "-0.205" : "0.205") + ", " +
               (corner < 2 ? "-0.58" : "0.58") + ", " + to_string(0.44 * level) + "], ";
      if (level == 0) continue;
      for (const int from : {node - 4, next})
        members += "{ nodes = [" + to_string(from) + ", " + to_string(node) +
                   "], section = \"box 40x1.5\", material = \"steel\" }, ";
      masses += "{ node = " + to_string(node) + ", mass = " + to_string(heavy[level]) + " }, ";
    }
  const Scene scene = parse_scene("topple = 1\nfloor = {}\n[[frame]]\nname = \"rack\"\nnodes = [" + nodes +
                                      "]\nmembers = [" + members + "]\nmasses = [" + masses + "]\n",
                                  "rack.toml");
  const topple::Run run(scene.setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
  EXPECT_NEAR(run.state().position[0].z(), 0.02, 1e-4);
}

}  // namespace
}  // namespace topple::io
