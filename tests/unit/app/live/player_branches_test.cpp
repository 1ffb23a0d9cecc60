// Runs that begin anew from their start, from a recording, or from what another recording holds.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "unit/app/live/player_fixture.h"

namespace topple::app {
namespace {

TEST_F(PlayerTest, restart_keeps_the_sliders_and_is_a_branch_from_the_start) {
  start();
  run_to(0.2);
  player().edit(amplitude(450));
  run_to(0.3);
  player().restart();
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && player().can_edit(); }));
  EXPECT_EQ(player().time(), 0);
  EXPECT_NEAR(player().parameters().shakes[0].amplitude, 450 * k_gal, 1e-12);
  // the branch began with it, the scene did not
  const std::vector<Edit> edits = player().edits_from(player().scene().setup.parameters);
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_EQ(edits[0].key, Edit::Key::amplitude);
  run_to(0.3);
  EXPECT_NEAR(player().parameters().shakes[0].amplitude, 450 * k_gal, 1e-12);
  const RowPtr row = row_at_step(125);
  EXPECT_EQ(player().shown_branch(), 1);
  player().show_branch(0);
  EXPECT_FALSE(player().can_edit());
  EXPECT_EQ(player().shown_branch(), 0);
  EXPECT_EQ(player().way().front()->branch, 0);
  run_->close("stopped");
  expect_repeatable("live.h5", 2);
}

TEST_F(PlayerTest, a_branch_is_live_until_its_run_ends) {
  start();
  EXPECT_TRUE(player().is_live(0));
  run_to_end();
  EXPECT_FALSE(player().is_live(0));
  player().scrub(0.2);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && player().can_edit(); }));
  EXPECT_FALSE(player().is_live(0));
  EXPECT_TRUE(player().is_live(1));
}

/// What a run of k_rocking from the start with other keys records.
std::vector<io::FrameRow> rows_with(const std::vector<std::string>& overrides) {
  const auto scene = live_scene(k_rocking, overrides);
  topple::Run run(scene->setup);
  io::Observer observer;
  std::vector<io::FrameRow> rows = observer.observe(run).frames;
  while (!run.over() && run.advance().ok())
    for (io::FrameRow& row : observer.observe(run).frames) rows.push_back(std::move(row));
  return rows;
}

TEST_F(PlayerTest, what_is_changed_at_the_very_start_is_as_if_the_scene_had_said_it) {
  const Edit hard{Edit::Key::alpha, 0, Vec3(3600 * k_standard_gravity, 0, 0)};
  const std::vector<io::FrameRow> said =
      rows_with({"contact.alpha=\"3600 kgf\"", "shake.1.amplitude=\"450 gal\""});
  const auto expect_said = [&](std::int32_t branch) {
    ASSERT_EQ(player().way().size(), said.size());
    for (std::size_t i = 0; i < said.size(); ++i) {
      EXPECT_EQ(player().way()[i]->branch, branch);
      expect_same_motion(*player().way()[i], said[i]);
    }
  };
  start();
  const io::FrameRow as_opened = *player().row();
  player().edit(hard);
  player().begin_edit();
  player().edit(amplitude(450));
  ASSERT_TRUE(until([&] { return player().edits().size() == 2; }));
  expect_same_motion(*player().row(), said.front());
  run_to_end();
  expect_said(0);
  player().restart();
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && player().can_edit(); }));
  run_to(0.1);
  player().undo();
  player().undo();
  run_to(0.3);
  player().restart();  // as it was opened
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 3 && player().can_edit(); }));
  expect_same_motion(*player().row(), as_opened);
  player().edit(hard);
  player().edit(amplitude(450));
  run_to_end();
  expect_said(2);
  run_->close("stopped");
  expect_repeatable("live.h5", 3);

  replay("live.h5", "again.h5");
  player().scrub(0.2);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().can_edit(); }));
  run_to_end();
  for (std::size_t i = 0; i < said.size(); ++i) expect_same_motion(*player().way()[i], said[i]);
  run_->close("stopped");
  expect_repeatable("again.h5", 4);
}

TEST_F(PlayerTest, a_change_at_the_very_start_is_taken_back_and_recorded_once) {
  start();
  const io::FrameRow as_opened = *player().row();
  for (int i = 1; i <= 20; ++i)
    player().edit({Edit::Key::alpha, 0, Vec3(100 * i * k_standard_gravity, 0, 0)});
  ASSERT_TRUE(until([&] { return player().edits().size() == 20; }));
  EXPECT_NE(player().row()->position, as_opened.position);
  player().undo();
  ASSERT_TRUE(until([&] { return player().edits().size() == 21; }));
  expect_same_motion(*player().row(), as_opened);
  ASSERT_EQ(player().way().size(), 1u);
  expect_same_motion(*player().way().front(), as_opened);
  run_->close("stopped");
  EXPECT_EQ(io::Recording(path("live.h5")).frame_count(), 1);
}

TEST_F(PlayerTest, a_change_at_the_very_start_that_does_not_settle_says_so_and_may_be_taken_back) {
  start();
  const io::FrameRow as_opened = *player().row();
  player().edit({Edit::Key::alpha, 0, Vec3(0.001 * k_standard_gravity, 0, 0)});
  ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::failed; }));
  EXPECT_NE(player().status().message.find("does not come to rest"), std::string::npos);
  player().undo();
  ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::halted; }));
  expect_same_motion(*player().row(), as_opened);
  run_to_end();
  run_->close("stopped");
  expect_repeatable("live.h5", 1);
}

TEST_F(PlayerTest, a_recording_is_replayed_and_comes_to_life_in_a_file_of_its_own) {
  start();
  run_to(0.2);
  player().edit(amplitude(500));
  run_to(0.6);
  run_->close("stopped");
  const std::vector<RowPtr> before = player().way();
  player_.reset();
  run_.reset();

  io::Recording recording(path("live.h5"));
  start({.scene = live_scene(recording.scene_text()),
         .recording = std::move(recording),
         .output = path("again.h5")});
  EXPECT_TRUE(player().replay());
  EXPECT_FALSE(player().can_edit());
  ASSERT_GE(player().way().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) expect_same_motion(*player().way()[i], *before[i]);
  player().play();
  ASSERT_TRUE(until([&] { return !player().playing(); }));
  EXPECT_EQ(player().time(), player().end());
  EXPECT_FALSE(std::filesystem::exists(path("again.h5")));

  player().scrub(0.3);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().can_edit(); }));
  EXPECT_NEAR(player().parameters().shakes[0].amplitude, 500 * k_gal, 1e-12);
  run_to(0.5);
  expect_same_motion(
      *row_at_step(450), *[&] {
        for (const RowPtr& row : before)
          if (row->step == 450) return row;
        return before.back();
      }());
  run_->close("stopped");
  expect_repeatable("again.h5", 2);
}

TEST_F(PlayerTest, a_recording_that_goes_on_behind_a_checkpoint_knows_what_came_before) {
  std::string text = k_rocking;
  text.replace(text.find("duration = \"1 s\""), 16, "duration = \"1.2 s\"");
  start(text);
  player().edit(amplitude(500));
  run_to_end();
  run_->close("completed");
  player_.reset();
  run_.reset();
  replay("live.h5", "again.h5");
  player().scrub(1.15);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().can_edit(); }));
  run_to_end();
  run_->close("completed");
  const auto summary_of = [&](const char* name) {
    return nlohmann::json::parse(io::Recording(path(name)).summary_json());
  };
  const nlohmann::json first = summary_of("live.h5"), again = summary_of("again.h5");
  ASSERT_LT(first["bodies"][0]["first_uplift_s"], 1);
  EXPECT_EQ(again["bodies"], first["bodies"]);
  EXPECT_FALSE(again.contains("counted_from_s"));
}

TEST_F(PlayerTest, a_branch_of_a_branch_is_read_with_all_that_led_to_it) {
  std::string text = k_rocking;
  text.replace(text.find("duration = \"1 s\""), 16, "duration = \"1 s\"\noutput_rate = 1000");
  start(text);
  run_to(0.6);
  for (const double fork : {0.4, 0.5}) {
    player().scrub(fork);
    player().continue_from_here();
    ASSERT_TRUE(until([&] { return player().can_edit(); }));
    run_to(0.65);
  }
  run_->close("stopped");
  player_.reset();
  run_.reset();
  replay("live.h5", "again.h5");
  ASSERT_TRUE(until([&] { return player().way().back()->time > 0.64; }));
  const std::vector<RowPtr>& way = player().way();
  EXPECT_EQ(way.back()->branch, 2);
  EXPECT_EQ(way.front()->time, 0);
  for (std::size_t k = 1; k < way.size(); ++k) {
    EXPECT_GT(way[k]->time, way[k - 1]->time) << k;
    EXPECT_LT(way[k]->time, way[k - 1]->time + 1.5e-3) << k;
  }
}

TEST_F(PlayerTest, a_recording_from_which_no_run_goes_on_is_shown_and_says_so) {
  io::Recording recording(TOPPLE_SOURCE_DIR "/tests/recordings/format-3.h5");
  const auto scene = std::make_shared<const io::Scene>(io::recorded_scene(recording));
  start({.scene = scene, .recording = std::move(recording), .output = path("again.h5")});
  EXPECT_EQ(player().way().size(), 7u);
  player().scrub(0.2);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return !player().status().message.empty(); }));
  EXPECT_NE(player().status().message.find("has format 3"), std::string::npos);
  EXPECT_EQ(player().status().kind, LiveStatus::Kind::replay);
  ASSERT_TRUE(until([&] { return player().can_continue(); }));
  EXPECT_EQ(player().row()->step, 200);
  EXPECT_FALSE(std::filesystem::exists(path("again.h5")));
}

TEST_F(PlayerTest, a_record_is_scaled_replayed_and_continued_when_its_file_is_gone) {
  std::string text = k_rocking;
  const std::size_t begin = text.find("frequency"), end = text.find("[contact]");
  text.replace(begin, end - begin, "type = \"record\"\nfiles = [\"" + path("quake.csv") + "\"]\n");
  {
    std::ofstream file(path("quake.csv"));
    file << "time_s,ax_gal,ay_gal\n";
    for (int i = 0; i <= 100; ++i)
      file << i << "e-2," << 300 * std::sin(12.6 * i / 100) << "," << 50 * std::sin(20. * i / 100) << "\n";
  }
  start(text);
  const Edit edit{Edit::Key::scale, 0, Vec3(1.5, 0, 0)};
  run_to(0.2);
  player().edit(edit);
  run_to(0.6);
  run_->close("stopped");
  const std::vector<RowPtr> before = player().way();
  player_.reset();
  run_.reset();
  std::filesystem::remove(path("quake.csv"));

  replay("live.h5", "again.h5");
  player().scrub(0.4);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().can_edit(); }));
  EXPECT_EQ(player().parameters().shakes[0].scale, 1.5);
  run_to(0.5);
  for (const RowPtr& row : before)
    if (row->step == 450) expect_same_motion(*row_at_step(450), *row);
  run_->close("stopped");
  expect_repeatable("again.h5", 2);
}

}  // namespace
}  // namespace topple::app
