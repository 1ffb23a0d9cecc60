#include "solver/study/common/anchors.h"

#include <gtest/gtest.h>

namespace topple::study {
namespace {

TEST(Anchors, a_scene_without_them_has_none_to_take_away) {
  const io::Scene scene = io::load_scene("paper-a");
  EXPECT_EQ(anchor_count(scene), 0);
  EXPECT_FALSE(without_anchors(scene));
}

TEST(Anchors, all_of_them_are_taken_away_and_nothing_else) {
  const io::Scene bare = io::load_scene("near-fault");
  io::Scene held = bare;
  held.text += R"(
[[anchor]]
name = "strap"
body = "free"
point = [-0.19, 0, 1.7]
to = [-0.25, 0, 1.7]
type = "strap"
stiffness = "50 kN/m"
[[anchor]]
body = "free"
)";
  EXPECT_EQ(anchor_count(held), 2);
  const auto rest = without_anchors(held);
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->name, bare.name);
  EXPECT_EQ(anchor_count(*rest), 0);
  ASSERT_EQ(rest->files.size(), 1u);
  EXPECT_EQ(rest->files[0].bytes, bare.files[0].bytes);
  EXPECT_EQ(rest->setup.model.node_total(), bare.setup.model.node_total());
  EXPECT_EQ(rest->setup.run.duration, bare.setup.run.duration);
}

}  // namespace
}  // namespace topple::study
