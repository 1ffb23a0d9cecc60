// A player of a live run or a recording, driven as the window drives it.
#pragma once

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "app/live/player.h"
#include "solver/io/recording/rerun.h"
#include "unit/app/live.h"
#include "unit/render/scratch.h"

namespace topple::app {

class PlayerTest : public ::testing::Test {
 protected:
  void start(const std::string& text = k_rocking, LiveRun::Advance advance = &topple::Run::advance) {
    start({.scene = live_scene(text), .recording = {}, .output = path("live.h5")}, std::move(advance));
  }
  void start(LiveSource source, LiveRun::Advance advance = &topple::Run::advance,
             std::size_t most_bytes = k_most_row_bytes) {
    const auto scene = source.scene;
    run_.emplace(
        std::move(source), [] {}, slowed(std::move(advance)));
    player_.emplace(scene, *run_, most_bytes);
    ASSERT_TRUE(until([this] { return player().can_edit() || player().can_continue(); }));
  }
  template <typename Done>
  ::testing::AssertionResult until(Done done) {
    return eventually([this] { player_->update(0.01); }, done);
  }
  /// Runs the live branch to `time`, and stops there or soon after.
  void run_to(double time) {
    slow_from_ = time;
    while (player().speed() < k_most_speed) player().faster();
    player().play();
    ASSERT_TRUE(until([&] { return player().time() >= time; }));
    player().pause();
    ASSERT_TRUE(until([&] { return player().status().kind != LiveStatus::Kind::going; }));
    slow_from_ = k_never;
  }
  void run_to_end() {
    while (player().speed() < k_most_speed) player().faster();
    player().play();
    ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::over; }));
  }
  /// Replays a recording; what goes on from it is recorded as `output`.
  void replay(const char* name, const char* output) {
    io::Recording recording(path(name));
    const auto scene = std::make_shared<const io::Scene>(io::recorded_scene(recording));
    start({.scene = scene, .recording = std::move(recording), .output = path(output)});
  }
  Player& player() { return *player_; }
  static Edit amplitude(double gal) { return {Edit::Key::amplitude, 0, Vec3(gal * k_gal, 0, 0)}; }
  std::string path(const char* name) const { return (scratch_ / name).string(); }

  /// Row of the branch shown at a step; the last one when there is none.
  RowPtr row_at_step(std::int64_t step) {
    for (const RowPtr& row : player().way())
      if (row->step == step) return row;
    return player().way().back();
  }
  void expect_same_motion(const io::FrameRow& a, const io::FrameRow& b) {
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.rotation, b.rotation);
    EXPECT_EQ(a.body, b.body);
  }
  void expect_repeatable(const char* name, int branches) {
    const io::Recording recording(path(name));
    EXPECT_EQ(recording.history().branches.size(), static_cast<std::size_t>(branches));
    const io::Rerun rerun = io::rerun(recording, [](std::int64_t) {});
    EXPECT_TRUE(rerun.damage.empty() && rerun.differences.empty());
    EXPECT_GT(rerun.checkpoints, branches);
  }

  // Where run_to stops, steps take long, so that a machine that is late to pause them does not run on far.
  LiveRun::Advance slowed(LiveRun::Advance advance) {
    return [this, advance = std::move(advance)](topple::Run& run) {
      if (run.time() >= slow_from_) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      return advance(run);
    };
  }
  static constexpr double k_never = std::numeric_limits<double>::infinity();
  std::atomic<double> slow_from_ = k_never;  // s

  const render::Scratch scratch_;
  std::optional<LiveRun> run_;
  std::optional<Player> player_;
};

}  // namespace topple::app
