// The precision study: errors that are known, references that confirm each other, what is missing.
#include "solver/study/precision/precision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "solver/run/overturn.h"
#include "solver/study/precision/precision_chart.h"
#include "study_cases.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;

/// The cabinet of free-rocking; nothing of it is run.
const PrecisionPlan& rocking() {
  static const PrecisionPlan plan = plan_precision(io::load_scene("free-rocking", {"run.duration=4"}));
  return plan;
}

int case_of(const PrecisionPlan& plan, Method method, int from_finest) {
  std::vector<int> cases;
  for (int k = 0; k < plan.cases() && plan.law_of(k) == 0; ++k)
    if (plan.setting_of(k).method == method) cases.push_back(k);
  return cases[cases.size() - 1 - static_cast<std::size_t>(from_finest)];
}

double critical(const PrecisionPlan& plan) {
  const Body& body = plan.scene.setup.model.bodies[0];
  return critical_angle(plan.scene.setup.model, 0,
                        {body.centre_of_gravity, Quat(Eigen::AngleAxisd(1e-3, Vec3::UnitY()))},
                        {body.mass, body.centre_of_gravity});
}

/// A row of one body as run_case writes them.
struct MadeUp {
  int samples = 100;
  double shift = 0;      // rad, of the tilt
  int shifted_from = 0;  // sample
  double fell = 0.5, stress = 2e8, balance = 1e-4, cpu = 1;
  std::string row(const PrecisionPlan& plan) const {
    ordered_json tilt = ordered_json::array(), stresses = ordered_json::array(),
                 balances = ordered_json::array();
    for (int n = 0; n < samples; ++n) {
      const double at = 0.05 * std::sin(0.1 * n) + 0.06 + (n >= shifted_from ? shift : 0);
      tilt.push_back(std::llround(1e9 * at));
      stresses.push_back(stress * std::min(1., n / 50.));
      balances.push_back(balance);
    }
    return ordered_json{
        {"status", "completed"}, {"fell", {fell > 0 ? ordered_json(fell) : ordered_json(nullptr)}},
        {"tilt", {tilt}},        {"stress", {stresses}},
        {"balance", balances},   {"end_s", (samples - 1) * plan.interval},
        {"steps", 1000},         {"cpu_s", cpu * (samples - 1) * plan.interval}}
        .dump();
  }
};

double error_of(const PrecisionStudy& study, int k, Measure measure) {
  return study.rows[static_cast<std::size_t>(k)].errors[index(measure)].value();
}

TEST(Precision, the_reference_has_no_error_and_known_differences_are_found) {
  const PrecisionPlan& plan = rocking();
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  const int exact = case_of(plan, Method::central_difference, 0),
            check = case_of(plan, Method::generalized_alpha, 0), other = case_of(plan, Method::newmark, 2),
            late = case_of(plan, Method::newmark, 1);
  const double limit = critical(plan);
  rows[static_cast<std::size_t>(exact)] = MadeUp{}.row(plan);
  rows[static_cast<std::size_t>(check)] = MadeUp{.shift = 0.5e-4 * limit}.row(plan);
  rows[static_cast<std::size_t>(other)] =
      MadeUp{.shift = 0.01 * limit, .fell = 0.51, .stress = 2.1e8, .balance = 3e-4}.row(plan);
  rows[static_cast<std::size_t>(late)] = MadeUp{.fell = 0}.row(plan);
  const PrecisionStudy study = gather(plan, rows);
  EXPECT_EQ(study.run, 4);
  EXPECT_EQ(study.references[0].run, exact);
  EXPECT_EQ(study.references[0].check, check);
  EXPECT_NEAR(study.references[0].window, 99 * plan.interval, 1e-12);
  for (const Measure measure : {Measure::tilt, Measure::overturn_time, Measure::peak_stress})
    EXPECT_EQ(error_of(study, exact, measure), 0) << name(measure);
  // to the 1e-9 rad in which tilts are kept
  EXPECT_NEAR(study.references[0].uncertainty[index(Measure::tilt)].value(), 0.5e-4, 1e-8);
  EXPECT_NEAR(error_of(study, other, Measure::tilt), 0.01, 1e-8);
  EXPECT_NEAR(error_of(study, other, Measure::overturn_time), 0.02, 1e-12);
  EXPECT_NEAR(error_of(study, other, Measure::peak_stress), 0.05, 1e-12);
  EXPECT_EQ(error_of(study, other, Measure::energy), 3e-4);
  // what stands where the reference falls has no time of overturning
  EXPECT_FALSE(study.rows[static_cast<std::size_t>(late)].same_verdict);
  EXPECT_FALSE(study.rows[static_cast<std::size_t>(late)].errors[index(Measure::overturn_time)]);
}

TEST(Precision, the_window_ends_where_the_references_part) {
  const PrecisionPlan& plan = rocking();
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  const int exact = case_of(plan, Method::central_difference, 0),
            check = case_of(plan, Method::generalized_alpha, 0), other = case_of(plan, Method::newmark, 0);
  const double limit = critical(plan);
  const int parted = 40;
  rows[static_cast<std::size_t>(exact)] = MadeUp{.fell = 0}.row(plan);
  rows[static_cast<std::size_t>(check)] =
      MadeUp{.shift = 1.5 * k_parted * limit, .shifted_from = parted, .fell = 0}.row(plan);
  rows[static_cast<std::size_t>(other)] =
      MadeUp{.shift = 0.1 * limit, .shifted_from = parted, .fell = 0.7}.row(plan);
  const PrecisionStudy study = gather(plan, rows);
  EXPECT_NEAR(study.references[0].window, (parted - 1) * plan.interval, 1e-12);
  EXPECT_EQ(error_of(study, other, Measure::tilt), 0);
  EXPECT_TRUE(study.rows[static_cast<std::size_t>(other)].same_verdict);  // it falls after the window

  rows[static_cast<std::size_t>(check)] = MadeUp{.shift = 0.1, .fell = 0}.row(plan);
  const PrecisionStudy parted_at_once = gather(plan, rows);
  EXPECT_LT(parted_at_once.references[0].run, 0);
  EXPECT_FALSE(parted_at_once.rows[static_cast<std::size_t>(other)].errors[index(Measure::tilt)]);
  EXPECT_NE(precision_chart(plan, parted_at_once, "here", ChartFormat::svg).find("part at once"),
            std::string::npos);
}

TEST(Precision, the_default_is_placed_beside_the_front) {
  const PrecisionPlan& plan = rocking();
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  const int exact = case_of(plan, Method::central_difference, 0),
            check = case_of(plan, Method::generalized_alpha, 0), cheap = case_of(plan, Method::rigid, 0),
            fine = case_of(plan, Method::elastic, 0);
  const double limit = critical(plan);
  rows[static_cast<std::size_t>(exact)] = MadeUp{.cpu = 100}.row(plan);
  rows[static_cast<std::size_t>(check)] = MadeUp{.shift = 1e-5 * limit, .cpu = 50}.row(plan);
  rows[0] = MadeUp{.shift = 4e-3 * limit, .cpu = 2}.row(plan);
  rows[static_cast<std::size_t>(cheap)] = MadeUp{.shift = 4e-3 * limit, .cpu = 0.5}.row(plan);
  rows[static_cast<std::size_t>(fine)] = MadeUp{.shift = 5e-4 * limit, .cpu = 2}.row(plan);
  const PrecisionStudy study = gather(plan, rows);
  EXPECT_EQ(front(plan, study, 0, Measure::tilt), (std::vector<int>{cheap, fine, check}));
  EXPECT_EQ(cheapest(plan, study, 0, Measure::tilt, 1e-2), cheap);
  EXPECT_EQ(cheapest(plan, study, 0, Measure::tilt, 1e-3), fine);
  EXPECT_EQ(cheapest(plan, study, 0, Measure::tilt, 1e-4), check);
  EXPECT_EQ(cheapest(plan, study, 0, Measure::tilt, 1e-6), std::nullopt);  // the reference cannot tell
  const DefaultPlace place = place_of_default(plan, study, Measure::tilt).value();
  EXPECT_NEAR(place.cost_ratio, 4, 1e-9);
  EXPECT_NEAR(place.error_ratio, 8, 1e-4);
}

/// A cabinet that tumbles in free flight: smooth, so that orders are those of theory.
const PrecisionPlan& tumbling() {
  static const PrecisionPlan plan = plan_precision(io::load_scene("tumble", {"run.duration=0.4"}));
  return plan;
}

TEST(Precision, without_contact_there_is_one_law) {
  EXPECT_EQ(tumbling().laws.size(), 1u);
  EXPECT_EQ(rocking().laws.size(), 9u);
  EXPECT_EQ(rocking().laws[0], rocking().scene.setup.parameters.contact);
}

TEST(Precision, cheap_cases_of_the_own_law_come_first_and_each_comes_once) {
  const PrecisionPlan& plan = rocking();
  const std::vector<int> order = case_order(plan);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), static_cast<std::size_t>(plan.cases()));
  EXPECT_TRUE(std::ranges::is_sorted(order, {}, [&](int k) { return plan.law_of(k); }));
  EXPECT_EQ(plan.setting_of(order[0]).method, Method::rigid);
  EXPECT_GT(plan.setting_of(order[0]).step, plan.setting_of(order[1]).step);
}

// The trapezoidal rule and generalized-alpha are of second order: halving the step quarters the error, to the
// next order's share at 4 and 2 ms.
TEST(Precision, errors_of_smooth_motion_fall_with_second_order) {
  const PrecisionPlan& plan = tumbling();
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  const auto run = [&](Method method, int from_finest) {
    const int k = case_of(plan, method, from_finest);
    rows[static_cast<std::size_t>(k)] = run_case(plan, k, never);
    return k;
  };
  for (int n = 0; n < 3; ++n) run(Method::central_difference, n);
  run(Method::generalized_alpha, 0);
  std::vector<int> cases;
  for (const Method method : {Method::generalized_alpha, Method::newmark})
    for (const int n : {7, 6}) cases.push_back(run(method, n));
  const PrecisionStudy study = gather(plan, rows);
  ASSERT_EQ(study.references[0].run, case_of(plan, Method::central_difference, 0));
  EXPECT_NEAR(study.references[0].window, study.references[0].end, plan.interval);
  for (int m = 0; m < 2; ++m) {
    const double coarse = error_of(study, cases[static_cast<std::size_t>(2 * m)], Measure::tilt),
                 fine = error_of(study, cases[static_cast<std::size_t>(2 * m + 1)], Measure::tilt);
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << m;
  }
}

TEST(Precision, a_case_gives_the_same_row_again) {
  const PrecisionPlan& plan = tumbling();
  for (const Method method : {Method::rigid_auto, Method::elastic, Method::generalized_alpha_auto}) {
    const int k = case_of(plan, method, 3);
    EXPECT_EQ(without_time(run_case(plan, k, never)), without_time(run_case(plan, k, never)));
  }
}

TEST(Precision, a_case_that_fails_has_a_row_that_says_so) {
  const PrecisionPlan& plan = tumbling();
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  const int k = case_of(plan, Method::central_difference, 3);
  rows[static_cast<std::size_t>(k)] = run_case(plan, k, never);
  const PrecisionStudy study = gather(plan, rows);
  const PrecisionRow& row = study.rows[static_cast<std::size_t>(k)];
  EXPECT_NE(row.status.find("the time integration is stable up to a time_step of"), std::string::npos)
      << row.status;
  EXPECT_FALSE(row.cost);
  EXPECT_FALSE(row.errors[index(Measure::tilt)]);
  const ordered_json table = rows_as_json(plan, study);
  EXPECT_EQ(table[static_cast<std::size_t>(k)]["status"], row.status);
  EXPECT_TRUE(table[static_cast<std::size_t>(k)]["cpu_s_per_s"].is_null());
  EXPECT_EQ(table[0]["status"], "not run");
}

TEST(Precision, a_scene_that_does_not_begin_has_rows_that_say_so) {
  const PrecisionPlan plan = plan_precision(
      io::load_scene("tumble", {"run.settle=true", "run.gravity=[0, 0, -9.8]", "run.duration=0.1",
                                "cabinet.tumbler.angular_velocity=[0, 0, 0]"}));
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  rows[0] = run_case(plan, 0, never);
  const PrecisionStudy study = gather(plan, rows);
  EXPECT_NE(study.rows[0].status, "completed");
  EXPECT_TRUE(ordered_json::parse(rows[0])["balance"].empty());
  EXPECT_FALSE(study.rows[0].cost);
  EXPECT_NE(study.references[0].why_not, "");
}

TEST(Precision, a_case_that_is_given_up_has_no_row) {
  EXPECT_EQ(run_case(tumbling(), 0, [] { return true; }), "");
}

TEST(Precision, scenes_that_its_methods_cannot_step_are_refused) {
  const auto refusal = [](const io::Scene& scene) -> std::string {
    try {
      plan_precision(scene);
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(io::load_scene("portal-pushover")),
            "study precision: portal-pushover is not dynamic; it has no time steps");
  const std::string block = "topple = 1\n[[block]]\nname = \"safe\"\nsize = [0.2, 0.3, 0.5]\nmass = 12\n";
  EXPECT_EQ(refusal(io::parse_scene(block, "s.toml")),
            "study precision: s cannot be stepped by all methods: safe is a block, which is never a frame");
}

}  // namespace
}  // namespace topple::study
