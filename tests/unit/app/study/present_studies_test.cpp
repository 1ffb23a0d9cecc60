// Studies that are computed beside the window, and the panels that show them.
#include "app/study/present_studies.h"

#include "app/panels/precision_words.h"
#include "app/panels/teaching_words.h"
#include "unit/app/shell_fixture.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

/// Without what takes time.
ordered_json table_of(const study::OverturnPlan& plan, const study::OverturnMap& map) {
  ordered_json rows = rows_as_json(plan, map);
  for (auto& row : rows) row.erase("cpu_s");
  return rows;
}

TEST(PresentStudies, the_map_has_the_rows_of_the_study_of_the_changed_scene) {
  const auto scene = live_scene(k_rocking, {"run.duration=0.3"});
  Parameters now = scene->setup.parameters;
  apply({Edit::Key::friction, 0, Vec3(0.2, 0, 0)}, scene->setup.model, 0, now);
  const auto search = search_overturning(*scene, now);
  ASSERT_TRUE(eventually([] {}, [&] { return search->result() && search->result()->map.run >= 8; }));
  search->stop();
  ASSERT_TRUE(eventually([] {}, [&] { return search->over(); }));
  const auto found = search->result();
  ASSERT_EQ(found->failure, "");

  const auto changed = live_scene(k_rocking, {"run.duration=0.3", "contact.friction=0.2"});
  const study::OverturnPlan plan = study::plan_overturn(*changed, "", "");
  study::OverturnRunner runner(plan);
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  int computed = 0;
  for (int k = 0; k < plan.cases(); ++k)
    if (found->map.points[static_cast<std::size_t>(k)].runs > 0) {
      rows[static_cast<std::size_t>(k)] = runner.run(k, [] { return false; });
      ++computed;
    }
  EXPECT_EQ(computed, found->map.run);
  EXPECT_EQ(table_of(*found->plan, found->map), table_of(plan, gather(plan, rows)));
}

TEST(PresentStudies, a_map_that_is_stopped_keeps_what_it_has) {
  const auto scene = live_scene(k_rocking, {"run.duration=20"});  // the whole map takes minutes
  const auto search = search_overturning(*scene, scene->setup.parameters);
  ASSERT_TRUE(eventually([] {}, [&] { return search->result() && search->result()->map.run > 0; }));
  search->stop();
  ASSERT_TRUE(eventually([] {}, [&] { return search->over(); }));
  const auto found = search->result();
  EXPECT_GT(found->map.run, 0);
  EXPECT_LT(found->map.run, found->map.of);
}

TEST(PresentStudies, what_cannot_be_computed_says_why) {
  const auto scene = std::make_shared<const io::Scene>(io::load_scene("near-fault"));
  const auto search = search_overturning(*scene, scene->setup.parameters);
  ASSERT_TRUE(eventually([] {}, [&] { return search->over(); }));
  EXPECT_NE(search->result()->failure.find("neither a sine nor a pulse"), std::string::npos);
}

class PresentPanels : public ShellTest {
 protected:
  /// A run at its start, with a panel's name and a button to press there.
  void open(const std::string& duration) {
    std::string text = k_rocking;
    text.replace(text.find("\"1 s\""), 5, duration);
    shell_->open(write("short.toml", text));
    ASSERT_TRUE(until([&] { return ready(); }));
  }
  Viewer& viewer() { return shell_->session()->viewer(); }
  void begin_map() {
    viewer().show(Viewer::Tab::teach);
    click(say(window_words::k_overturning_map) + "##map", "side/content");
  }
  /// With more patience: studies are made of many runs.
  template <typename Done>
  ::testing::AssertionResult until_computed(Done done) {
    for (int round = 0; round < 3; ++round)
      if (until(done)) return ::testing::AssertionSuccess();
    return until(done);
  }
  /// A map of which a part is there.
  void have_map() {
    begin_map();
    ASSERT_TRUE(
        until_computed([&] { return map().search->result() && map().search->result()->map.run > 0; }));
    click(say(window_words::k_cancel) + "##cancel-map", "side/content");
    ASSERT_TRUE(until([&] { return map().search->over(); }));
    frame();
  }
  const MapState& map() { return viewer().teaching().map; }
  const PrecisionState& precision() { return viewer().precision(); }
  void click_there(ImVec2 at) {
    click_at(at, [this] { frame(); });
    ImGui::GetIO().MousePos = {2, 400};
    frame();
  }
  ImVec2 middle_of(int i, int j) {
    const Box& cells = map().cells;
    const study::OverturnPlan& plan = *map().search->result()->plan;
    return {cells.left + (static_cast<float>(i) + 0.5f) / static_cast<float>(plan.x.count()) * cells.width,
            cells.top + cells.height -
                (static_cast<float>(j) + 0.5f) / static_cast<float>(plan.y.count()) * cells.height};
  }
};

TEST_F(PresentPanels, a_click_on_a_cell_shakes_like_it_and_one_undo_takes_it_back) {
  open("\"0.05 s\"");
  have_map();
  const Shake before = player().parameters().shakes[0];
  for (const auto& [i, j] : {std::pair(0, 0), std::pair(7, 19), std::pair(23, 23)}) {
    click_there(middle_of(i, j));
    const study::OverturnPlan& plan = *map().search->result()->plan;
    EXPECT_EQ(player().parameters().shakes[0].frequency, plan.x.in_si(i));
    EXPECT_EQ(player().parameters().shakes[0].amplitude, plan.y.in_si(j));
    player().undo();
    EXPECT_EQ(player().parameters().shakes[0].frequency, before.frequency);
    EXPECT_EQ(player().parameters().shakes[0].amplitude, before.amplitude);
  }
  player().play();
  ASSERT_TRUE(until([&] { return player().edits().size() == 12; }));  // recorded: two, and their undo
}

TEST_F(PresentPanels, the_buttons_below_the_map_go_to_the_next_cells) {
  open("\"0.05 s\"");
  have_map();
  click_there(middle_of(10, 10));
  const study::OverturnPlan& plan = *map().search->result()->plan;
  click("##higher", "side/content");
  click("##weaker", "side/content");
  EXPECT_EQ(player().parameters().shakes[0].frequency, plan.x.in_si(11));
  EXPECT_EQ(player().parameters().shakes[0].amplitude, plan.y.in_si(9));
}

TEST_F(PresentPanels, cancel_stops_the_map_and_leaves_what_there_is_until_it_is_closed) {
  open("\"60 s\"");
  have_map();
  EXPECT_LT(map().search->result()->map.run, 576);
  click(say(window_words::k_map_close) + "##close-map", "side/content");
  EXPECT_EQ(map().search, nullptr);
}

// A cabinet is run as a planar block: nobody asks for its map, and sliders other than the map's axes begin it
// anew.
TEST_F(PresentPanels, a_map_of_planar_blocks_appears_by_itself_and_follows_the_sliders) {
  shell_->open(write("cabinet.toml", io::load_scene("cabinet").text));
  ASSERT_TRUE(until([&] { return ready(); }));
  viewer().show(Viewer::Tab::teach);
  const auto whole = [&] { return map().shown && !map().shown->shares.empty(); };
  ASSERT_TRUE(until_computed([&] { return whole() && map().follows == MapState::Follows::yes; }));
  EXPECT_EQ(map().shown->map.run, 576);
  EXPECT_EQ(map().shown->map.planar, 576);
  const auto near_an_edge =
      std::ranges::count_if(map().shown->shares, [](const auto& s) { return s.has_value(); });
  EXPECT_GT(near_an_edge, 20);
  EXPECT_LT(near_an_edge, 400);
  const auto first = map().shown;
  player().edit({Edit::Key::amplitude, 0, Vec3(1.5, 0, 0)});  // an axis: the map stays
  for (int n = 0; n < 5; ++n) frame();
  EXPECT_EQ(map().shown, first);
  player().edit({Edit::Key::friction, 0, Vec3(0.1, 0, 0)});
  ASSERT_TRUE(until_computed([&] { return map().shown != first && whole() && map().shown->map.run == 576; }));
  EXPECT_EQ(map().shown_of.contact.friction, 0.1);
  for (const study::OverturnPoint& point : map().shown->map.points)
    EXPECT_EQ(point.overturned, 0);  // it slides away beneath: 0.1 g below West's 0.21 g
  // Askew it moves in no plane: until the shake is as it was there is a button for a map of whole runs.
  const Edit askew{Edit::Key::direction, 0, Vec3(1, 1, 0).normalized()};
  player().edit(askew);
  ASSERT_TRUE(until_computed([&] { return !map().shown; }));
  player().edit({Edit::Key::direction, 0, Vec3::UnitX()});
  ASSERT_TRUE(until_computed([&] { return whole(); }));
  player().edit(askew);
  ASSERT_TRUE(until_computed([&] { return !map().shown; }));
  click(say(window_words::k_overturning_map) + "##map", "side/content");
  EXPECT_EQ(map().follows, MapState::Follows::no);
  ASSERT_TRUE(until_computed([&] { return map().shown && map().shown->map.run > 0; }));
  click(say(window_words::k_cancel) + "##cancel-map", "side/content");
  ASSERT_TRUE(until([&] { return map().search->over(); }));
  click(say(window_words::k_map_close) + "##close-map", "side/content");
  for (int n = 0; n < 5; ++n) frame();
  EXPECT_EQ(map().shown, nullptr);
  EXPECT_EQ(map().search, nullptr);
}

TEST_F(PresentPanels, the_chart_of_precision_opens_beside_the_step_and_a_click_loads_a_setting) {
  open("\"0.05 s\"");
  click(say(window_words::k_precision) + "##precision", "side/content");
  ASSERT_TRUE(viewer().precision().open);
  ASSERT_TRUE(until_computed([&] { return precision().points.size() > 20; }));
  click(say(window_words::k_cancel) + "##cancel-precision", "###precision");
  ASSERT_TRUE(until([&] { return precision().search->over(); }));
  frame();
  frame();
  const auto found = precision().search->result();
  ASSERT_EQ(found->failure, "");
  ASSERT_GT(precision().points.size(), 20u);
  const Parameters before = player().parameters();
  int loaded = 0;
  for (const PrecisionPoint& point : std::vector(precision().points)) {
    const Parameters& wanted = found->parameters[static_cast<std::size_t>(point.k)];
    const bool alone = std::ranges::none_of(precision().points, [&](const PrecisionPoint& other) {
      return other.k != point.k && std::hypot(other.at.x - point.at.x, other.at.y - point.at.y) < 4;
    });
    const auto edits = edits_to(player(), wanted);
    if (!alone || !edits || edits->empty()) continue;
    click_there(point.at);
    EXPECT_EQ(player().parameters().time_step, wanted.time_step) << point.k;
    EXPECT_EQ(player().parameters().integrator, wanted.integrator) << point.k;
    EXPECT_EQ(player().parameters().models, wanted.models) << point.k;
    player().undo();
    EXPECT_EQ(player().parameters().time_step, before.time_step);
    EXPECT_EQ(player().parameters().models, before.models);
    ++loaded;
  }
  EXPECT_GT(loaded, 0);  // how many stand alone depends on what they cost on this machine
  press(render::key::escape);
  EXPECT_FALSE(viewer().precision().open);
}

TEST_F(PresentPanels, cancel_stops_the_chart_of_precision) {
  open("\"60 s\"");
  click(say(window_words::k_precision) + "##precision", "side/content");
  ASSERT_TRUE(until([&] { return precision().search && precision().search->result(); }));
  click(say(window_words::k_cancel) + "##cancel-precision", "###precision");
  ASSERT_TRUE(until([&] { return precision().search->over(); }));
  EXPECT_LT(precision().search->result()->study.run, precision().search->result()->study.of);
}

}  // namespace
}  // namespace topple::app
