// What is checked in beside the code: the built-in scenes, the reference of their keys.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include "solver/io/scene/scene.h"
#include "solver/io/scene/scene_keys.h"

namespace topple::io {
namespace {

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Scene, built_in_scenes_are_read_and_have_titles) {
  std::vector<std::string> names;
  for (const BuiltinScene& builtin : builtin_scenes()) {
    names.emplace_back(builtin.name);
    EXPECT_EQ(builtin.text.front(), '#') << builtin.name;
    EXPECT_EQ(builtin.text, file_text(TOPPLE_SOURCE_DIR "/assets/scenes/" + names.back() + ".toml"));
    const Scene scene = load_scene(names.back());
    EXPECT_NE(scene.title, scene.name);
    EXPECT_EQ(scene.setup.starts.size(), scene.setup.model.bodies.size());
  }
  EXPECT_EQ(names, (std::vector<std::string>{"anchored",
                                             "beam-floor",
                                             "bookshelf",
                                             "breaking",
                                             "brittle-connector",
                                             "cabinet",
                                             "cantilever",
                                             "chair",
                                             "classroom",
                                             "collide",
                                             "desk",
                                             "dominoes",
                                             "floor-long-period",
                                             "folding-leg",
                                             "free-rocking",
                                             "moving-in",
                                             "near-fault",
                                             "office",
                                             "paper-a",
                                             "paper-b",
                                             "portal-pushover",
                                             "refrigerator",
                                             "sixth-floor",
                                             "stack",
                                             "tumble",
                                             "wardrobe",
                                             "weak-storey",
                                             "wedged",
                                             "yielding"}));
}

TEST(Scene, the_wall_of_the_paper_scenes_is_10_mm_behind_the_walled_cabinet_and_out_of_reach_of_the_other) {
  for (const char* name : {"paper-a", "paper-b"}) {
    const Model model = load_scene(name).setup.model;
    ASSERT_EQ(model.planes.size(), 2u);
    ASSERT_EQ(model.bodies.size(), 2u);
    const auto gap = [&](const Body& body) {
      double least = 1e9;
      for (int k = 0; k < body.contact_point_count; ++k) {
        const ContactPoint& point = model.contact_points[body.first_contact_point + k];
        const double l =
            (model.node_position[point.node] - model.planes[1].point).dot(model.planes[1].normal);
        least = std::min(least, l - point.width / 2);
      }
      return least;
    };
    EXPECT_NEAR(gap(model.bodies[1]), 0.010, 1e-9) << name;
    EXPECT_GT(gap(model.bodies[0]), model.bodies[0].name == "free" ? 1.79 + 0.2 : 1) << name;
    EXPECT_EQ((model.planes[0].width + model.contact_points[0].width) / 2, 0.06);
    for (const Body& body : model.bodies) {
      EXPECT_NEAR(body.mass, 40, 1e-9);
    }
  }
}

TEST(Scene, the_reference_that_is_checked_in_is_the_table_in_the_code) {
  const std::string path = TOPPLE_SOURCE_DIR "/assets/guide/scene-reference.md";
  if (std::getenv("TOPPLE_WRITE_REFERENCE")) std::ofstream(path, std::ios::binary) << scene_reference();
  EXPECT_EQ(file_text(path), scene_reference()) << "write it anew with TOPPLE_WRITE_REFERENCE=1 scene_test";
}

// What keys mean is shown in the window, too.
TEST(Scene, no_key_sends_its_reader_to_a_source_file) {
  const std::string reference = scene_reference();
  EXPECT_FALSE(std::regex_search(reference, std::regex("\\w\\.h\\b")));
}
}  // namespace
}  // namespace topple::io
