// Fragility: theory gives it back, records count, parts do not depend on their order.
#include "solver/study/overturn/fragility_study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "solver/io/scene/scene_file.h"
#include "solver/study/common/standing.h"
#include "study_cases.h"

namespace topple::study {
namespace {

std::vector<std::string> run_all(const FragilityPlan& plan) {
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  FragilityRunner runner(plan);
  for (const int k : case_order(plan)) rows[static_cast<std::size_t>(k)] = runner.run(k, never);
  return rows;
}

/// A uniform block under a half-sine, which does not slide.
io::Scene pulsed() {
  return io::load_scene("verify/rocking-defaults-half-sine-4-above",
                        {"frame.block.model=auto", "contact.friction=1.5"});
}

/// Least amplitude of a half-sine under which a block rocks to `angle`, m/s^2: the equation of rocking, by
/// the classical Runge-Kutta method in 1e-4 of the pulse, bisected.
double least_that_turns(const Standing& body, double duration, double angle) {
  const double critical = body.critical(), p2 = body.p() * body.p();
  const auto turns = [&](double amplitude) {
    const auto rise = [&](double t, double th) {
      const double push =
          t < duration ? amplitude / body.gravity * std::sin(std::numbers::pi * t / duration) : 0;
      return p2 * (-std::sin(critical - th) + push * std::cos(critical - th));
    };
    const double h = 1e-4 * duration;
    double t = std::asin(body.gravity * std::tan(critical) / amplitude) * duration / std::numbers::pi, th = 0,
           rate = 0;
    while (th >= 0 && th < angle) {
      const double k1 = rise(t, th), k2 = rise(t + h / 2, th + h / 2 * rate),
                   k3 = rise(t + h / 2, th + h / 2 * rate + h * h / 4 * k1),
                   k4 = rise(t + h, th + h * rate + h * h / 2 * k3);
      th += h * rate + h * h / 6 * (k1 + k2 + k3);
      rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      t += h;
    }
    return th >= angle;
  };
  double low = body.gravity * std::tan(critical) * (1 + 1e-9), high = 2 * low;
  for (int k = 0; k < 40; ++k) (turns((low + high) / 2) ? high : low) = (low + high) / 2;
  return high;
}

// The least half-sine of theory overturns; with amplitudes that are lognormal about the level the share is
// Phi(ln(level/least)/beta). 512 points of the sequence at each of 24 levels give a share to a few times
// 1/512, and the median to beta times that over the root of the levels in the middle.
TEST(FragilityStudy, a_known_threshold_and_a_known_scatter_come_back) {
  constexpr double k_beta = 0.3;
  const FragilityPlan plan = plan_fragility(pulsed(), "pga=100 gal..1500 gal:24",
                                            {.runs = 512, .vary = {"amplitude=lognormal:0.3"}}, 0.05);
  const FragilityResults found = gather(plan, run_all(plan));
  EXPECT_EQ(found.runs, 24 * 512);
  EXPECT_EQ(found.planar, found.runs);
  EXPECT_EQ(found.failed, 0);
  const topple::Setup& setup = plan.scene.setup;
  const Standing body = *standing_towards(setup.model, setup.parameters, 0, Vec3::UnitX());
  const double duration = setup.parameters.shakes.front().duration;
  const double least = body.gravity * least_half_sine(body, std::numbers::pi / duration / body.p()) / k_gal;
  const FragilityCurve& overturns = found.curves[0][2];
  ASSERT_TRUE(overturns.fit.fit) << overturns.fit.why_not;
  EXPECT_NEAR(overturns.median / least, 1, 2e-3);
  EXPECT_NEAR(overturns.fit.fit->beta / k_beta, 1, 0.01);
  const FragilityCurve& lifts = found.curves[0][0];
  EXPECT_NEAR(lifts.median / (least_that_turns(body, duration, k_uplift_angle) / k_gal), 1, 2e-3);
  EXPECT_GT(lifts.median, west_acceleration(body) / k_gal);
  EXPECT_NEAR(found.criteria[0].west / (west_acceleration(body) / k_gal), 1, 1e-9);
  EXPECT_FALSE(found.curves[0][1].fit.fit);  // nothing slides
  EXPECT_EQ(found.curves[0][1].fit.why_not, "no run slides farther");
}

// The floor of a sine that begins at rest is faster than A/w at first. What bears something has no criteria
// of its own.
TEST(FragilityStudy, criteria_are_those_of_a_steady_sine_and_of_a_block_alone) {
  const FragilityPlan plan = plan_fragility(io::parse_scene(R"(topple = 1
[run]
duration = "4 s"
[[shake]]
type = "sine"
frequency = "1.3 Hz"
amplitude = "220 gal"
taper = 1
[floor]
[[block]]
name = "pedestal"
size = [0.4, 0.4, 1.0]
mass = 60
at = [0, 0]
[[block]]
name = "vase"
size = [0.25, 0.25, 0.6]
mass = 12
at = [0, 0, 1.02]
[[block]]
name = "showcase"
size = [0.4, 0.6, 2.0]
mass = 140
at = [2, 0]
)",
                                                            "s.toml"),
                                            "pga=100 gal..300 gal:2", {.runs = 1}, 0.05);
  const FragilityResults found = gather(plan, run_all(plan));
  const topple::Setup& setup = plan.scene.setup;
  EXPECT_EQ(found.frequency, 1.3);
  EXPECT_EQ(found.criteria[0].why_not, "bears \"vase\"");
  EXPECT_EQ(found.criteria[1].why_not, "does not touch the floor");
  const Standing body = *standing_towards(setup.model, setup.parameters, 2, Vec3::UnitX());
  EXPECT_NEAR(found.criteria[2].ishiyama, ishiyama_velocity(body) * 2 * std::numbers::pi * 1.3 / k_gal, 1e-9);
}

// A push that is not square to an edge lifts the block when its part across that is what lifts it.
TEST(FragilityStudy, criteria_of_a_push_askew_are_of_its_part_across_the_edge) {
  const FragilityPlan plan = plan_fragility(io::parse_scene(R"(topple = 1
[run]
duration = "4 s"
[[shake]]
type = "sine"
frequency = "1 Hz"
amplitude = "200 gal"
direction = [4, 3, 0]
[floor]
[[block]]
name = "tall"
size = [0.9, 0.3, 2.0]
mass = 90
at = [0, 0]
)",
                                                            "s.toml"),
                                            "pga=100 gal..300 gal:2", {.runs = 1}, 0.05);
  const BodyCriteria criteria = gather(plan, run_all(plan)).criteria[0];
  EXPECT_EQ(criteria.why_not, "");
  EXPECT_NEAR(criteria.share, 0.6, 1e-9);
  EXPECT_NEAR(criteria.west, k_standard_gravity * 0.3 / 2.0 / 0.6 / k_gal, 1e-6);
}

// What a stronger floor brings back upright has no lognormal curve, however well one can be fitted.
TEST(FragilityStudy, shares_that_fall_have_no_curve) {
  const FragilityPlan plan = plan_fragility(pulsed(), "pga=100 gal..1500 gal:24",
                                            {.runs = 40, .vary = {"amplitude=lognormal:0.3"}}, 0.05);
  std::vector<std::string> rows;
  for (int k = 0; k < plan.cases(); ++k) {
    const int level = k / plan.chunks() / plan.records(), last = plan.levels.count() - 1;
    const int hits = level == last ? 0 : level > last / 2 ? 40 : 0;
    const std::string all = "[" + std::to_string(hits) + ",0," + std::to_string(hits) + "]";
    rows.push_back("{\"runs\":40,\"failed\":0,\"planar\":40,\"status\":\"completed\",\"hits\":[" + all + "," +
                   all + "],\"closed\":[],\"cpu_s\":0}");
  }
  const FragilityCurve overturns = gather(plan, rows).curves[0][2];
  EXPECT_FALSE(overturns.fit.fit);
  EXPECT_TRUE(overturns.fit.why_not.starts_with("it becomes rarer again: ")) << overturns.fit.why_not;
}

/// That of the first quantity, with `hits` of `runs` at each level.
FragilityCurve curve_with(const FragilityPlan& plan, int runs, const std::vector<int>& hits) {
  std::vector<std::string> rows;
  for (int k = 0; k < plan.cases(); ++k) {
    const int level = k / plan.chunks() / plan.records();
    const std::string count = std::to_string(runs),
                      all = "[" + std::to_string(hits[static_cast<std::size_t>(level)]) + ",0,0]";
    rows.push_back("{\"runs\":" + count + ",\"failed\":0,\"planar\":" + count +
                   ",\"status\":\"completed\",\"hits\":[" + all + "," + all + "],\"closed\":[],\"cpu_s\":0}");
  }
  return gather(plan, rows).curves[0][0];
}

// Two of four runs at a level in the middle, none at the last: no median lies above the levels.
TEST(FragilityStudy, half_of_few_runs_that_are_met_and_left_again_are_told_as_that) {
  const FragilityCurve lifts =
      curve_with(plan_fragility(pulsed(), "pga=100 gal..1000 gal:4", {.runs = 4}, 0.05), 4, {0, 0, 2, 0});
  EXPECT_FALSE(lifts.fit.fit);
  EXPECT_EQ(lifts.fit.why_not.find("the median lies"), std::string::npos) << lifts.fit.why_not;
}

// The median of the fit lies just above the last level: 1204 gal.
TEST(FragilityStudy, half_of_the_runs_at_the_last_level_are_not_left_again) {
  const FragilityCurve lifts =
      curve_with(plan_fragility(pulsed(), "pga=600 gal..1200 gal:4", {.runs = 20}, 0.05), 20, {0, 1, 4, 10});
  EXPECT_FALSE(lifts.fit.fit);
  EXPECT_TRUE(lifts.fit.why_not.starts_with("the median lies above the levels")) << lifts.fit.why_not;
  EXPECT_NE(lifts.fit.why_not.find("at most 50 %"), std::string::npos) << lifts.fit.why_not;
}

TEST(FragilityStudy, levels_of_any_measure_are_reached) {
  const io::Scene scene = pulsed();
  for (const MotionMeasure& measure : motion_measures()) {
    const topple::Setup& setup = scene.setup;
    const double own = measure.of(setup.parameters.shakes, setup.run.duration);
    const double wanted = measure.value(1.7 * measure.intensity(own));
    const std::vector<Shake> scaled =
        shaken_by(setup.parameters.shakes, amplitude_factor(measure, own, wanted));
    EXPECT_NEAR(measure.of(scaled, setup.run.duration) / wanted, 1, 1e-9) << measure.title;
  }
}

TEST(FragilityStudy, parts_are_the_same_in_any_order) {
  const FragilityPlan plan =
      plan_fragility(pulsed(), "pga=200 gal..900 gal:3", {.runs = 150, .spread = 0.3}, 0.01);
  EXPECT_EQ(plan.cases(), 3 * 3);  // 64, 64 and 22 runs
  const std::vector<std::string> rows = run_all(plan);
  FragilityRunner backwards(plan);
  for (int k = plan.cases(); k-- > 0;)
    EXPECT_EQ(without_time(backwards.run(k, never)), without_time(rows[static_cast<std::size_t>(k)])) << k;
  EXPECT_EQ(backwards.run(0, [] { return true; }), "");
  EXPECT_EQ(gather(plan, rows).runs, 450);
}

// The runs of a part end after very different numbers of steps: those of a strong level overturn early, those
// of a weak one never lift.
TEST(FragilityStudy, lanes_of_parts_are_busy) {
  const FragilityPlan plan = plan_fragility(
      io::load_scene("near-fault"), "pga=80 gal..1500 gal:8",
      {.runs = 400, .vary = {"amplitude=lognormal:0.25", "size=normal:10%", "friction=normal:20%"}}, 0.05);
  const io::Scene scene =
      io::parse_scene(plan.scene.text, plan.scene.name, plan.set, io::kept_files(plan.scene));
  const std::vector<planar::PlanarCase> blocks = planar_cases(scene.setup);
  ASSERT_FALSE(blocks.empty());
  planar::LaneUse use;
  for (int level = 0; level < plan.levels.count(); ++level) {
    const double factor = amplitude_factor(*plan.measure, plan.own.front(), plan.levels.in_si(level));
    for (int first = 0; first < plan.runs; first += plan.chunk) {
      std::vector<PlanarMember> members;
      for (int member = first; member < std::min(plan.runs, first + plan.chunk); ++member) {
        const std::vector<double> values =
            plan.factors.draw(static_cast<std::uint64_t>(level), static_cast<std::uint32_t>(member));
        members.push_back(
            {blocks, shaken_by(scene.setup.parameters.shakes, factor), scene.setup.run.duration});
        PlanarMember& one = members.back();
        vary(plan.factors, values, one.shakes);
        for (planar::PlanarCase& block : one.blocks) vary(plan.factors, values, block);
      }
      run_planar(members, never, &use);
    }
  }
  RecordProperty("share", std::to_string(use.share()));
  EXPECT_GT(use.share(), 0.7);
}

// What slides to within reach of a wall is run again with the rigid model. Such runs stand between planar
// ones of a part; each of these ends as it does alone.
TEST(FragilityStudy, runs_that_climb_are_counted_and_do_not_disturb_others) {
  const io::Scene own = io::load_scene("cabinet");
  const io::Scene scene = io::parse_scene(
      own.text + "\n[[wall]]\nname = \"far\"\nat = [-3.2, 0]\nnormal = [1, 0, 0]\ntype = \"plane\"\n",
      "walled.toml", {"contact.friction=0.1", "shake.1.frequency=0.25", "run.duration=4 s"});
  const FragilityPlan plan =
      plan_fragility(scene, "pga=150 gal..450 gal:2", {.runs = 24, .vary = {"friction=uniform:0.2..5"}}, 0.5);
  ASSERT_TRUE(is_planar(plan));
  const FragilityResults found = gather(plan, run_all(plan));
  EXPECT_EQ(found.runs, 48);
  EXPECT_EQ(found.failed, 0);
  EXPECT_GT(found.planar, 8);
  EXPECT_LT(found.planar, 44);
  const io::Scene whole = io::parse_scene(plan.scene.text, plan.scene.name, plan.set);
  const std::vector<planar::PlanarCase> blocks = planar_cases(whole.setup);
  for (int level = 0; level < 2; ++level) {
    const std::vector<Shake> shakes =
        shaken_by(whole.setup.parameters.shakes,
                  amplitude_factor(*plan.measure, plan.own.front(), plan.levels.in_si(level)));
    const RunStart start{blocks, shakes, whole.setup.run.duration,
                         [&]() -> const io::Scene& { return whole; }};
    std::array<int, k_states> hits{};
    for (std::uint32_t member = 0; member < 24; ++member) {
      const RunEnd end = run_varied({{&start, plan.factors.draw(static_cast<std::uint64_t>(level), member)}},
                                    plan.factors, never)
                             .front();
      for (std::size_t s = 0; s < k_states; ++s)
        hits[s] += damage_states()[s].is_there(end.of_bodies.front(), plan.slide);
    }
    for (std::size_t s = 0; s < k_states; ++s)
      EXPECT_EQ(found.curves[0][s].levels[static_cast<std::size_t>(level)].hits, hits[s])
          << level << ' ' << s;
  }
}

TEST(FragilityStudy, records_are_scaled_each_and_resampled) {
  const FragilityPlan plan = plan_fragility(
      io::load_scene("cabinet"), "pgv=5 cm/s..200 cm/s:8",
      {.runs = 30, .spread = 0.2, .vary = {"records=near-fault.csv,long-period-x.AT2,long-period-y.EW"}},
      0.05);
  EXPECT_EQ(plan.records(), 3);
  EXPECT_EQ(plan.runs, 10);
  EXPECT_NE(plan.own[0], plan.own[1]);
  const FragilityResults found = gather(plan, run_all(plan));
  EXPECT_EQ(found.runs, 8 * 30);
  const FragilityCurve& overturns = found.curves[0][2];
  ASSERT_TRUE(overturns.fit.fit) << overturns.fit.why_not;
  if (overturns.median_of_records) {
    EXPECT_LE(overturns.median_of_records->low, overturns.median);
    EXPECT_GE(overturns.median_of_records->high, overturns.median);
  }
}

// The values that the method states, to the gal they are rounded to.
TEST(FragilityStudy, the_evaluation_gives_the_published_medians) {
  for (const auto& [limit, median] : {std::pair(174., 205.), std::pair(232., 287.), std::pair(327., 436.),
                                      std::pair(315., 416.), std::pair(535., 826.)}) {
    Standing body{};
    body.gravity = 9.8, body.base = limit / 980, body.height = 1;
    EXPECT_NEAR(evaluation_acceleration(body) * 100, median, 1.5);
  }
  // 10 B/sqrt(H) (1 + B/H)^2.5, cm/s, is the velocity at the corner
  Standing body{};
  body.gravity = 9.8, body.base = 0.2, body.height = 0.9;
  const double B = 40, H = 180;
  EXPECT_NEAR(100 * evaluation_acceleration(body) / (2 * std::numbers::pi * evaluation_frequency(body)) /
                  (10 * B / std::sqrt(H) * std::pow(1 + B / H, 2.5)),
              1, 1e-3);
}

TEST(FragilityStudy, plans_that_make_no_sense_are_refused) {
  const auto refused = [](const io::Scene& scene, const std::string& levels, const Ensemble& ensemble,
                          const std::string& message) {
    try {
      plan_fragility(scene, levels, ensemble, 0.05);
      ADD_FAILURE() << message;
    } catch (const io::InputError& error) {
      EXPECT_EQ(std::string(error.what()).substr(0, message.size()), message);
    }
  };
  const io::Scene scene = io::load_scene("cabinet");
  const Ensemble few{.runs = 4, .spread = 0.05};
  refused(io::load_scene("portal-pushover"), "", few, "study fragility: portal-pushover is not dynamic");
  refused(scene, "pgd=1..2:3", few,
          "--x \"pgd\": is not a measure of the floor's motion; known: pga, pgv, arias, jma");
  refused(scene, "pga=1 cm/s..2 cm/s:3", few, "--x pga: \"1 cm/s\" is a velocity, expected an acceleration");
  refused(scene, "pga=0..2:3", few, "--x pga: 0 gal is outside ");
  refused(scene, "pga", few, "--x \"pga\": expected KEY=FROM..TO:N");
  refused(scene, "pga=100 gal..900 gal:200", {.runs = 1000000, .spread = 0.05},
          "--ensemble: 200 levels of 1000000 runs are more than 1e+08 runs");
}

}  // namespace
}  // namespace topple::study
