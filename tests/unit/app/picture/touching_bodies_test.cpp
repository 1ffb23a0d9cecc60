#include "app/picture/touching_bodies.h"

#include <gtest/gtest.h>

#include <map>

#include "solver/io/recording/observer.h"
#include "solver/io/scene/scene.h"
#include "solver/io/scene/scene_file.h"
#include "solver/run/run.h"

namespace topple::app {
namespace {

constexpr double k_weight = 9.80665;  // N, of a kilogram

struct Resting {
  explicit Resting(const std::string& text, const std::vector<std::string>& set = {})
      : Resting(io::parse_scene("topple = 1\n[run]\nduration = 1\n[floor]\n" + text, "s.toml", set)) {}
  explicit Resting(io::Scene of) : scene(std::move(of)) {
    topple::Run run(scene.setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    row = io::frame_row(run);
  }
  /// By name of what touches it.
  std::map<std::string, BodyTouch> of(std::size_t body) const {
    std::map<std::string, BodyTouch> out;
    for (const BodyTouch& touch : touches(scene.setup.model, row, body)) out[touch.by] = touch;
    return out;
  }
  io::Scene scene;
  io::FrameRow row;
};

// Rows are floats and what stands still creeps: 1e-4 of a weight.
void expect_force(const BodyTouch& touch, double kilograms) {
  EXPECT_NEAR(touch.force.z(), kilograms * k_weight, 1e-4 * 10 * k_weight) << touch.by;
  EXPECT_NEAR(touch.force.head<2>().norm(), 0, 1e-3 * 10 * k_weight) << touch.by;
}

// The face between them bears both; the resultant on it is neither's.
TEST(TouchingBodies, two_blocks_on_one_press_with_their_weights) {
  const Resting stack(
      "[[block]]\nname = \"low\"\nsize = [0.6, 0.3, 0.2]\nmass = 5\nwidth = 0.01\n"
      "[[block]]\nname = \"left\"\nsize = [0.1, 0.1, 0.2]\nmass = 1\nwidth = 0.01\nat = [-0.2, 0, 0.21]\n"
      "[[block]]\nname = \"right\"\nsize = [0.1, 0.1, 0.2]\nmass = 2\nwidth = 0.01\nat = [0.2, 0, 0.21]\n");
  const auto low = stack.of(0), left = stack.of(1), right = stack.of(2);
  ASSERT_EQ(low.size(), 3u);
  expect_force(low.at("floor"), 8);
  expect_force(low.at("left"), -1);
  expect_force(low.at("right"), -2);
  ASSERT_EQ(left.size(), 1u);
  expect_force(left.at("low"), 1);
  ASSERT_EQ(right.size(), 1u);
  expect_force(right.at("low"), 2);
  EXPECT_NEAR(left.at("low").place.x(), -0.2, 1e-3);
  EXPECT_NEAR(right.at("low").place.z(), 0.2, 0.02);  // within a contact width
}

// Edges cross edges: each of two parts touches two, all around. The centre of gravity divides the plank's
// weight between its supports by 0.3 to 0.7 m.
TEST(TouchingBodies, a_plank_presses_its_two_supports_by_the_lever) {
  const Resting plank(
      "[[block]]\nname = \"plank\"\nsize = [1.2, 0.2, 0.04]\nmass = 10\nwidth = 0.01\ncg = [0.2, 0, 0.02]\n"
      "at = [0, 0, 0.41]\n"
      "[[block]]\nname = \"left\"\nsize = [0.1, 0.5, 0.4]\nmass = 5\nwidth = 0.01\nat = [-0.5, 0, 0]\n"
      "[[block]]\nname = \"right\"\nsize = [0.1, 0.5, 0.4]\nmass = 5\nwidth = 0.01\nat = [0.5, 0, 0]\n");
  const auto on = plank.of(0);
  ASSERT_EQ(on.size(), 2u);
  const double left = on.at("left").force.z(), right = on.at("right").force.z();
  EXPECT_NEAR(left + right, 10 * k_weight, 1e-3 * 10 * k_weight);
  EXPECT_NEAR(plank.of(1).at("plank").force.z(), -left, 1e-6 * 10 * k_weight);
  // a support of 0.1 m bears somewhere between its edges
  EXPECT_GT(right / (10 * k_weight), 0.65);
  EXPECT_LT(right / (10 * k_weight), 0.75);
  EXPECT_NEAR(plank.of(1).at("floor").force.z(), 5 * k_weight + left, 1e-3 * 10 * k_weight);
  EXPECT_NEAR(plank.of(2).at("floor").force.z(), 5 * k_weight + right, 1e-3 * 10 * k_weight);
}

// Of 164 places between two boxes of members many are as near to a third part as to the one that they touch.
TEST(TouchingBodies, boxes_of_members_bear_what_stands_on_them) {
  const Resting stack(io::load_scene("stack", {"shake.1.on=false", "run.duration=0.2"}));
  for (std::size_t box = 1; box < 10; ++box) {
    const auto on = stack.of(box);
    ASSERT_EQ(on.size(), box < 9 ? 2u : 1u) << box;
    const auto expect = [&](const std::string& by, double kilograms) {
      EXPECT_NEAR(on.at(by).force.z(), kilograms * k_weight, 1e-3 * 80 * k_weight) << box << by;
      EXPECT_LT(on.at(by).force.head<2>().norm(), 1e-3 * 80 * k_weight) << box << by;
    };
    expect("box-" + std::to_string(box), 8. * static_cast<double>(10 - box));
    if (box < 9) expect("box-" + std::to_string(box + 2), -8. * static_cast<double>(9 - box));
  }
}

TEST(TouchingBodies, what_touches_nothing_has_no_touch) {
  const Resting alone("[[block]]\nname = \"high\"\nsize = [0.1, 0.1, 0.2]\nmass = 1\nat = [0, 0, 5]\n",
                      {"run.settle=false", "run.duration=0.1"});
  EXPECT_TRUE(alone.of(0).empty());
}

}  // namespace
}  // namespace topple::app
