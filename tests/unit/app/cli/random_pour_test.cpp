// Blocks poured on a desk, from which some fall on the floor. TOPPLE_POUR: how many. A line:
//   COUNT: what became of them; balance B; deepest D; how many lie on the desk
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "solver/io/scene/scene.h"
#include "solver/run/run.h"
#include "unit/app/cli/random_draw.h"
#include "unit/solver/panel_crossings.h"

namespace topple::app {
namespace {

constexpr int k_blocks = 10, k_layer = 12;
constexpr double k_interval = 0.01;  // s, between instants that are looked at
constexpr double k_top = 0.675;      // m, height of the desk's middle plane

const std::string k_desk =
    "topple = 1\n[run]\nduration = 1.5\ntime_step = \"auto\"\nsettle = false\nwant = [\"motion\"]\n"
    "[contact]\nfriction = 0.4\n[floor]\n"
    "[[material]]\nname = \"steel\"\nyoung = 2.05e11\npoisson = 0.3\ndensity = 7850\n"
    "[[section]]\nname = \"tube\"\nshape = \"box\"\nsize = [0.025, 0.025]\nthickness = 0.0012\n"
    "[[frame]]\nname = \"desk\"\nmodel = \"auto\"\nmass = 25\n"
    "nodes = [[-0.35, -0.5, 0.0125], [0.35, -0.5, 0.0125], [0.35, 0.5, 0.0125], [-0.35, 0.5, 0.0125],\n"
    "         [-0.35, -0.5, 0.675], [0.35, -0.5, 0.675], [0.35, 0.5, 0.675], [-0.35, 0.5, 0.675]]\n"
    "panels = [{ nodes = [4, 5, 6, 7] }]\nmembers = [\n";

/// Draws blocks of 0.1 to 2 kg in layers above a desk.
class Draw : RandomDraw {
 public:
  using RandomDraw::RandomDraw;

  std::string poured(int count) {
    std::string text = k_desk;
    for (const auto& [a, b] :
         {std::pair(0, 4), {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {4, 6}, {5, 7}})
      text += fmt::format("  {{ nodes = [{}, {}], section = \"tube\", material = \"steel\" }},\n", a, b);
    text += "]\n";
    for (int k = 0; k < count; ++k) {
      const int layer = k / k_layer, row = k % k_layer / 4, column = k % 4;
      const double size[3] = {uniform(0.09, 0.18), uniform(0.09, 0.18), uniform(0.09, 0.18)};
      text += fmt::format(
          "[[block]]\nname = \"block-{}\"\nsize = [{}, {}, {}]\nmass = {}\nat = [{}, {}, {}]\nyaw = {}\ntilt "
          "= {}\n"
          "velocity = [0, 0, {}]\n",
          k, size[0], size[1], size[2], 300 * size[0] * size[1] * size[2],
          0.25 * (row - 1) + uniform(-0.01, 0.01), 0.25 * (column - 1.5) + uniform(-0.01, 0.01),
          0.78 + 0.3 * layer, uniform(-0.3, 0.3), uniform(-0.3, 0.3), -uniform(0, 1));
    }
    return text;
  }
};

TEST(RandomPour, blocks_lie_on_the_desk_and_on_the_floor) {
  const char* const asked = std::getenv("TOPPLE_POUR");
  const int count = asked ? std::atoi(asked) : k_blocks;
  const io::Scene scene = io::parse_scene(Draw(1).poured(count), "pour.toml");
  const Model& model = scene.setup.model;
  topple::Run run(scene.setup);
  double next = k_interval, deepest = 0;
  while (!run.over() && run.advance().ok())
    for (; next < run.time(); next += k_interval)
      ASSERT_EQ(test::panel_crossings(model, run.state()), 0) << run.time() << " s";
  for (const BodyOutcome& body : run.outcome().bodies()) deepest = std::max(deepest, body.peak_pinch);
  State end = run.state();
  place_nodes(model, end);
  int on_desk = 0;
  for (const Body& body : model.bodies) {
    double lowest = end.position[body.first_node].z();
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      lowest = std::min(lowest, end.position[i].z());
    EXPECT_GT(lowest, 0) << body.name;
    on_desk += lowest > k_top;
  }
  const std::string failure = run.status().ok() ? "" : run.status().message(model);
  std::cout << fmt::format("{}: {}; balance {:.1e}; deepest {:.2f}; {} on the desk\n", count,
                           failure.empty() ? "nobody inside another" : failure, run.energy().balance_error(),
                           deepest, on_desk);
  EXPECT_EQ(failure, "");
  EXPECT_GT(on_desk, count / 4);
  EXPECT_LT(run.energy().balance_error(), 1e-3);
}

}  // namespace
}  // namespace topple::app
