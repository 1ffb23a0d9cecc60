// Guided demos without a window, and the estimate beside it.
#include "app/panels/demo.h"

#include <gtest/gtest.h>

#include "app/panels/accuracy.h"
#include "app/panels/teaching_words.h"
#include "app/picture/words.h"
#include "unit/app/live.h"

namespace topple::app {
namespace {

class DemoTest : public ::testing::TestWithParam<std::size_t> {
 protected:
  void start(std::shared_ptr<const io::Scene> scene) {
    run_.emplace(LiveSource{.scene = scene, .recording = {}, .output = {}});
    player_.emplace(scene, *run_);
    ASSERT_TRUE(until([&] { return player_->can_edit(); }));
    for (int i = 0; i < 3; ++i) player_->faster();
  }
  template <typename Done>
  ::testing::AssertionResult until(Done done) {
    return eventually(
        [this] {
          player_->update(1. / 60);
          if (guide_) guide_->update();
        },
        done);
  }
  /// Goes through the whole demo; the time of each step.
  std::vector<double> times() {
    std::vector<double> all;
    const std::size_t count = guide_->demo().steps.size();
    for (std::size_t step = 0; step < count; ++step) {
      EXPECT_TRUE(until([&] { return guide_->step() == step && !guide_->under_way(); })) << "step " << step;
      EXPECT_FALSE(player_->playing());
      EXPECT_EQ(&guide_->text(), &guide_->demo().steps[step].text) << "step " << step;
      all.push_back(player_->time());
      if (!guide_->last()) guide_->next();
    }
    return all;
  }
  std::optional<LiveRun> run_;
  std::optional<Player> player_;
  std::optional<DemoGuide> guide_;
};

TEST_P(DemoTest, every_step_is_reached_by_its_event_and_can_be_gone_back_to) {
  const auto scene =
      std::make_shared<const io::Scene>(io::load_scene("paper-a", {"run.duration=6", "title=\"Two\""}));
  start(scene);
  const Demo& demo = demos()[GetParam()];
  guide_.emplace(demo, *player_);
  const std::vector<double> at = times();
  ASSERT_EQ(at.size(), demo.steps.size());
  EXPECT_TRUE(guide_->last());
  EXPECT_EQ(at[0], 0);
  for (std::size_t i = 1; i < at.size(); ++i) EXPECT_GT(at[i], at[i - 1]);
  const Shake& shake = player_->parameters().shakes.front();
  EXPECT_EQ(shake.frequency, demo.frequency);
  EXPECT_NEAR(shake.amplitude / k_gal, demo.amplitude, 1e-9);
  const bool own = demo.frequency == 0.5 && demo.amplitude == 190;  // as the scene has it
  EXPECT_EQ(title_in_words(*scene, player_->parameters()) == scene->title, own);
  guide_->previous();
  EXPECT_EQ(guide_->step(), at.size() - 2);
  EXPECT_NEAR(player_->time(), at[at.size() - 2], 0.011);  // a recorded instant
  guide_->next();
  EXPECT_EQ(guide_->step(), at.size() - 1);
  EXPECT_NEAR(player_->time(), at.back(), 0.011);
}
TEST_F(DemoTest, what_is_to_be_seen_runs_at_a_quarter_of_the_speed) {
  start(std::make_shared<const io::Scene>(io::load_scene("paper-a", {"run.duration=6"})));
  const double before = player_->speed();
  guide_.emplace(demos()[0], *player_);
  ASSERT_TRUE(until([&] { return guide_->step() == 0U && !guide_->under_way(); }));
  guide_->next();
  EXPECT_EQ(player_->speed(), 0.25);
  guide_->leave();
  EXPECT_EQ(player_->speed(), before);
}
INSTANTIATE_TEST_SUITE_P(All, DemoTest, ::testing::Values(0, 1));

// The floor of a building was computed from its ground.
TEST_F(DemoTest, the_ground_of_a_building_is_not_shaken_otherwise) {
  start(std::make_shared<const io::Scene>(io::load_scene("paper-a", {"run.duration=0.1"})));
  EXPECT_TRUE(can_shake_as_sine(*player_));
  start(std::make_shared<const io::Scene>(io::load_scene(
      "paper-a",
      {"run.duration=0.1", "shake.1.building={storey = 2, of = 3, period = 0.5, damping = 0.05}"})));
  EXPECT_FALSE(can_shake_as_sine(*player_));
}

TEST_F(DemoTest, what_does_not_come_about_is_said) {
  start(live_scene(k_rocking, {"run.duration=0.1"}));
  guide_.emplace(demos()[0], *player_);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(until([&] { return !guide_->under_way(); }));
    guide_->next();
  }
  ASSERT_TRUE(until([&] { return !guide_->under_way(); }));
  EXPECT_EQ(&guide_->text(), &window_words::k_did_not_come);
}

TEST(AccuracyTest, errors_are_those_of_the_two_runs_it_stands_for) {
  const auto scene = live_scene(k_rocking, {"run.duration=0.3"});
  const topple::Setup fine = study::compared(scene->setup);
  topple::Run run(scene->setup), finer(fine);
  while (!run.over()) run.advance();
  while (!finer.over()) finer.advance();
  const auto expected = study::errors(scene->setup, run.outcome(), finer.outcome());
  const auto accuracy = estimate_accuracy(scene->setup);
  ASSERT_TRUE(eventually([] {}, [&] { return accuracy->over(); }));
  const AccuracyResult result = *accuracy->result();
  ASSERT_EQ(result.errors.size(), expected.size());
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.errors[0].peak_tilt_error, expected[0].peak_tilt_error);
  EXPECT_EQ(result.bodies[0].peak_tilt, run.outcome().bodies()[0].peak_tilt);
  EXPECT_GT(accuracy->progress(), 0.9);
  const auto words = accuracy_in_words(scene->setup.model, result);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_NE(words[0].find("does not overturn"), std::string::npos) << words[0];
}

// Overturns at 1.955 s with 100 kgf, at 1.005 s with 50 kgf.
TEST(AccuracyTest, a_run_that_begins_again_with_other_sliders_is_the_one_that_is_told_of) {
  const auto scene = std::make_shared<const io::Scene>(io::load_scene("paper-a"));
  LiveRun run({.scene = scene, .recording = {}, .output = {}});
  Player player(scene, run);
  const auto until = [&](auto done) { return eventually([&] { player.update(1. / 60); }, done); };
  ASSERT_TRUE(until([&] { return player.can_edit(); }));
  player.set_speed(k_most_speed);
  player.step(1);
  ASSERT_TRUE(until([&] { return player.row()->step == 1; }));
  player.edit({Edit::Key::alpha, 0, Vec3(100 * k_standard_gravity, 0, 0)});
  player.restart();
  ASSERT_TRUE(until([&] { return player.history().branches.size() == 2 && player.can_edit(); }));
  player.play();
  ASSERT_TRUE(until([&] { return player.status().kind == LiveStatus::Kind::over; }));
  const std::vector<io::RecordedEvent> events = player.events();
  const auto fell = std::ranges::find_if(events, [](const io::RecordedEvent& e) {
    return e.event.kind == Event::Kind::overturn && e.event.body == 0;
  });
  ASSERT_NE(fell, events.end());
  topple::Setup setup = scene->setup;
  for (const Edit& edit : player.edits_from(setup.parameters)) apply(edit, setup.model, 0, setup.parameters);
  const auto accuracy = estimate_accuracy(setup);
  ASSERT_TRUE(eventually([] {}, [&] { return accuracy->over(); }));
  EXPECT_EQ(accuracy->result()->bodies[0].beyond_since, fell->time);
}

TEST(AccuracyTest, it_is_given_up_at_once) {
  const auto scene = live_scene(k_rocking, {"run.duration=1000"});
  const auto before = std::chrono::steady_clock::now();
  estimate_accuracy(scene->setup).reset();
  EXPECT_LT(std::chrono::steady_clock::now() - before,
            std::chrono::seconds(20));  // the run would take minutes
}

}  // namespace
}  // namespace topple::app
