#include "solver/run/history.h"

#include <gtest/gtest.h>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

std::vector<double> values(const std::vector<LoggedEdit>& edits) {
  std::vector<double> out;
  for (const LoggedEdit& e : edits) out.push_back(e.edit.value.x());
  return out;
}

/// 0 forks at 100 into 1, which forks at 300 into 2 and at 200 into 3; 4 leaves 2 where that begins.
History forked() {
  return {.branches = {{0, -1, 0}, {1, 0, 100}, {2, 1, 300}, {3, 1, 200}, {4, 2, 300}}};
}

TEST(History, way_to_a_branch_leads_from_the_root_through_every_fork) {
  const auto way = [](std::int32_t branch) {
    std::vector<std::pair<std::int32_t, std::int64_t>> out;
    for (const Stretch& s : forked().way_to(branch)) out.emplace_back(s.branch, s.last_step);
    return out;
  };
  constexpr std::int64_t end = std::numeric_limits<std::int64_t>::max();
  using Way = std::vector<std::pair<std::int32_t, std::int64_t>>;
  EXPECT_EQ(way(0), (Way{{0, end}}));
  EXPECT_EQ(way(2), (Way{{0, 100}, {1, 300}, {2, end}}));
  EXPECT_EQ(way(3), (Way{{0, 100}, {1, 200}, {3, end}}));
  EXPECT_EQ(way(4), (Way{{0, 100}, {1, 300}, {2, 300}, {4, end}}));
}

TEST(History, a_fork_before_its_parent_begins_cuts_the_grandparent_too) {
  const History history{.branches = {{0, -1, 0}, {1, 0, 100}, {2, 1, 40}}};
  const std::vector<Stretch> way = history.way_to(2);
  EXPECT_EQ(way[0].last_step, 40);
  EXPECT_EQ(way[1].last_step, 40);
}

TEST(History, edits_on_the_way_are_those_up_to_and_at_each_fork) {
  History history = forked();
  const auto add = [&history](std::int32_t branch, std::int64_t step, double value) {
    history.edits.push_back({branch, step, 1e-3 * static_cast<double>(step), set(Edit::Key::alpha, value)});
  };
  add(0, 0, 1);
  add(0, 100, 2);
  add(0, 101, 3);
  add(1, 100, 4);
  add(1, 200, 5);
  add(1, 300, 6);
  add(1, 301, 7);
  add(2, 300, 8);
  add(2, 400, 9);
  add(3, 250, 10);
  add(4, 300, 11);
  using Values = std::vector<double>;
  EXPECT_EQ(values(history.edits_on_way_to(0)), (Values{1, 2, 3}));
  EXPECT_EQ(values(history.edits_on_way_to(1)), (Values{1, 2, 4, 5, 6, 7}));
  EXPECT_EQ(values(history.edits_on_way_to(2)), (Values{1, 2, 4, 5, 6, 8, 9}));
  EXPECT_EQ(values(history.edits_on_way_to(3)), (Values{1, 2, 4, 5, 10}));
  EXPECT_EQ(values(history.edits_on_way_to(4)), (Values{1, 2, 4, 5, 6, 8, 11}));
  const topple::Setup setup = shaken(1);
  const auto alpha = [&](std::int32_t branch, std::int64_t step) {
    return parameters_at(setup, history, branch, step).contact.alpha;
  };
  EXPECT_EQ(alpha(4, 0), 1);
  EXPECT_EQ(alpha(4, 99), 1);
  EXPECT_EQ(alpha(4, 250), 5);
  EXPECT_EQ(alpha(4, 300), 11);
  EXPECT_EQ(alpha(3, 1000), 10);
}

TEST(History, a_run_stays_changed_when_a_parameter_is_as_it_was_again) {
  const topple::Setup setup = shaken(1);
  const double own = setup.parameters.contact.alpha;
  History history{.branches = {{0, -1, 0}}};
  const auto add = [&](std::int64_t step, double value) {
    history.edits.push_back({0, step, 1e-3 * static_cast<double>(step), set(Edit::Key::alpha, value)});
  };
  add(5, 2 * own), add(5, own);  // no step was taken between them
  add(10, 3 * own), add(20, own);
  for (const auto& [step, changed] : {std::pair(0, false), {6, false}, {10, false}, {11, true}, {50, true}})
    EXPECT_EQ(changed_before(setup, history, 0, step), changed) << step;
}

TEST(History, branches_without_a_way_from_the_root_are_refused) {
  EXPECT_THROW(History{}.way_to(0), std::invalid_argument);
  EXPECT_THROW(forked().way_to(5), std::invalid_argument);
  const History orphan{.branches = {{0, -1, 0}, {2, 1, 5}}};
  EXPECT_THROW(orphan.way_to(2), std::invalid_argument);
  const History circle{.branches = {{0, -1, 0}, {1, 2, 5}, {2, 1, 5}}};
  EXPECT_THROW(circle.edits_on_way_to(1), std::invalid_argument);
}

/// A tilted cabinet, shaken and edited every way while it rocks.
class EditedRunTest : public ::testing::Test {
 protected:
  void SetUp() override {
    setup_ = shaken(1, 0.05);
    shake(setup_, 2, 2);
    topple::Run run(setup_);
    keep(run, 0);
    const std::pair<std::int64_t, Edit> edits[] = {
        {0, set(Edit::Key::friction, 0.4)},       {60, set(Edit::Key::alpha, 120 * k_g)},
        {60, set(Edit::Key::amplitude, 4)},       {110, turn_to({1, 0.5, 0})},
        {150, set(Edit::Key::frequency, 5)},      {210, set(Edit::Key::q, 1.4)},
        {260, set(Edit::Key::time_step, 0.5e-3)}, {300, set(Edit::Key::restitution, 0.2)}};
    const auto* next = std::begin(edits);
    for (std::int64_t step = 0; step <= k_steps; ++step) {
      for (; next != std::end(edits) && next->first == step; ++next) {
        history_.edits.push_back({0, step, run.state().time, next->second});
        run.edit(next->second);
      }
      points_.push_back(run.point());
      ASSERT_TRUE(run.advance().ok());
      keep(run, step + 1);
    }
  }
  void keep(const topple::Run& run, std::int64_t step) {
    ASSERT_EQ(run.state().step, step);
    hashes_.push_back(hash(run.state()));
  }
  /// Repeats `branch` from where `run` stands, step by step.
  void expect_same(topple::Run run, std::int32_t branch = 0) const {
    const std::int64_t first = run.state().step;
    for (std::int64_t step = first; step <= k_steps; ++step) {
      ASSERT_TRUE(repeat(run, history_, branch, step));
      ASSERT_EQ(run.state().step, step);
      ASSERT_EQ(hash(run.state()), hashes_[static_cast<std::size_t>(step)])
          << "step " << step << ", from " << first;
    }
  }
  const RunPoint& point(std::int64_t step) const { return points_[static_cast<std::size_t>(step)]; }
  topple::Run from_checkpoint(std::int64_t step, std::int32_t branch = 0) const {
    return {setup_, unpack(setup_.model, pack(point(step).state)),
            parameters_at(setup_, history_, branch, step)};
  }

  static constexpr std::int64_t k_steps = 360;
  topple::Setup setup_;
  History history_{.branches = {{0, -1, 0}}};
  std::vector<std::uint64_t> hashes_;
  std::vector<RunPoint> points_;
};

TEST_F(EditedRunTest, repeats_bit_for_bit_from_start_points_and_checkpoints) {
  // at an edit, within its ramp, between, and after the last one
  for (const std::int64_t step : {0, 59, 60, 61, 75, 110, 151, 230, 260, 301, 350}) {
    expect_same(topple::Run(setup_, point(step)));
    expect_same(from_checkpoint(step));
  }
}

TEST_F(EditedRunTest, repeats_bit_for_bit_in_one_go) {
  topple::Run run = from_checkpoint(0);
  ASSERT_TRUE(repeat(run, history_, 0, k_steps));
  EXPECT_EQ(hash(run.state()), hashes_[k_steps]);
  EXPECT_EQ(run.outcome().bodies()[0].peak_tilt, point(k_steps).outcome.bodies()[0].peak_tilt);
}

TEST_F(EditedRunTest, a_fork_without_edits_of_its_own_goes_on_as_its_parent_did) {
  history_.branches.push_back({1, 0, 305});  // after the last edit
  expect_same(from_checkpoint(305, 1), 1);
  expect_same(from_checkpoint(40, 1), 1);
}

TEST_F(EditedRunTest, a_fork_leaves_out_what_its_parent_did_later) {
  history_.branches.push_back({1, 0, 250});
  topple::Run fork = from_checkpoint(200, 1);
  ASSERT_TRUE(repeat(fork, history_, 1, 260));
  EXPECT_EQ(hash(fork.state()), hashes_[260]);
  ASSERT_TRUE(repeat(fork, history_, 1, 261));
  EXPECT_NE(hash(fork.state()), hashes_[261]);
  EXPECT_EQ(fork.parameters().time_step, setup_.parameters.time_step);
}

TEST_F(EditedRunTest, what_is_repeated_differs_when_an_edit_is_missing) {
  history_.edits.erase(history_.edits.begin() + 3);
  topple::Run run = from_checkpoint(0);
  ASSERT_TRUE(repeat(run, history_, 0, 111));
  EXPECT_NE(hash(run.state()), hashes_[111]);
}

TEST_F(EditedRunTest, repeating_stops_at_a_step_that_fails) {
  history_.edits.push_back({0, 310, 0.285, set(Edit::Key::time_step, std::nan(""))});
  topple::Run run = from_checkpoint(300);
  EXPECT_FALSE(repeat(run, history_, 0, k_steps));
  EXPECT_EQ(run.state().step, 310);
}

}  // namespace
}  // namespace topple::test
