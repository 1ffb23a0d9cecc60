// Panels of frames: what cannot be one, and what begins within a body of panels.
#include "scene_samples.h"

namespace topple::io {
namespace {

/// A table of four bars whose corner `last` and panel are given; 20 lines.
std::string table(const std::string& last, const std::string& nodes) {
  return k_head + k_library +
         "[[frame]]\nname = \"table\"\n"
         "nodes = [[0, 0, 0], [1, 0, 0], [1, 1, 0], " +
         last +
         "]\n"
         "members = [\n"
         "  { nodes = [0, 1], section = \"post\", material = \"steel\" },\n"
         "  { nodes = [1, 2], section = \"post\", material = \"steel\" },\n"
         "  { nodes = [2, 3], section = \"post\", material = \"steel\" },\n"
         "  { nodes = [3, 0], section = \"post\", material = \"steel\" },\n"
         "]\n"
         "panels = [{ nodes = [" +
         nodes + "] }]\n";
}

TEST(ScenePanel, what_is_wrong_with_it_is_one_line) {
  const std::string flat = "[0, 1, 0]", round = "0, 1, 2, 3",
                    at = "s.toml:21:10: frame.table.panels: panel 0";
  const std::string no_sheet = at + ": its corners are not those of a convex sheet, in order around it";
  EXPECT_EQ(error_of(table(flat, round)), "no error");
  // of no size, of no area, across itself, not convex
  for (const char* const nodes : {"0, 0, 0, 0", "0, 1, 1, 0", "0, 1, 2, 2", "0, 2, 1, 3"})
    EXPECT_EQ(error_of(table(flat, nodes)), no_sheet) << nodes;
  EXPECT_EQ(error_of(table("[0.9, 0.1, 0]", round)), no_sheet);
  // half of what a corner rises, of a diagonal of 1.414 m
  EXPECT_EQ(error_of(table("[0, 1, 0.0028]", round)), "no error");
  EXPECT_EQ(
      error_of(table("[0, 1, 0.003]", round)),
      at + " is not flat: its diagonals pass each other 1.5 mm apart, more than 1.414 mm, a thousandth of "
           "their length");
  EXPECT_EQ(error_of(table(flat, "0, 1, 2, 9")),
            "s.toml:21:31: frame.table.panels.1.nodes.4: 9 is not a node of the frame, which has 0..3");
  EXPECT_EQ(error_of(table(flat, "0, 1, 2")),
            "s.toml:21:21: frame.table.panels.1.nodes: expected a list of 4 values, found 3");
  EXPECT_EQ(error_of(replaced(table(flat, round),
                              "  { nodes = [2, 3], section = \"post\", material = \"steel\" },\n",
                              "  { nodes = [1, 3], section = \"post\", material = \"steel\" },\n")),
            at + ": no members lie all along its side between corners 2 and 3");
}

// Free between the back, the front, the shelf of 910 mm and the bottom; 20 mm is L, the half of it is too
// deep.
TEST(ScenePanel, what_begins_in_a_closed_cabinet_is_free_there_or_refused) {
  const auto inside = [](const std::string& at, const std::string& more = "") {
    return error_of(k_cabinet_scene + "shelves = 1\n" + more +
                    "[floor]\n[[block]]\nname = \"box\"\nsize = [0.2, 0.2, 0.2]\nmass = 2\nat = [" + at +
                    "]\n");
  };
  const std::string refused = "s.toml:18:1: block.box: the bodies \"box\" and \"free\" overlap at the start";
  EXPECT_EQ(inside("0, 0, 0.2"), "no error");
  EXPECT_EQ(inside("0, 0, 0.925"), "no error");
  EXPECT_EQ(inside("0, 0, 0.92"), "no error");
  EXPECT_EQ(inside("0, 0, 0.85"), refused);
  EXPECT_EQ(inside("0.15, 0, 0.2"), refused);
  EXPECT_EQ(inside("0.5, 0, 0.2"), "no error");
  EXPECT_EQ(inside("0.15, 0, 0.2", "front = \"open\"\n"), "no error");
  EXPECT_EQ(inside("0.085, 0, 0.2"), refused);
  EXPECT_EQ(inside("0.075, 0, 0.2"), "no error");
}

// With 4 mm they are 9 mm over the middle plane of the table's top: less than half of L = 20 mm.
TEST(ScenePanel, corners_that_begin_within_a_sheet_are_refused) {
  const auto on = [](const std::string& height) {
    return error_of(table("[0, 1, 0]", "0, 1, 2, 3") +
                    "[[block]]\nname = \"box\"\nsize = [0.2, 0.2, 0.2]\nmass = 2\nat = [0.4, 0.6, " + height +
                    "]\n");
  };
  EXPECT_EQ(on("0.015"), "no error");
  EXPECT_EQ(on("0.006"), "no error");
  const std::string overlap = "s.toml:22:1: block.box: the bodies \"box\" and \"table\" overlap at the start";
  EXPECT_EQ(on("0.004"), overlap);
  EXPECT_EQ(on("-0.01"), overlap);
}

}  // namespace
}  // namespace topple::io
