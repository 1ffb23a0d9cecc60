#include "solver/io/edit/scene_difference.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "solver/io/edit/edit_text.h"
#include "solver/io/edit/scene_number.h"

namespace topple::io {
namespace {

std::vector<SceneDifference> changed(const std::vector<std::string>& overrides) {
  return differences(load_scene("paper-a"), load_scene("paper-a", overrides));
}

TEST(SceneDifference, a_scene_is_like_itself) {
  for (const BuiltinScene& scene : builtin_scenes()) {
    const Scene loaded = load_scene(std::string(scene.name));
    EXPECT_TRUE(differences(loaded, loaded).empty()) << scene.name;
  }
}

TEST(SceneDifference, values_are_compared_and_not_how_they_are_written) {
  EXPECT_TRUE(changed({"shake.table.amplitude=1.9 m/s^2"}).empty());
  EXPECT_TRUE(changed({"cabinet.free.size=[0.38, 0.88, 1.79]"}).empty());
  EXPECT_TRUE(changed({"cabinet.free.yaw=0 deg"}).empty());                  // the default
  EXPECT_TRUE(changed({"run.stop_when=never", "run.settle=true"}).empty());  // likewise
}

TEST(SceneDifference, both_values_are_told_in_the_unit_of_the_key) {
  const auto found = changed({"contact.alpha=1000 N", "run.time_step=auto", "cabinet.walled.yaw=1 deg"});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].key, "run.time_step");
  EXPECT_EQ(*found[0].b, "auto");
  EXPECT_EQ(found[1].key, "contact.alpha");
  EXPECT_EQ(*found[1].a, "50 kgf");
  EXPECT_EQ(*found[1].b, "101.972 kgf");
  EXPECT_EQ(found[2].key, "cabinet.walled.yaw");
  EXPECT_EQ(*found[2].a, "0 deg");
  EXPECT_EQ(*found[2].b, "1 deg");
}

TEST(SceneDifference, what_is_chosen_where_it_is_left_out_is_what_the_run_takes) {
  const Scene chosen = load_scene("refrigerator"),
              stated = load_scene("refrigerator", {"contact.alpha=9 MN"});
  const double alpha = chosen.setup.parameters.contact.alpha;
  EXPECT_GT(alpha, 1e4);  // not the 50 kgf of a scene without a floor
  EXPECT_EQ(number_in(chosen, "contact.alpha").value, alpha);
  const auto found = differences(chosen, stated);
  const auto of_alpha = std::ranges::find(found, "contact.alpha", &SceneDifference::key);
  ASSERT_NE(of_alpha, found.end());
  EXPECT_EQ(*of_alpha->a, value_text(*find_key("contact", "alpha"), alpha));
}

TEST(SceneDifference, what_is_chosen_for_each_scene_differs_where_both_leave_it_out) {
  const Scene light = load_scene("refrigerator"), heavy = load_scene("refrigerator", {"cabinet.1.mass=200"});
  const auto found = differences(light, heavy);
  const auto of_alpha = std::ranges::find(found, "contact.alpha", &SceneDifference::key);
  ASSERT_NE(of_alpha, found.end());
  EXPECT_NE(*of_alpha->a, *of_alpha->b);
  EXPECT_TRUE(differences(light, light).empty());
}

TEST(SceneDifference, a_step_that_follows_the_contact_is_automatic_whether_the_scene_says_so_or_not) {
  const Scene chosen = load_scene("refrigerator"), said = load_scene("refrigerator", {"run.time_step=auto"});
  ASSERT_TRUE(chosen.setup.parameters.adaptive);
  EXPECT_TRUE(differences(chosen, said).empty());
  EXPECT_FALSE(number_in(chosen, "run.time_step").value);
}

// It is chosen with alpha, where the scene leaves that out.
TEST(SceneDifference, a_share_of_alpha_between_members_may_differ_where_both_leave_it_out) {
  const auto found = differences(load_scene("moving-in"), load_scene("moving-in", {"contact.alpha=9 MN"}));
  EXPECT_NE(std::ranges::find(found, "contact.member_share", &SceneDifference::key), found.end());
}

TEST(SceneDifference, an_entry_that_one_has_alone_is_one_line) {
  const Scene a = load_scene("paper-a");
  const Scene b = load_scene("paper-b");
  int entries = 0;
  for (const SceneDifference& d : differences(a, b)) {
    if (d.key == "cabinet.free" && d.a == "present" && !d.b) ++entries;
    if (d.key == "cabinet.lying" && !d.a && d.b == "present") ++entries;
    EXPECT_FALSE(d.key.starts_with("cabinet.free.")) << d.key;
  }
  EXPECT_EQ(entries, 2);
}

}  // namespace
}  // namespace topple::io
