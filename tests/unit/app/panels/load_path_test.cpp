// The path of static runs as the window draws it, live and from recordings.
#include "app/panels/load_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/batch/load_steps.h"
#include "app/batch/summary.h"
#include "render/scene/ticks.h"
#include "unit/app/live.h"
#include "unit/render/scratch.h"

namespace topple::app {
namespace {

/// A cantilever of 1 m under 10 N at its tip, with what more is said of it and of the run.
std::string cantilever(const std::string& more, const std::string& run = "") {
  return "topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\n" + run + k_library + R"(
[[frame]]
name = "beam"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "post", material = "steel" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = [0, 0, "-10 N"] }]
)" + more;
}

std::vector<RowPtr> way_of(const Setup& setup) {
  topple::Run run(setup);
  std::vector<RowPtr> way{std::make_shared<const io::FrameRow>(io::frame_row(run))};
  while (!run.over()) {
    EXPECT_TRUE(run.advance().ok());
    way.push_back(std::make_shared<const io::FrameRow>(io::frame_row(run)));
  }
  return way;
}

// Rows hold single precision.
TEST(LoadPath, the_controlled_node_moves_in_equal_parts) {
  const io::Scene scene = io::parse_scene(
      cantilever("", "load_steps = 4\ncontrol = { node = 1, dof = \"z\", to = \"-40 mm\" }\n"), "s.toml");
  const std::vector<RowPtr> way = way_of(scene.setup);
  const PathMeasure measure = path_measure(scene.setup, *way.front(), *way.back());
  EXPECT_EQ(name_of(scene.setup, measure), "beam node 1, z");
  const std::vector<double> along = travels(scene.setup.model, measure, way);
  ASSERT_EQ(along.size(), 5u);
  for (std::size_t i = 0; i < along.size(); ++i) EXPECT_NEAR(along[i], -0.01 * static_cast<double>(i), 1e-8);
}

// At its first step a path has the travel of rounding.
TEST(LoadPath, an_axis_of_rounding_alone_has_numbers_that_can_be_read) {
  const auto decimals = [](const PathAxis& axis) {
    return render::nice_ticks(axis.low, axis.high, 5).decimals;
  };
  for (const std::vector<double>& values : {std::vector<double>{0}, {3e-17}, {-2e-9, 1e-16}})
    EXPECT_LE(decimals({values, 1e-3}), 1) << values.front();
  const PathAxis moved({0, 2, 5}, 1e-3);
  EXPECT_EQ(moved.low, 0);
  EXPECT_NEAR(moved.high, 5.6, 1e-12);
}

TEST(LoadPath, without_control_the_first_probe_or_the_node_that_moves_most_is_shown) {
  const io::Scene plain = io::parse_scene(cantilever(""), "s.toml");
  const std::vector<RowPtr> way = way_of(plain.setup);
  EXPECT_EQ(name_of(plain.setup, path_measure(plain.setup, *way.front(), *way.back())), "beam node 1, z");
  const io::Scene probe =
      io::parse_scene(cantilever("[[probe]]\nname = \"whole\"\nbody = \"beam\"\n"), "s.toml");
  const PathMeasure whole = path_measure(probe.setup, *way.front(), *way.back());
  EXPECT_EQ(name_of(probe.setup, whole), "whole, z");
  EXPECT_EQ(whole.node, -1);
  // The centre of gravity is lumped at ends and middle: between them and the tip.
  const double tip = travels(plain.setup.model, {0, 1, 2}, way).back();
  const double centre = travels(probe.setup.model, whole, way).back();
  EXPECT_LT(tip, centre);
  EXPECT_LT(centre, 0.2 * tip);
}

TEST(LoadPath, turns_are_counted_beyond_half_a_turn) {
  const io::Scene scene = io::parse_scene(cantilever(""), "s.toml");
  std::vector<RowPtr> way;
  for (int i = 0; i <= 12; ++i) {
    io::FrameRow row = io::blank_row(io::row_shape(scene.setup.model));
    const double half = i * k_pi / 6;  // a sixth of a turn each
    row.rotation[4] = static_cast<float>(std::cos(half));
    row.rotation[6] = static_cast<float>(std::sin(half));
    way.push_back(std::make_shared<const io::FrameRow>(row));
  }
  const std::vector<double> along = travels(scene.setup.model, {0, 1, 4}, way);
  for (std::size_t i = 0; i < along.size(); ++i)
    EXPECT_NEAR(along[i], static_cast<double>(i) * k_pi / 3, 1e-6);
}

TEST(LoadPath, the_nearest_point_is_by_distance_and_not_along_an_axis) {
  EXPECT_EQ(nearest_point({{0, 0}, {10, 0}, {10, 50}, {0, 50}}, {9, 30}), 2u);
  EXPECT_EQ(nearest_point({{0, 0}, {10, 0}, {10, 50}, {0, 50}}, {-100, 20}), 0u);
}

/// A column that buckles, after a load step at which it still stands; Euler's load is pi^2 EI / 4 = 8.2 kN.
const std::string k_column =
    "topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\nload_steps = 4\n" + k_library + R"(
[[frame]]
name = "column"
nodes = [[0, 0, 0], [0, 0, 1]]
members = [{ nodes = [0, 1], section = "post", material = "steel", elements = 4, up = [1, 0, 0] }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = [0, 0, "-60 kN"] }]
)";

TEST(LoadPath, summaries_tell_of_their_load_steps_again) {
  const io::Scene scene = io::parse_scene(k_column, "s.toml");
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const std::vector<LoadStep> read =
      load_steps_in(json_text(summary(scene, run, "completed", 0)), scene.setup.model);
  ASSERT_EQ(read.size(), run.load_steps().size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    const LoadStep& ran = run.load_steps()[i];
    EXPECT_EQ(read[i].factor, ran.factor);
    EXPECT_EQ(read[i].converged, ran.converged);
    EXPECT_EQ(read[i].stability.loss, ran.stability.loss);
    EXPECT_EQ(read[i].stability.negative_pivots, ran.stability.negative_pivots);
    EXPECT_EQ(read[i].stability.node, ran.stability.node);
  }
  EXPECT_EQ(read.back().stability.loss, Stability::Loss::buckling);
  for (const char* text : {"", "{", "[]", "{\"static\": 1}", "{\"static\": [1]}"})
    EXPECT_TRUE(load_steps_in(text, scene.setup.model).empty()) << text;
  const std::vector<LoadStep> odd =
      load_steps_in(R"({"static": [{"converged": 1, "loss": 2, "mode": {"body": "column", "node": 99}}]})",
                    scene.setup.model);
  ASSERT_EQ(odd.size(), 1u);
  EXPECT_EQ(odd[0].stability.node, -1);
}

TEST(LoadPath, what_a_step_without_equilibrium_loses_is_told_of_the_one_before) {
  Stability buckles;
  buckles.loss = Stability::Loss::buckling;
  buckles.negative_pivots = 1;
  Stability stable;
  stable.negative_pivots = 0;
  const std::vector<LoadStep> steps{{0.5, true, stable}, {1, false, buckles}};
  const std::vector<Stability> told = stabilities(steps);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].loss, Stability::Loss::buckling);
  EXPECT_TRUE(told[0].stable());
  EXPECT_TRUE(stabilities(std::span(steps).last(1)).empty());
}

TEST(LoadPath, a_replay_tells_the_stability_of_each_load_step_as_the_run_did) {
  const render::Scratch scratch;
  const std::string path = (scratch / "column.h5").string();
  const auto scene = live_scene(k_column);
  std::vector<int> pivots;
  const auto collect = [&](const Player& player) {
    std::vector<int> out;
    for (const RowPtr& row : player.way()) {
      const Stability* const told = player.stability(*row);
      out.push_back(told ? told->negative_pivots : -1);
    }
    return out;
  };
  {
    LiveRun run({.scene = scene, .recording = {}, .output = path});
    Player player(scene, run);
    ASSERT_TRUE(eventually([&] { player.update(0.01); }, [&] { return player.can_edit(); }));
    player.play();
    ASSERT_TRUE(eventually([&] { player.update(0.01); },
                           [&] { return player.status().kind == LiveStatus::Kind::over; }));
    pivots = collect(player);
    run.close("stopped");
  }
  ASSERT_EQ(pivots.size(), 5u);
  EXPECT_EQ(pivots[0], -1);  // of the unloaded column nothing is told
  EXPECT_GE(pivots[4], 2);   // it is free to buckle in two directions
  LiveRun run({.scene = scene, .recording = io::Recording(path)});
  Player player(scene, run);
  ASSERT_TRUE(eventually([&] { player.update(0.01); },
                         [&] { return player.status().kind == LiveStatus::Kind::replay; }));
  EXPECT_EQ(collect(player), pivots);
}

}  // namespace
}  // namespace topple::app
