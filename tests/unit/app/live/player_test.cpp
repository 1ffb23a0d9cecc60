#include "app/live/player.h"

#include <atomic>
#include <cmath>
#include <filesystem>

#include "unit/app/live/player_fixture.h"

namespace topple::app {
namespace {

TEST_F(PlayerTest, plays_to_the_end_and_closes_a_recording_that_can_be_run_again) {
  start();
  EXPECT_FALSE(player().playing());
  EXPECT_EQ(player().time(), 0);
  run_to_end();
  EXPECT_FALSE(player().playing());
  EXPECT_NEAR(player().time(), 1, 1e-9);
  EXPECT_EQ(player().way().size(), 101u);
  run_->close("stopped");
  const io::Recording recording(path("live.h5"));
  EXPECT_EQ(recording.status(), "completed");
  EXPECT_FALSE(recording.summary_json().empty());
  expect_repeatable("live.h5", 1);
}

TEST_F(PlayerTest, a_run_closed_early_says_so_and_holds_everything_up_to_there) {
  start();
  run_to(0.3);
  const io::FrameRow last = *player().row();
  run_->close("stopped");
  const io::Recording recording(path("live.h5"));
  EXPECT_EQ(recording.status(), "stopped");
  expect_same_motion(recording.frame(recording.frame_count() - 1), last);
}

TEST_F(PlayerTest, pauses_steps_and_goes_on) {
  start();
  player().step(1);
  ASSERT_TRUE(until([&] { return player().row()->step == 1; }));
  player().step(1);
  ASSERT_TRUE(until([&] { return player().row()->step == 2; }));
  player().step(-1);
  EXPECT_EQ(player().row()->step, 0);
  EXPECT_FALSE(player().at_head());
  player().step(1);
  EXPECT_TRUE(player().at_head());
  EXPECT_EQ(player().row()->step, 2);
  run_to(0.2);
  const std::int64_t step = player().row()->step;
  for (int i = 0; i < 20; ++i) player().update(0.01);
  EXPECT_EQ(player().row()->step, step);
}

TEST_F(PlayerTest, runs_at_the_speed_asked_for) {
  start();
  player().slower();  // half
  const auto begin = std::chrono::steady_clock::now();
  player().play();
  ASSERT_TRUE(until([&] { return player().time() >= 0.1; }));
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_GE(wall, 0.19);  // never faster than asked: 0.1 s at half the speed, less a report of 8 ms
}

TEST_F(PlayerTest, any_instant_of_the_past_is_shown_as_it_was) {
  start();
  run_to(0.5);
  const RowPtr past = row_at_step(200);
  ASSERT_EQ(past->step, 200);
  player().scrub(past->time);
  EXPECT_FALSE(player().at_head());
  expect_same_motion(*player().row(), *past);
  player().to_start();
  EXPECT_EQ(player().row()->step, 0);
  player().to_end();
  EXPECT_TRUE(player().at_head());
  EXPECT_GE(player().time(), 0.5);
}

TEST_F(PlayerTest, what_was_recorded_is_played_up_to_the_newest_instant_and_the_run_goes_on) {
  start();
  run_to(0.3);
  player().scrub(0.1);
  player().play();
  EXPECT_FALSE(player().at_head());
  player().update(0.01);
  EXPECT_NEAR(player().time(), 0.1 + 0.01 * player().speed(), 1e-12);
  ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::over; }));
  EXPECT_NEAR(player().time(), 1, 1e-9);
}

TEST_F(PlayerTest, continuing_without_a_change_repeats_the_future_bit_for_bit) {
  start();
  run_to_end();
  const std::vector<RowPtr> before = player().way();
  player().scrub(0.4);
  ASSERT_TRUE(player().can_continue());
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && player().at_head(); }));
  EXPECT_EQ(player().history().branches[1].parent, 0);
  EXPECT_EQ(player().history().branches[1].fork_step, 400);
  EXPECT_NEAR(player().time(), 0.4, 1e-9);
  run_to_end();
  ASSERT_EQ(player().way().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) expect_same_motion(*player().way()[i], *before[i]);
  EXPECT_TRUE(player().ghost().has_value());
  run_->close("stopped");
  expect_repeatable("live.h5", 2);
}

TEST_F(PlayerTest, an_edit_changes_the_future_and_is_recorded_with_its_step) {
  start();
  run_to(0.2);
  const std::int64_t step = player().row()->step;
  ASSERT_TRUE(player().can_edit());
  player().edit(amplitude(600));
  EXPECT_NEAR(player().parameters().shakes[0].amplitude, 600 * k_gal, 1e-12);
  player().update(0);
  EXPECT_NEAR(player().parameters_so_far().shakes[0].amplitude, 300 * k_gal, 1e-12);
  run_to_end();
  EXPECT_NEAR(player().parameters_so_far().shakes[0].amplitude, 600 * k_gal, 1e-12);
  ASSERT_EQ(player().edits().size(), 1u);
  EXPECT_EQ(player().edits()[0].step, step);
  EXPECT_EQ(player().edits()[0].branch, 0);
  player().scrub(0.1);
  EXPECT_FALSE(player().can_edit());
  EXPECT_NEAR(player().parameters().shakes[0].amplitude, 300 * k_gal, 1e-12);
  player().scrub(0.9);
  EXPECT_NEAR(player().parameters().shakes[0].amplitude, 600 * k_gal, 1e-12);
  run_->close("stopped");
  EXPECT_EQ(io::Recording(path("live.h5")).history().edits.size(), 1u);
  expect_repeatable("live.h5", 1);
}

TEST_F(PlayerTest, undo_posts_the_inverse_and_redo_the_edit_again) {
  start();
  run_to(0.1);
  player().begin_edit();
  player().edit(amplitude(400));
  player().edit(amplitude(500));  // the same drag of a slider
  player().begin_edit();
  player().edit({Edit::Key::friction, 0, Vec3(0.3, 0, 0)});
  const auto value = [&](Edit::Key key) { return edited_value(player().parameters(), key, 0).x(); };
  EXPECT_EQ(value(Edit::Key::friction), 0.3);
  player().undo();
  EXPECT_EQ(value(Edit::Key::friction), 0.6);
  EXPECT_NEAR(value(Edit::Key::amplitude), 500 * k_gal, 1e-12);
  player().undo();
  EXPECT_NEAR(value(Edit::Key::amplitude), 300 * k_gal, 1e-12);
  EXPECT_FALSE(player().can_undo());
  player().redo();
  EXPECT_NEAR(value(Edit::Key::amplitude), 500 * k_gal, 1e-12);
  player().redo();
  EXPECT_EQ(value(Edit::Key::friction), 0.3);
  EXPECT_FALSE(player().can_redo());
  run_to(0.2);
  ASSERT_TRUE(until([&] { return player().edits().size() >= 7; }));
  EXPECT_EQ(player().edits().size(), 7u);  // 3 edits, 2 inverse ones, 2 again: all of them happened
  EXPECT_EQ(value(Edit::Key::friction), 0.3);
  run_->close("stopped");
  expect_repeatable("live.h5", 1);
}

TEST_F(PlayerTest,
       a_step_and_an_integrator_that_were_chosen_by_the_program_are_so_again_when_that_is_taken_back) {
  std::string scene = k_rocking;
  scene.replace(scene.find("[run]"), 5, "[run]\ntime_step = \"auto\"");
  start(scene);
  run_to(0.05);
  const Parameters before = player().parameters();
  ASSERT_TRUE(before.adaptive);
  const auto taken_back = [&](Edit::Key key, double value) {
    const Vec3 in_scene = edited_value(before, key, 0);
    player().begin_edit();
    player().edit({key, 0, Vec3(value, 0, 0)});
    EXPECT_NE(player().parameters(), before);
    player().undo();
    EXPECT_EQ(edited_value(player().parameters(), key, 0), in_scene);
  };
  taken_back(Edit::Key::time_step, 2e-3);
  EXPECT_TRUE(player().parameters().adaptive);
  taken_back(Edit::Key::integrator, static_cast<double>(Integrator::newmark));
  EXPECT_EQ(player().parameters().integrator, Integrator::generalized_alpha);
  run_to(0.1);
  run_->close("stopped");
  expect_repeatable("live.h5", 1);
}

TEST_F(PlayerTest, an_anchor_is_taken_away_and_put_back_and_the_run_repeats) {
  start(k_rocking + k_straps);
  run_to(0.2);
  player().edit({Edit::Key::anchor, 1, Vec3(0, 0, 0)});
  EXPECT_FALSE(player().parameters().anchors[1]);
  EXPECT_TRUE(
      until([&] { return player().row()->anchor[1].state == io::k_anchor_away; }));  // it stands still
  run_to(0.4);
  EXPECT_EQ(player().row()->anchor[1].state, io::k_anchor_away);
  player().undo();
  EXPECT_TRUE(player().parameters().anchors[1]);
  EXPECT_TRUE(until([&] { return player().row()->anchor[1].state == io::k_anchor_slack; }));  // nor now
  run_to(0.6);
  EXPECT_NE(player().row()->anchor[1].state, io::k_anchor_away);
  player().scrub(0.3);
  EXPECT_FALSE(player().parameters().anchors[1]);
  EXPECT_EQ(player().row()->anchor[1].state, io::k_anchor_away);
  run_->close("stopped");
  expect_repeatable("live.h5", 1);
}

TEST_F(PlayerTest, a_branch_from_before_an_edit_knows_nothing_of_it_and_its_ghost_is_the_future_left) {
  start();
  run_to(0.2);
  player().edit(amplitude(450));
  run_to(0.4);
  player().scrub(0.3);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().can_edit(); }));
  EXPECT_FALSE(player().can_undo());
  run_to(0.5);
  player().scrub(0.1);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().can_edit() && player().shown_branch() == 2; }));
  EXPECT_EQ(player().history().branches[2].parent, 0);
  ASSERT_FALSE(player().ghost_way().empty());
  EXPECT_EQ(player().ghost_way().back()->branch, 1);
  EXPECT_NEAR(player().parameters().shakes[0].amplitude, 300 * k_gal, 1e-12);
  EXPECT_FALSE(player().can_undo() || player().can_redo());
}

TEST_F(PlayerTest, edits_do_not_hurry_a_slow_run) {
  start();
  for (int i = 0; i < 6; ++i) player().slower();  // 1/64
  const auto begin = std::chrono::steady_clock::now();
  player().play();
  for (int i = 0; i < 300; ++i) {
    player().edit(amplitude(300 + i));
    player().update(0.001);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  player().pause();
  ASSERT_TRUE(until([&] { return player().status().kind != LiveStatus::Kind::going; }));
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_LE(player().time(), wall / 64 + 1e-3 + 1e-9);  // and the step under way
}

TEST_F(PlayerTest, with_the_loop_on_playing_begins_again_at_the_end) {
  start();
  player().set_loop(true);
  run_to_end();
  ASSERT_TRUE(until([&] { return player().playing() && !player().at_head() && player().time() < 0.5; }));
  ASSERT_TRUE(until([&] { return player().time() > 0.9; }));  // of what was recorded: nothing is stepped
  ASSERT_TRUE(until([&] { return player().time() < 0.5; }));
  EXPECT_EQ(player().history().branches.size(), 1u);
  player().set_loop(false);
  ASSERT_TRUE(until([&] { return !player().playing(); }));
  EXPECT_EQ(player().time(), player().end());
}

TEST_F(PlayerTest, a_failed_step_keeps_the_last_good_state_and_may_be_tried_again) {
  start(k_beam, [](topple::Run& run) {
    if (run.state().step >= 5 && run.parameters().time_step > 6e-4) {
      return StepStatus{
          .kind = StepStatus::Kind::newton_diverged, .time = run.state().time, .body = 0, .element = 1};
    }
    return run.advance();
  });
  player().play();
  ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::failed; }));
  EXPECT_FALSE(player().playing());
  EXPECT_EQ(player().row()->step, 5);
  EXPECT_NE(player().status().message.find("smaller time_step"), std::string::npos);
  player().begin_edit();
  EXPECT_THROW(player().edit({Edit::Key::time_step, 0, Vec3(1e-9, 0, 0)}), io::InputError);
  player().edit({Edit::Key::time_step, 0, Vec3(5e-4, 0, 0)});
  player().play();  // with the edit still on its way
  EXPECT_TRUE(player().playing());
  ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::over; }));
  EXPECT_TRUE(player().status().message.empty());
  run_->close("stopped");
  EXPECT_EQ(io::Recording(path("live.h5")).status(), "completed");
}

TEST_F(PlayerTest, rows_in_memory_are_bounded_and_old_instants_can_still_be_seen_and_branched_from) {
  start({.scene = live_scene(), .recording = {}, .output = path("live.h5")});
  const std::size_t most = 16 * memory_of(*player().way().front());
  start({.scene = live_scene(), .recording = {}, .output = path("bounded.h5")}, &topple::Run::advance, most);
  run_to_end();
  const std::vector<RowPtr>& way = player().way();
  EXPECT_LE(way.size() * memory_of(*way.front()), most);
  EXPECT_EQ(way.front()->step, 0);
  for (std::size_t i = 1; i < way.size(); ++i) EXPECT_LT(way[i - 1]->time, way[i]->time);
  EXPECT_GT(way[2]->step - way[1]->step, way.back()->step - way[way.size() - 2]->step);
  const RunExtent& extent = player().extent();
  ASSERT_EQ(extent.way.size(), way.size());
  for (std::size_t i = 0; i < way.size(); ++i) {
    EXPECT_EQ(extent.way[i], static_cast<float>(way[i]->time));
    EXPECT_EQ(extent.points(i, 0), body_points(player().scene().setup.model, *way[i], 0));
  }

  player().scrub(way[1]->time);
  const RowPtr there = way[1];
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().can_edit() && player().shown_branch() == 1; }));
  expect_same_motion(*player().row(), *there);

  run_->close("stopped");
  EXPECT_GT(io::Recording(path("bounded.h5")).frame_count(), 2 * 16);
}

TEST_F(PlayerTest, nobody_waits_for_a_step_that_takes_long) {
  Gate gate;
  start(k_rocking, gate.advance());
  run_to(0.1);
  gate.shut();
  player().play();
  ASSERT_TRUE(eventually([] {}, [&] { return gate.held(); }));
  const double time = player().time();
  // All of this happens while one step does.
  for (int i = 0; i < 100; ++i) player().update(0.01);
  EXPECT_LE(player().time() - time, 0.02);
  player().edit(amplitude(500));
  EXPECT_NEAR(player().parameters().shakes[0].amplitude, 500 * k_gal, 1e-12);
  player().scrub(0.05);
  EXPECT_TRUE(player().row().has_value());
  player().to_end();
  ASSERT_TRUE(gate.held());
  gate.open();
  ASSERT_TRUE(until([&] { return player().edits().size() == 1; }));
}

TEST_F(PlayerTest, closing_does_not_wait_for_a_step_that_takes_long) {
  Gate gate;
  start(k_rocking, gate.advance());
  run_to(0.1);
  gate.shut();
  player().play();
  ASSERT_TRUE(eventually([] {}, [&] { return gate.held(); }));
  const auto begin = std::chrono::steady_clock::now();
  run_->close("interrupted");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
  ASSERT_TRUE(gate.held());
  const io::Recording recording(path("live.h5"));
  EXPECT_EQ(recording.status(), "interrupted");
  EXPECT_GE(recording.frame_count(), 10);
  gate.open();
  ASSERT_TRUE(eventually([] {}, [&] { return !gate.held(); }));
}

TEST_F(PlayerTest, what_does_not_come_to_rest_is_explained) {
  const auto scene = live_scene(k_rocking, {"contact.alpha=\"0.001 kgf\""});
  LiveRun run({.scene = scene, .recording = {}, .output = path("never.h5")});
  Player player(scene, run);
  ASSERT_TRUE(eventually([&] { player.update(0.01); },
                         [&] { return player.status().kind == LiveStatus::Kind::failed; }));
  EXPECT_NE(player.status().message.find("does not come to rest"), std::string::npos);
  player.play();
  player.edit(amplitude(10));
  player.restart();
  player.scrub(1);
  ASSERT_TRUE(player.row().has_value());  // as the scene has it
  EXPECT_EQ(player.row()->step, 0);
  EXPECT_EQ(player.row()->body[0].tilt, 0);
  run.close("stopped");
  EXPECT_FALSE(std::filesystem::exists(path("never.h5")));
}

}  // namespace
}  // namespace topple::app
