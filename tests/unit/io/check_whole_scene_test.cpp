// All errors of a scene at once.
#include "scene_samples.h"
#include "solver/io/check/scene_errors.h"

namespace topple::io {
namespace {

using Lines = std::vector<std::string>;

CheckedScene checked(const std::string& text, const Lines& overrides = {}) {
  return check_whole_scene({text, "s.toml", files_beside("s.toml")}, overrides);
}

// Without its place the second shelf stands where the first one does.
TEST(CheckWholeScene, an_overlap_that_follows_from_a_misspelt_place_is_not_told) {
  const std::string text =
      "topple = 1\n[floor]\n[[furniture]]\nname = \"a\"\nkind = \"bookshelf\"\nat = [0, 0]\n"
      "[[furniture]]\nname = \"b\"\nkind = \"bookshelf\"\nbesides = \"a\"\n";
  const CheckedScene found = checked(text);
  ASSERT_EQ(found.errors.size(), 1u) << testing::PrintToString(found.errors);
  EXPECT_NE(found.errors[0].find("furniture.b.besides: "), std::string::npos) << found.errors[0];
}

TEST(CheckWholeScene, what_overlaps_hides_nothing_else) {
  const std::string text =
      "topple = 1\n[floor]\n[[wall]]\nname = \"back\"\nat = [-1, 0]\nnormal = [1, 0, 0]\n"
      "[[furniture]]\nname = \"a\"\nkind = \"chest\"\nat = [2, 0]\n"
      "[[furniture]]\nname = \"b\"\nkind = \"chest\"\nat = [2.2, 0]\n"
      "[[block]]\nname = \"c\"\nsize = [0.3, 0.3, 0.3]\nmass = 10\nat = [2.1, 0]\n"
      "[[fixing]]\nname = \"far\"\nkind = \"L-bracket\"\nbody = \"b\"\nto = \"back\"\n"
      "[[place]]\nname = \"inside\"\nat = [2, 0]\n";
  const CheckedScene found = checked(text);
  ASSERT_EQ(found.errors.size(), 4u) << testing::PrintToString(found.errors);
  EXPECT_NE(found.errors[0].find("furniture.a: the bodies"), std::string::npos) << found.errors[0];
  EXPECT_NE(found.errors[1].find("furniture.b: the bodies"), std::string::npos) << found.errors[1];
  EXPECT_NE(found.errors[2].find("fixing.far.to: finds no point"), std::string::npos) << found.errors[2];
  EXPECT_NE(found.errors[3].find("place.inside.at: lies inside"), std::string::npos) << found.errors[3];
}

TEST(CheckWholeScene, ten_thousand_pieces_are_refused_in_one_line) {
  std::string text = "topple = 1\n[floor]\n";
  for (int k = 0; k < 10000; ++k)
    text += "[[furniture]]\nkind = \"bookshelf\"\nat = [" + std::to_string(2 * (k % 100)) + ", " +
            std::to_string(2 * (k / 100)) + "]\n";
  const CheckedScene found = checked(text);
  ASSERT_EQ(found.errors.size(), 1u);
  EXPECT_NE(found.errors[0].find("elements, more than 100000"), std::string::npos) << found.errors[0];
}

TEST(CheckWholeScene, eight_errors_of_eight_kinds_are_told_in_the_order_of_the_file) {
  const std::string text =
      "topple = 1\n"
      "[run]\n"
      "duration = \"-3 s\"\n"     // 3: out of range
      "integrator = \"magic\"\n"  // 4: no word of the choice; beta below follows from it
      "beta = 0.3\n"
      "[[shake]]\n"
      "amplitude = \"190 kg\"\n"  // 7: another dimension; the shake needs it, but that follows
      "frequency = \"0.5 Hz\"\n"
      "[floor]\n"
      "[[wall]]\n"
      "name = \"back\"\n"
      "at = [-3, 0]\n"
      "normal = [0, 0, 0]\n"  // 13: found by the reader
      "[[material]]\n"
      "name = \"steel\"\n"
      "young = \"205 GPa\"\n"
      "poisson = 0.7\n"  // 17: required; whoever is made of steel is not blamed
      "density = \"7850 kg/m^3\"\n"
      "[[section]]\n"
      "name = \"post\"\n"
      "shape = \"box\"\n"
      "size = [\"30 mm\", \"30 mm\"]\n"
      "thickness = \"20 mm\"\n"  // 23: found by the reader
      "[[cabinet]]\n"
      "name = \"free\"\n"
      "section = \"post\"\n"
      "material = \"steel\"\n"
      "colour = \"red\"\n"  // 28: unknown
      "[[probe]]\n"
      "body = \"free\"\n"
      "[[probe]]\n"
      "body = \"nobody\"\n";  // 32: a name that nothing has
  const CheckedScene found = checked(text);
  EXPECT_FALSE(found.scene);
  ASSERT_EQ(found.errors.size(), 8u) << testing::PrintToString(found.errors);
  const Lines begins = {"s.toml:3:12: run.duration: ",
                        "s.toml:4:14: run.integrator: ",
                        "s.toml:7:13: shake.1.amplitude: ",
                        "s.toml:13:10: wall.back.normal: ",
                        "s.toml:17:11: material.steel.poisson: ",
                        "s.toml:23:13: section.post.thickness: ",
                        "s.toml:28:1: cabinet.free.colour: ",
                        "s.toml:32:8: probe.2.body: "};
  for (std::size_t k = 0; k < begins.size(); ++k)
    EXPECT_TRUE(found.errors[k].starts_with(begins[k])) << found.errors[k];
}

TEST(CheckWholeScene, first_error_is_that_which_a_run_is_refused_for) {
  for (const char* lines :
       {"[contact]\nfriction = 2\n", "[[probe]]\nbody = \"no\"\n", "[[cabinet]]\n", "x = \"\n"})
    EXPECT_EQ(checked(k_scene + lines).errors, Lines{after_beam(lines)});
}

TEST(CheckWholeScene, what_is_right_is_a_scene) {
  const CheckedScene found = checked(k_scene);
  EXPECT_TRUE(found.scene);
  EXPECT_EQ(found.errors, Lines{});
  EXPECT_EQ(found.scene->text, k_scene);
}

TEST(CheckWholeScene, copies_and_fittings_of_what_is_wrong_are_not_blamed) {
  const std::string text = k_cabinet_scene + "copies = [[0, 0, 0], [1, 0, 0]]\nmass = \"no\"\n" +
                           "size = [1, 2]\n[[probe]]\nbody = \"free-2\"\n[[probe]]\nbody = \"free-3\"\n";
  const CheckedScene found = checked(text);
  ASSERT_EQ(found.errors.size(), 3u) << testing::PrintToString(found.errors);
  EXPECT_TRUE(found.errors[0].starts_with("s.toml:17:8: cabinet.free.mass: "));
  EXPECT_TRUE(found.errors[1].starts_with("s.toml:18:8: cabinet.free.size: "));
  EXPECT_TRUE(found.errors[2].starts_with("s.toml:22:8: probe.2.body: "));
}

// Another piece stands beside it, and without that key it would stand in the wall.
TEST(CheckWholeScene, a_misspelt_kind_is_one_error) {
  const CheckedScene found = checked(
      "topple = 1\n[floor]\n[[wall]]\nname = \"back\"\nat = [0, 0]\nnormal = [1, 0, 0]\n"
      "[[furniture]]\nkind = \"bookshelff\"\nagainst = \"back\"\n"
      "[[furniture]]\nkind = \"filing-cabinet\"\nbeside = \"bookshelf\"\n");
  ASSERT_EQ(found.errors.size(), 1u) << testing::PrintToString(found.errors);
  EXPECT_NE(found.errors[0].find("the nearest is bookshelf"), std::string::npos) << found.errors[0];
}

// Nor is what goes by where the other stands, and each of two kinds is told what there is.
TEST(CheckWholeScene, what_stands_beside_a_misspelt_kind_is_not_blamed) {
  const CheckedScene found = checked(
      "topple = 1\n[floor]\n[[wall]]\nname = \"back\"\nat = [-2, 0]\nnormal = [1, 0, 0]\n"
      "[[furniture]]\nkind = \"filing cabinet\"\nname = \"F1\"\nagainst = \"back\"\n"
      "[[furniture]]\nkind = \"cabinet\"\nname = \"C2\"\nbeside = \"F1\"\ngap = \"5 mm\"\n"
      "[[furniture]]\nkind = \"bookcase\"\nname = \"books\"\nat = [1, 2]\n"
      "[[place]]\nname = \"A\"\nat = [0, 0]\n");
  ASSERT_EQ(found.errors.size(), 2u) << testing::PrintToString(found.errors);
  EXPECT_NE(found.errors[0].find("the nearest is filing-cabinet"), std::string::npos) << found.errors[0];
  EXPECT_NE(found.errors[1].find("known: bed, bookshelf"), std::string::npos) << found.errors[1];
}

TEST(CheckWholeScene, entries_keep_their_numbers_behind_one_that_is_left_out) {
  const CheckedScene found = checked(k_scene + "[[probe]]\n[[probe]]\nbody = \"beam\"\nnode = 7\n");
  ASSERT_EQ(found.errors.size(), 2u);
  EXPECT_TRUE(found.errors[0].starts_with("s.toml:17:1: probe.1.body: missing")) << found.errors[0];
  EXPECT_TRUE(found.errors[1].starts_with("s.toml:20:8: probe.2.node: 7 is not a node")) << found.errors[1];
}

TEST(CheckWholeScene, overrides_are_blamed_by_their_text) {
  const CheckedScene found = checked(k_scene, {"contact.friction=9", "nonsense", "run.tolerance=7"});
  EXPECT_FALSE(found.scene);
  ASSERT_EQ(found.errors.size(), 3u) << testing::PrintToString(found.errors);
  EXPECT_TRUE(found.errors[0].starts_with("--set nonsense: "));
  for (const std::size_t k : {1u, 2u}) EXPECT_TRUE(found.errors[k].starts_with("--set ")) << found.errors[k];
}

}  // namespace
}  // namespace topple::io
