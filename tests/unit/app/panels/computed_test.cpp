// Settings that are shown are those that are computed.
#include "app/panels/computed.h"

#include <gtest/gtest.h>

#include "app/panels/edit_marks.h"
#include "app/panels/panels.h"
#include "app/picture/window_words.h"
#include "solver/io/edit/edit_text.h"
#include "solver/model/excitation.h"
#include "unit/app/live.h"

namespace topple::app {
namespace {

class ComputedTest : public ::testing::Test {
 protected:
  void start(const std::vector<std::string>& changes) {
    const auto scene = live_scene(k_rocking, changes);
    run_.emplace(LiveSource{.scene = scene, .recording = {}, .output = {}});
    player_.emplace(scene, *run_);
    ASSERT_TRUE(until([&] { return player_->can_edit(); }));
  }
  template <typename Done>
  ::testing::AssertionResult until(Done done) {
    return eventually([this] { player_->update(1. / 60); }, done);
  }
  void run_to_end() {
    player_->set_speed(k_most_speed);
    player_->play();
    ASSERT_TRUE(until([&] { return player_->status().kind == LiveStatus::Kind::over; }));
  }
  std::optional<LiveRun> run_;
  std::optional<Player> player_;
};

TEST_F(ComputedTest, the_model_its_reason_and_what_moves_it_are_said) {
  start({"cabinet.free.model=auto", "run.want=[\"motion\",\"stress\"]", "run.duration=0.2"});
  EXPECT_EQ(computed_in_words(*player_, 0), "now elastic (stresses are wanted): central differences");
  run_to_end();
  EXPECT_EQ(computed_in_words(*player_, 0), "now elastic (stresses are wanted): central differences");
  EXPECT_EQ(integrators_in_words(*player_), "of frames; at work now: central differences");
  start({"cabinet.free.model=frame", "run.duration=0.1"});
  run_to_end();
  EXPECT_EQ(computed_in_words(*player_, 0), "now frame (asked for): generalized-alpha");
  EXPECT_EQ(integrators_in_words(*player_), "");
  start({"cabinet.free.model=auto", "run.accuracy=1e-6", "run.time_step=auto", "run.duration=0.1"});
  run_to_end();
  EXPECT_EQ(integrators_in_words(*player_),
            "of frames; at work now: generalized-alpha or, where cheaper, central differences");
}

// Steps and time between frames are the run's own.
TEST_F(ComputedTest, the_step_shown_is_the_one_taken) {
  start({"run.time_step=0.0005", "run.duration=0.2"});
  run_to_end();
  EXPECT_NEAR(step_taken(*player_).value(), 5e-4, 1e-9);
  start({"run.time_step=auto", "run.duration=0.2"});
  ASSERT_TRUE(player_->parameters().adaptive);
  run_to_end();
  const double step = step_taken(*player_).value();
  EXPECT_GT(step, 0);
  EXPECT_NE(step, player_->parameters().time_step);
}

TEST(ComputedWords, every_choice_has_a_word_in_japanese) {
  for (const Edit::Key key : {Edit::Key::type, Edit::Key::law, Edit::Key::model, Edit::Key::integrator})
    for (const std::string_view word : io::key_of(key).choices) {
      const Phrase phrase = window_words::phrase_of_choice(word);
      EXPECT_NE(phrase.japanese, phrase.english) << word;
    }
}

// Rows stand at 72 and 108 degrees of each of its turns; of a shake that is half as strong none comes near.
TEST(FloorPeak, a_peak_between_rows_is_the_one_that_the_scene_names) {
  const double rate = 100, amplitude = 7;
  Shake shake;
  shake.frequency = 10;
  shake.amplitude = amplitude;
  shake.direction = Vec3(0, 1, 0);
  std::vector<RowPtr> rows;
  for (int i = 0; i < 100; ++i) {
    auto row = std::make_shared<io::FrameRow>();
    row->floor_acceleration[1] = shake_acceleration(shake, i / rate).y();
    rows.push_back(std::move(row));
  }
  double seen = 0;
  for (const RowPtr& row : rows) seen = std::max(seen, std::abs(row->floor_acceleration[1]));
  ASSERT_LT(seen, 0.96 * amplitude);
  EXPECT_EQ(floor_peak(rows, {shake}, rate), amplitude);
  shake.amplitude *= 2;
  EXPECT_EQ(floor_peak(rows, {shake}, rate), seen);
  EXPECT_EQ(floor_peak(rows, {}, rate), seen);
}

TEST(EditMarks, one_drag_is_one_mark) {
  const auto edit = [](double time, Edit::Key key, double value) {
    return LoggedEdit{0, static_cast<std::int64_t>(1000 * time), time, {key, 0, Vec3(value, 0, 0)}};
  };
  using enum Edit::Key;
  const std::vector<LoggedEdit> edits{edit(0.5, amplitude, 1),  edit(0.52, amplitude, 2),
                                      edit(0.54, amplitude, 3), edit(0.56, friction, 0.4),
                                      edit(0.58, amplitude, 4), edit(1.5, amplitude, 5)};
  const auto never = [](const LoggedEdit&) { return false; };
  const std::vector<EditMark> marks = edit_marks(edits, never);
  ASSERT_EQ(marks.size(), 4u);
  EXPECT_EQ(marks[0].first.time, 0.5);
  EXPECT_EQ(marks[0].last.edit.value.x(), 3);
  EXPECT_EQ(marks[1].last.edit.key, friction);
  EXPECT_EQ(marks[2].last.edit.value.x(), 4);
  EXPECT_EQ(marks[3].first.time, 1.5);  // another drag, a second later
  std::vector<LoggedEdit> branched{edit(0.5, amplitude, 1), edit(0.6, amplitude, 2)};
  branched[1].branch = 1;
  EXPECT_EQ(edit_marks(branched, never).size(), 2u);  // what was done before one went on from there stays
  const std::vector<EditMark> pulls =
      edit_marks({edit(1, pull, 5), edit(3, pull, 6), edit(3.1, pull, 0), edit(4, pull, 5)}, never);
  ASSERT_EQ(pulls.size(), 2u);  // a hand that keeps still pulls on
  EXPECT_EQ(pulls[0].last.time, 3.1);
}

TEST(EditMarks, what_yields_is_drawn_apart_from_all_others) {
  using enum GivesWay;
  const std::vector<PlacedMark> marks{{0, to_all},  {4, to_all},  {11, to_all}, {30, to_none}, {31, to_none},
                                      {25, to_all}, {45, to_all}, {52, to_all}, {30, to_all}};
  EXPECT_EQ(drawn_marks(marks, 4, 10),
            (std::vector<bool>{true, false, true, true, true, false, true, false, false}));
}

TEST(EditMarks, a_break_is_seen_among_marks_that_lie_on_it) {
  using enum GivesWay;
  const std::vector<PlacedMark> marks{{28, to_breaks}, {32, to_none}, {30, to_none, true}, {35, to_breaks},
                                      {36, to_breaks}, {39, to_all},  {30, to_breaks}};
  EXPECT_EQ(drawn_marks(marks, 4, 10), (std::vector<bool>{false, true, true, true, true, false, false}));
}

TEST_F(ComputedTest, a_slider_that_is_held_still_in_a_drag_has_one_mark) {
  start({"run.duration=3", "cabinet.free.model=rigid"});
  const auto edit_at = [&](double time, double gal) {
    player_->play();
    ASSERT_TRUE(until([&] { return player_->time() >= time; }));
    player_->pause();
    player_->edit({Edit::Key::amplitude, 0, Vec3(gal * k_gal, 0, 0)});
  };
  const auto marks = [&] {
    return edit_marks(player_->edits(), [&](const LoggedEdit& edit) { return player_->goes_on(edit); });
  };
  player_->set_speed(k_most_speed);
  player_->begin_edit();
  edit_at(0.2, 100);
  edit_at(1, 120);
  ASSERT_TRUE(until([&] { return player_->edits().size() == 2; }));
  ASSERT_EQ(marks().size(), 1u);
  EXPECT_EQ(marks()[0].last.edit.value.x(), 120 * k_gal);
  player_->begin_edit();
  edit_at(2, 90);
  ASSERT_TRUE(until([&] { return player_->edits().size() == 3; }));
  EXPECT_EQ(marks().size(), 2u);
}

}  // namespace
}  // namespace topple::app
