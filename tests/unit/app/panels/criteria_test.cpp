// What the window says of the criteria beside what the run does.
#include "app/panels/criteria.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "app/panels/map_panel.h"
#include "app/panels/teaching_words.h"
#include "solver/study/common/standing.h"
#include "unit/app/live.h"

namespace topple::app {
namespace {

class CriteriaTest : public ::testing::Test {
 protected:
  void start(const char* name, const std::vector<std::string>& changes) {
    start(std::make_shared<const io::Scene>(io::load_scene(name, changes)));
  }
  void start(const std::shared_ptr<const io::Scene>& scene) {
    run_.emplace(LiveSource{.scene = scene, .recording = {}, .output = {}});
    player_.emplace(scene, *run_);
    ASSERT_TRUE(until([&] { return player_->can_edit(); }));
    player_->set_speed(k_most_speed);
  }
  template <typename Done>
  ::testing::AssertionResult until(Done done) {
    return eventually([this] { player_->update(1. / 60); }, done);
  }
  CriteriaLimits limits() const { return *limits_of(*player_, 0); }

  std::optional<LiveRun> run_;
  std::optional<Player> player_;
};

// 50 kgf in three rows of contacts: the side farthest off has nothing to bear long before g b/h, 177.5 gal.
TEST_F(CriteriaTest, limits_are_those_of_the_contacts_of_the_scene) {
  start("paper-a", {});
  const CriteriaLimits soft = limits();
  EXPECT_NEAR(soft.rigid / k_gal, 177.5, 0.2);
  EXPECT_NEAR(soft.rigid, k_standard_gravity * soft.base / soft.height, 1e-9);
  const Model& model = player_->scene().setup.model;
  const Parameters& parameters = player_->parameters();
  const auto standing =
      study::standing_towards(model, parameters, 0, parameters.shakes.front().direction).value();
  EXPECT_NEAR(soft.west, standing.gravity * study::tipping_limit(standing, parameters.contact), 1e-9);
  EXPECT_NEAR(soft.west / k_gal, 94.9, 0.1);
  start("paper-a", {"contact.alpha=\"500 kgf\""});  // 5 % below
  EXPECT_NEAR(limits().west, standing.gravity * study::tipping_limit(standing, player_->parameters().contact),
              1e-9);
  start("paper-a", {"contact.alpha=\"50000 kgf\""});
  EXPECT_EQ(limits().west, limits().rigid);
}

TEST_F(CriteriaTest, a_body_without_limits_has_the_reason_that_is_true) {
  const auto why = [&](const std::vector<std::string>& changes) {
    const io::Scene scene = io::load_scene("cabinet", changes);
    const Parameters& parameters = scene.setup.parameters;
    EXPECT_FALSE(has_limits(scene.setup.model, parameters, 0));
    return why_no_limits(scene.setup.model, parameters, 0).english;
  };
  EXPECT_EQ(why({"shake.1.direction=[1, 1, 0]"}), window_words::k_shaken_askew.english);
  EXPECT_EQ(why({"contact.friction=0.1"}), window_words::k_slides_before.english);
}

// On these contacts a steady push of 94.9 gal tips the cabinet, and a sine of 100 gal soon, as they say; on
// rigid ones, for which West has 177.5 gal, it would stay. Turned down after the fall, the shake is one that
// lets a cabinet stand, beside one that lies.
TEST_F(CriteriaTest, a_cabinet_that_fell_is_never_said_to_stay_without_a_reason) {
  start("paper-a", {"shake.1.amplitude=\"100 gal\""});
  const ShakePlace shake{0.5, 100 * k_gal}, turned_down{0.5, 90 * k_gal};
  EXPECT_EQ(verdict(limits(), shake).english, window_words::k_may_overturn.english);
  EXPECT_EQ(verdict(limits(), turned_down).english, window_words::k_stays.english);
  // a pulse of one full sine gives the floor twice the velocity of a steady one
  EXPECT_DOUBLE_EQ((ShakePlace{1.25, 1.6, std::numbers::inv_pi}.velocity()),
                   2 * (ShakePlace{1.25, 1.6}.velocity()));
  EXPECT_EQ(difference_in_words(*player_, 0, limits(), turned_down), "");  // nothing has happened yet
  player_->play();
  ASSERT_TRUE(until([&] {
    return std::ranges::any_of(player_->events(), [this](const io::RecordedEvent& e) {
      return e.event.kind == Event::Kind::overturn && e.event.body == 0 && e.time <= player_->time();
    });
  }));
  player_->pause();
  EXPECT_EQ(difference_in_words(*player_, 0, limits(), shake), "");  // they agree
  ASSERT_TRUE(until([&] { return player_->can_edit(); }));
  player_->edit({Edit::Key::amplitude, 0, Vec3(turned_down.amplitude, 0, 0)});
  const std::int64_t step = player_->row()->step;
  player_->step(1);
  ASSERT_TRUE(until([&] { return player_->row()->step > step; }));
  const std::string words = difference_in_words(*player_, 0, limits(), turned_down);
  for (const char* part :
       {"free has overturned all the same", "soft contacts", "parameters were changed while it ran"})
    EXPECT_NE(words.find(part), std::string::npos) << words;
  EXPECT_EQ(words.find("touched"), std::string::npos) << words;  // the other one stands 3 m away
  player_->scrub(0);
  EXPECT_EQ(difference_in_words(*player_, 0, limits(), turned_down), "");
}

// What a run begins with is no change while it runs.
TEST_F(CriteriaTest, reasons_are_given_where_they_are_true) {
  constexpr int second = 1;  // on which the first one falls
  const std::string shake = "[[shake]]\nfrequency = 1\namplitude = \"1 gal\"\n";
  start(std::make_shared<const io::Scene>(
      io::parse_scene(io::load_scene("dominoes").text + shake, "dominoes", {"run.duration=2.5"})));
  const auto limits = limits_of(*player_, second);
  ASSERT_TRUE(limits);
  player_->edit({Edit::Key::friction, 0, Vec3(0.55, 0, 0)});
  player_->play();
  ASSERT_TRUE(until([&] { return player_->status().kind == LiveStatus::Kind::over; }));
  const std::string words = difference_in_words(*player_, second, *limits, {1, 1 * k_gal});
  EXPECT_NE(words.find("overturned all the same"), std::string::npos) << words;
  EXPECT_NE(words.find("another body touched it"), std::string::npos) << words;
  EXPECT_EQ(words.find("changed"), std::string::npos) << words;
}

// At 1 Hz the push turns round before the cabinet has swayed far enough, though 94.9 gal that last lift it.
TEST_F(CriteriaTest, a_body_that_soft_contacts_have_not_let_lift_is_said_to_stand) {
  start("paper-a", {"shake.1.frequency=1", "shake.1.amplitude=\"120 gal\"", "run.duration=3"});
  const ShakePlace shake{1, 120 * k_gal};
  EXPECT_NE(verdict(limits(), shake).english, window_words::k_stays.english);
  player_->play();
  ASSERT_TRUE(until([&] { return player_->status().kind == LiveStatus::Kind::over; }));
  player_->scrub(1.9);
  EXPECT_EQ(difference_in_words(*player_, 0, limits(), shake), "");  // it may still
  player_->scrub(2.9);
  EXPECT_NE(difference_in_words(*player_, 0, limits(), shake).find("free has not lifted so far"),
            std::string::npos);
}

TEST_F(CriteriaTest, of_a_body_that_an_anchor_holds_it_is_said_that_they_do_not_hold) {
  start("anchored", {});
  ASSERT_TRUE(limits_of(*player_, 0));
  const int body = player_->scene().setup.model.anchors.front().body;
  EXPECT_NE(held_in_words(*player_, body).find("free is held by left, right:"), std::string::npos);
  start("anchored", {"anchor.1.on=false", "anchor.2.on=false"});
  EXPECT_EQ(held_in_words(*player_, body), "");
}

TEST(MapWords, the_nearest_cell_is_not_called_the_present_shake) {
  const auto scene = std::make_shared<const io::Scene>(io::load_scene("paper-a"));
  OverturnFound found{"", std::make_shared<const study::OverturnPlan>(study::plan_overturn(*scene, "", ""))};
  const study::Axis &x = found.plan->x, &y = found.plan->y;
  found.map.points.resize(static_cast<std::size_t>(found.plan->points()));
  Parameters now = scene->setup.parameters;
  now.shakes[0].frequency = x.in_si(5) * 1.01;
  now.shakes[0].amplitude = y.in_si(7);
  const std::string near = present_in_words(found, now);
  EXPECT_TRUE(near.starts_with("The nearest cell: " + fmt::format("{:.3g} Hz", x.values[5]))) << near;
  EXPECT_NE(near.find(fmt::format("The shake is at {:.3g} Hz", 1.01 * x.values[5])), std::string::npos)
      << near;
  now.shakes[0].frequency = x.in_si(5);
  EXPECT_TRUE(present_in_words(found, now).starts_with("The cell of the shake as it is now: "));
}

TEST(MapWords, a_cell_in_which_some_overturn_names_them) {
  const auto scene = std::make_shared<const io::Scene>(io::load_scene("paper-a"));
  OverturnFound found{"", std::make_shared<const study::OverturnPlan>(study::plan_overturn(*scene, "", ""))};
  const study::Axis &x = found.plan->x, &y = found.plan->y;
  found.map.bodies = {"free", "walled"};
  found.map.points.resize(static_cast<std::size_t>(found.plan->points()));
  study::OverturnPoint& cell = found.map.points[static_cast<std::size_t>(7 * x.count() + 5)];
  cell.verdict = study::Verdict::some;
  cell.runs = cell.overturned = 1;
  cell.fell = {0, 1};
  Parameters now = scene->setup.parameters;
  now.shakes[0].frequency = x.in_si(5);
  now.shakes[0].amplitude = y.in_si(7);
  EXPECT_TRUE(present_in_words(found, now).ends_with(": some overturn: walled."))
      << present_in_words(found, now);
}

TEST(MapWords, why_there_are_no_lines_is_said_in_both_languages) {
  using Sets = std::vector<std::string>;
  for (const auto& [name, sets] : {std::pair("paper-a", Sets{"contact.friction=0.1"}),
                                   {"paper-a", Sets{"shake.1.direction=[1, 0, 1]"}},
                                   {"paper-a", Sets{"run.settle=false"}},
                                   {"sixth-floor", Sets{}}}) {
    const io::Scene scene = io::load_scene(name, sets);
    const study::OverturnPlan plan = study::plan_overturn(scene, "", "");
    const std::string why = study::criteria(scene.setup, plan.x, plan.y).why_not;
    ASSERT_NE(why, "");
    EXPECT_EQ(no_lines_in_words(Language::english, why), why);
    EXPECT_NE(no_lines_in_words(Language::japanese, why), why);
  }
}

}  // namespace
}  // namespace topple::app
