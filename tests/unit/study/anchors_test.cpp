#include "solver/study/common/anchors.h"

#include <gtest/gtest.h>

#include "solver/io/scene/scene_file.h"

namespace topple::study {
namespace {

TEST(Anchors, a_scene_without_them_has_none_to_take_away) {
  const io::Scene scene = io::load_scene("paper-a");
  EXPECT_FALSE(without_anchors(scene));
}

TEST(Anchors, that_are_not_in_place_hold_nothing) {
  const std::vector<std::string> none{"anchor.1.on=false", "anchor.2.on=false"};
  EXPECT_FALSE(without_anchors(io::load_scene("anchored", none)));
  EXPECT_TRUE(without_anchors(io::load_scene("anchored", {none[0]})));
}

TEST(Anchors, all_of_them_are_taken_away_and_nothing_else) {
  const io::Scene bare = io::load_scene("near-fault");
  const io::Scene held = io::parse_scene(bare.text + R"(
[[anchor]]
name = "strap"
body = "free"
point = [-0.19, 0, 1.7]
to = [-0.25, 0, 1.7]
type = "strap"
stiffness = "50 kN/m"
)",
                                         bare.name, {}, io::kept_files(bare));
  ASSERT_EQ(held.setup.model.anchors.size(), 1u);
  const auto rest = without_anchors(held);
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->name, held.name);
  EXPECT_TRUE(rest->setup.model.anchors.empty());
  ASSERT_EQ(rest->files.size(), 1u);
  EXPECT_EQ(rest->files[0].bytes, bare.files[0].bytes);
  EXPECT_EQ(rest->setup.model.node_total(), bare.setup.model.node_total());
  EXPECT_EQ(rest->setup.run.duration, bare.setup.run.duration);
}

// A stopper leans a piece, of which the default of alpha would follow: without it the run is on the same
// contacts.
TEST(Anchors, what_is_left_stands_on_the_contacts_that_it_had) {
  const io::Scene held = io::parse_scene(
      "topple = 1\n[floor]\n[[wall]]\nname = \"back\"\nat = [0, 0]\nnormal = [1, 0, 0]\n[[furniture]]\nkind "
      "= \"shelf-rack\"\nname = \"rack\"\nagainst = \"back\"\n"
      "[[fixing]]\nkind = \"stopper\"\nname = \"stop\"\nbody = \"rack\"\nto = \"floor\"\n",
      "held.toml");
  const io::Scene own = io::parse_scene(held.text, "held.toml", {"fixing.stop.on=false"});
  const auto rest = without_anchors(held);
  ASSERT_TRUE(rest);
  EXPECT_NE(own.setup.parameters.contact.alpha, held.setup.parameters.contact.alpha);
  EXPECT_EQ(rest->setup.parameters.contact.alpha, held.setup.parameters.contact.alpha);
  EXPECT_EQ(rest->setup.parameters.contact.member_share, held.setup.parameters.contact.member_share);
}

}  // namespace
}  // namespace topple::study
