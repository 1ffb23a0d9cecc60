// The overturning map: verdicts against theory, rows that do not depend on how they came, what is left open.
#include "solver/study/overturn/overturn_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "solver/study/overturn/overturn_chart.h"
#include "study_cases.h"
#include "verification/housner.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;

std::vector<std::string> run_all(const OverturnPlan& plan) {
  std::vector<std::string> rows(static_cast<std::size_t>(plan.cases()));
  OverturnRunner runner(plan);
  for (const int k : case_order(plan)) rows[static_cast<std::size_t>(k)] = runner.run(k, never);
  return rows;
}

/// Half-sines under a rigid uniform block on hard contacts.
OverturnPlan pulses(const std::string& durations, const std::string& amplitudes, int ensemble = 1,
                    double spread = 0) {
  return plan_overturn(io::load_scene("verify/rocking-defaults-half-sine-4-above"),
                       "shake.1.duration=" + durations, "shake.1.amplitude=" + amplitudes,
                       {.runs = ensemble, .spread = spread});
}

const test::Block k_block{0.19, 0.895, 4. / 3};

/// m/s^2; by another integration than that of the criteria.
double least_half_sine_of(const test::Block& block, double duration) {
  const auto falls = [&](double a) {
    return test::rock(
               block, {0, 0},
               [&](double t) { return t < duration ? a * std::sin(std::numbers::pi * t / duration) : 0; }, 3,
               1e-3)
        .overturned;
  };
  double low = 1, high = 10;
  while (high - low > 1e-5) (falls((low + high) / 2) ? high : low) = (low + high) / 2;
  return high * block.gravity * std::tan(block.critical);
}

// Contacts by default overturn up to 1.6 % below the rigid block (contact-default.md); the next
// value is up to 2 % off.
TEST(OverturnMap, the_boundary_is_the_exact_pulse_curve_within_two_percent) {
  const OverturnPlan plan = pulses("0.25..0.5:2", "3.4 m/s^2..7 m/s^2:37log");
  const OverturnMap map = gather(plan, run_all(plan));
  EXPECT_EQ(map.run, 74);
  for (int i = 0; i < 2; ++i) {
    const double exact = least_half_sine_of(k_block, plan.x.in_si(i));
    EXPECT_GT(exact, 1.1 * plan.y.in_si(0));
    EXPECT_LT(exact, plan.y.in_si(36) / 1.1);
    for (int j = 0; j < 37; ++j) {
      const double off = plan.y.in_si(j) / exact - 1;
      const Verdict verdict = map.points[static_cast<std::size_t>(2 * j + i)].verdict;
      if (off < -0.02) {
        EXPECT_EQ(verdict, Verdict::rocks) << i << " " << off;
      }
      if (off > 0.02) {
        EXPECT_EQ(verdict, Verdict::all) << i << " " << off;
      }
    }
    // the curve that is drawn is the same, to the straight lines between its places
    const Criterion& curve = map.criteria.list.back();
    EXPECT_EQ(curve.name, "half-sine");
    const auto above =
        std::ranges::lower_bound(curve.x, plan.x.values[static_cast<std::size_t>(i)]) - curve.x.begin();
    const double part = (plan.x.values[static_cast<std::size_t>(i)] - curve.x[above - 1]) /
                        (curve.x[above] - curve.x[above - 1]);
    EXPECT_NEAR(std::lerp(curve.y[above - 1], curve.y[above], part) * plan.y.si / exact, 1, 1e-3);
  }
}

// Just above West's acceleration it turns by less than the angle from which uplift counts: half-sines a tenth
// above push it for 0.2 s or more, hence by some tenths of a degree.
TEST(OverturnMap, a_rigid_block_does_not_lift_below_west) {
  const double west = k_block.gravity * std::tan(k_block.critical);
  const OverturnPlan plan =
      pulses("0.4..0.8:2", std::to_string(0.98 * west) + ".." + std::to_string(1.1 * west) + ":2");
  const OverturnMap map = gather(plan, run_all(plan));
  const Verdict expected[] = {Verdict::stands, Verdict::stands, Verdict::rocks, Verdict::rocks};
  for (int p = 0; p < 4; ++p) EXPECT_EQ(map.points[static_cast<std::size_t>(p)].verdict, expected[p]) << p;
}

// Samples stand 5 ms apart: at 2 Hz the peak lies up to 1.8 degrees beside one, 5e-4; the trapezoidal rule is
// off by (w h)^2/12 = 3e-4.
TEST(OverturnMap, peaks_of_the_floor_are_those_of_the_sine_the_pulse_and_the_record) {
  const OverturnPlan sine =
      plan_overturn(io::load_scene("paper-a"), "shake.1.frequency=0.5..2:3", "shake.1.amplitude=2..4:3");
  const OverturnMap none = gather(sine, std::vector<std::string>(9));
  for (int k = 0; k < 3; ++k) {
    const std::vector<FloorPeak> peaks = floor_peaks(sine, none, k);
    for (int i = 0; i < 3; ++i) {
      const double a = sine.y.in_si(i), w = 2 * std::numbers::pi * sine.x.in_si(k);
      EXPECT_NEAR(peaks[static_cast<std::size_t>(i)].acceleration / a, 1, 1e-3);
      EXPECT_NEAR(peaks[static_cast<std::size_t>(i)].velocity / (a / w), 1, 1e-3);
    }
  }
  // however it begins: from rest it would come to twice that, with a taper to a third more
  for (const char* start :
       {"shake.1.initial_velocity=rest", "shake.1.initial_velocity=jump", "shake.1.taper=1"}) {
    const io::Scene scene =
        io::load_scene("paper-a", {"shake.1.frequency=0.5", "shake.1.amplitude=2", start});
    EXPECT_NEAR(
        floor_peak(scene.setup.parameters.shakes, scene.setup.run.duration).velocity / (2 / std::numbers::pi),
        1, 1e-3)
        << start;
  }
  const OverturnPlan pulse = pulses("0.25..0.5:2", "4 m/s^2..6 m/s^2:2");
  const FloorPeak half = floor_peaks(pulse, gather(pulse, std::vector<std::string>(4)), 1).back();
  EXPECT_NEAR(half.acceleration / 6, 1, 1e-3);
  EXPECT_NEAR(half.velocity / (2 * 6 * 0.5 / std::numbers::pi), 1, 1e-3);

  const OverturnPlan record =
      plan_overturn(io::load_scene("near-fault"), "contact.friction=0.3..0.6:2", "shake.1.scale=0.5..2:4");
  const std::vector<FloorPeak> scaled = floor_peaks(record, gather(record, std::vector<std::string>(8)), 0);
  ASSERT_EQ(scaled.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(scaled[static_cast<std::size_t>(i)].velocity / scaled[0].velocity,
                record.y.values[static_cast<std::size_t>(i)] / record.y.values[0], 1e-9);
  }
  EXPECT_GT(scaled[0].acceleration, 0.5);
}

// What a building makes of the ground's sine follows its frequency and the building's period.
TEST(OverturnMap, peaks_of_the_floor_of_a_building_are_those_of_the_point_of_the_map) {
  const std::vector<std::string> building = {"shake.1.building={storey=5,of=7,period=0.65,damping=0.03}",
                                             "shake.1.cycles=6", "run.duration=10"};
  const io::Scene scene = io::load_scene("cabinet", building);
  for (const auto* key : {"shake.1.frequency=0.6..3:2", "shake.1.building.period=0.3..1.2:2"}) {
    SCOPED_TRACE(key);
    const OverturnPlan plan = plan_overturn(scene, key, "shake.1.amplitude=1..2:2");
    for (int k = 0; k < 2; ++k) {
      std::vector<std::string> changes = building;
      changes.push_back(plan.x.change(k));
      changes.push_back("shake.1.amplitude=2");
      const FloorPeak own =
          floor_peak(io::load_scene("cabinet", changes).setup.parameters.shakes, scene.setup.run.duration);
      const FloorPeak found = floor_peaks(plan, gather(plan, std::vector<std::string>(4)), k).back();
      EXPECT_NEAR(found.acceleration / own.acceleration, 1, 1e-9) << k;
      EXPECT_NEAR(found.velocity / own.velocity, 1, 1e-9) << k;
    }
  }
}

TEST(OverturnMap, runs_of_an_ensemble_do_not_depend_on_their_order) {
  const OverturnPlan plan = pulses("0.25..0.5:2", "4 m/s^2..6 m/s^2:2", 5, 0.2);
  const std::vector<std::string> rows = run_all(plan);
  OverturnRunner backwards(plan);
  std::set<std::string> different;
  for (int k = plan.cases(); k-- > 0;) {
    const std::string again = without_time(backwards.run(k, never));
    EXPECT_EQ(again, without_time(rows[static_cast<std::size_t>(k)])) << k;
    different.insert(again);
  }
  EXPECT_GT(different.size(), 8u);  // members differ in their times where they fall
  const OverturnMap map = gather(plan, rows);
  for (const OverturnPoint& point : map.points) {
    EXPECT_EQ(point.runs, 5);
    EXPECT_EQ(point.overturned, static_cast<int>(point.times.size()));
    EXPECT_EQ(point.fell, std::vector<int>{point.overturned});
    EXPECT_NEAR(point.interval()->high, wilson(point.overturned, 5).high, 0);
  }
  EXPECT_GT(map.points[2].time(0.9).value(), map.points[2].time(0.1).value());
}

TEST(OverturnMap, rounds_come_to_one_four_and_all_runs_at_each_point) {
  const OverturnPlan plan = pulses("0.25..0.5:3", "4 m/s^2..6 m/s^2:3", 6, 0.05);
  const std::vector<int> order = case_order(plan);
  ASSERT_EQ(order.size(), 54u);
  int counts[9] = {};
  for (int n = 0; n < 54; ++n) {
    ++counts[order[static_cast<std::size_t>(n)] / 6];
    const auto [least, most] = std::ranges::minmax(counts);
    if (n + 1 == 9) {
      EXPECT_EQ(std::pair(least, most), std::pair(1, 1));
    }
    if (n + 1 == 36) {
      EXPECT_EQ(std::pair(least, most), std::pair(4, 4));
    }
  }
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 54u);
}

OverturnPlan steel_cabinet(const std::vector<std::string>& set, const std::string& x = "") {
  return plan_overturn(io::load_scene("cabinet", set), x.empty() ? "shake.1.frequency=0.3..0.7:3" : x,
                       "shake.1.amplitude=150 gal..350 gal:5");
}

// Contacts of 1e6 kgf leave 1e-3 of the critical angle (planar_case_test.cpp). A fall that begins near
// balance grows with exp(p t), p = 2.6/s: less by a thousandth of the angle, later by 0.1 s, 3 %.
TEST(OverturnMap, planar_blocks_have_the_verdicts_of_rigid_bodies_on_hard_contacts) {
  const OverturnPlan blocks = steel_cabinet({});
  const OverturnPlan bodies =
      steel_cabinet({"cabinet.cabinet.model=rigid", "contact.alpha=1e6 kgf", "contact.normal_speed=1e-4"});
  EXPECT_EQ(why_not_planar(blocks), "");
  EXPECT_EQ(why_not_planar(bodies), "cabinet: its model is named");
  const OverturnMap planar = gather(blocks, run_all(blocks)), rigid = gather(bodies, run_all(bodies));
  EXPECT_EQ(planar.planar, 15);
  EXPECT_EQ(rigid.planar, 0);
  int fallen = 0;
  for (std::size_t p = 0; p < 15; ++p) {
    const OverturnPoint &a = planar.points[p], &b = rigid.points[p];
    EXPECT_EQ(a.verdict, b.verdict) << p;
    fallen += a.overturned;
    if (a.overturned && b.overturned) {
      EXPECT_NEAR(a.times[0], b.times[0], 0.05 * b.times[0]) << p;
    }
  }
  EXPECT_GT(fallen, 3);
  EXPECT_LT(fallen, 12);
}

// In parts of up to 64 runs; alone each has the same bits.
TEST(OverturnMap, runs_in_lanes_are_those_that_go_alone) {
  OverturnPlan plan = plan_overturn(io::load_scene("cabinet"), "shake.1.frequency=0.4..0.6:2",
                                    "shake.1.amplitude=150 gal..300 gal:2",
                                    {.runs = 70, .vary = {"amplitude=uniform:0.6..1.4", "size=normal:5%"}});
  EXPECT_EQ(plan.cases(), 8);
  const std::vector<std::string> rows = run_all(plan);
  EXPECT_EQ(gather(plan, rows).planar, 280);
  plan.chunk = 1;
  OverturnRunner alone(plan);
  std::set<std::string> different;
  for (int k = 0; k < plan.cases(); ++k) {
    const int point = k / 70, member = k % 70;
    const auto part = static_cast<std::size_t>(2 * point + member / 64),
               at = static_cast<std::size_t>(member % 64);
    const ordered_json run = ordered_json::parse(alone.run(k, never))["runs"][0];
    EXPECT_EQ(run, ordered_json::parse(rows[part])["runs"][at]) << k;
    different.insert(run.dump());
  }
  EXPECT_GT(different.size(), 40u);  // members differ in their times where they fall
}

// By an edit of the shake, and by reading the scene where an axis changes something else.
TEST(OverturnMap, planar_blocks_do_not_depend_on_how_their_shake_was_set) {
  const OverturnPlan edited = steel_cabinet({});
  const OverturnPlan read = steel_cabinet({"shake.1.frequency=0.5"}, "contact.friction=0.5..0.7:3");
  const OverturnMap a = gather(edited, run_all(edited)), b = gather(read, run_all(read));
  EXPECT_EQ(b.planar, 15);
  for (std::size_t row = 0; row < 5; ++row)
    EXPECT_EQ(a.points[3 * row + 1].times, b.points[3 * row + 1].times) << row;
}

TEST(OverturnMap, says_why_a_scene_is_not_planar) {
  const auto why = [](const std::vector<std::string>& set) { return why_not_planar(steel_cabinet(set)); };
  EXPECT_EQ(why({"contact.restitution=0.3"}), "contacts bounce");
  EXPECT_EQ(why({"contact.alpha=50 kgf"}), "contacts are soft");
  EXPECT_EQ(why({"run.want=[\"stress\"]"}), "stresses are asked for");
  EXPECT_EQ(why({"cabinet.cabinet.base=edges"}), "");
  EXPECT_EQ(why({"cabinet.cabinet.yaw=30 deg"}),
            "cabinet: it is not symmetric about the plane of its motion");
}

TEST(OverturnMap, what_was_not_run_is_open_in_every_result) {
  const OverturnPlan plan = pulses("0.25..0.5:2", "4 m/s^2..6 m/s^2:2");
  std::vector<std::string> rows(4);
  rows[3] = OverturnRunner(plan).run(3, never);
  const OverturnMap map = gather(plan, rows);
  EXPECT_EQ(map.run, 1);
  EXPECT_EQ(map.of, 4);
  const ordered_json json = map_as_json(plan, map), table = rows_as_json(plan, map);
  EXPECT_EQ(json["verdict"][0][0], "not computed");
  EXPECT_EQ(json["verdict"][1][1], "all overturn");
  EXPECT_TRUE(json["probability"][0][1].is_null());
  EXPECT_EQ(json["probability"][1][1], 1);
  EXPECT_EQ(table[0]["status"], "not run");
  EXPECT_TRUE(table[0]["overturn_time_s"].is_null());
  const std::string chart = overturn_chart(plan, map, "here", ChartFormat::svg);
  EXPECT_NE(chart.find("1 of 4 runs"), std::string::npos);
  EXPECT_NE(chart.find("not computed"), std::string::npos);
}

/// Of the terminal of a chart: "size WIDTH,HEIGHT".
std::pair<int, int> sheet_size(const std::string& chart) {
  const std::size_t at = chart.find("size ") + 5;
  return {std::stoi(chart.substr(at)), std::stoi(chart.substr(chart.find(',', at) + 1))};
}

// A letter is 9 px wide at most.
TEST(OverturnMap, every_mark_is_explained_within_the_sheet) {
  const OverturnPlan plan = pulses("0.25..0.5:3", "4 m/s^2..6 m/s^2:2");
  OverturnMap map = gather(plan, std::vector<std::string>(6));
  const int usual = sheet_size(overturn_chart(plan, map, "here", ChartFormat::png)).second;
  const Verdict all[] = {Verdict::stands, Verdict::rocks,  Verdict::some,
                         Verdict::all,    Verdict::failed, Verdict::not_computed};
  for (std::size_t k = 0; k < std::size(all); ++k) map.points[k].verdict = all[k];
  const std::string chart = overturn_chart(plan, map, "here", ChartFormat::png);
  const auto [width, height] = sheet_size(chart);
  EXPECT_GT(height, usual);  // marks in a second row do not take the room of other words
  for (const char* const words :
       {"stands: no side of a base lifts", "rocks and stays up", "some bodies overturn",
        "all bodies overturn", "the run failed", "not computed"}) {
    const std::string meaning = words;
    const std::size_t at = chart.find('"' + meaning + "\" at screen ");
    ASSERT_NE(at, std::string::npos) << meaning;
    const double left = std::stod(chart.substr(at + meaning.size() + 13));
    EXPECT_LT(left * width + 9 * static_cast<double>(meaning.size()), width) << meaning;
  }
}

TEST(OverturnMap, a_run_that_is_given_up_has_no_row) {
  const OverturnPlan plan = pulses("0.25..0.5:2", "4 m/s^2..6 m/s^2:2");
  EXPECT_EQ(OverturnRunner(plan).run(0, [] { return true; }), "");
}

TEST(OverturnMap, scenes_that_cannot_be_built_at_a_point_have_a_row_that_says_so) {
  // no densities of its members put the centre of gravity of a cabinet so low
  const OverturnPlan plan = plan_overturn(io::load_scene("paper-a"), "cabinet.free.cg_height=0.01..1.05:2",
                                          "shake.1.amplitude=1..1.1:2");
  const OverturnMap map = gather(plan, {OverturnRunner(plan).run(0, never), "", "", ""});
  EXPECT_EQ(map.points[0].verdict, Verdict::failed);
  EXPECT_EQ(map.points[0].failed, 1);
  EXPECT_NE(map.points[0].status.find("cg_height"), std::string::npos) << map.points[0].status;
}

TEST(OverturnMap, the_study_adds_to_a_scene_what_it_leaves_out_alone) {
  const auto added = [](const std::vector<std::string>& set) {
    return plan_overturn(io::load_scene("paper-a", set), "", "").set;
  };
  EXPECT_EQ(added({}), (std::vector<std::string>{"run.want=[\"motion\"]", "run.accuracy=0.05",
                                                 "run.stop_when=all-overturned"}));
  EXPECT_EQ(added({"run.want=[\"stress\"]", "run.accuracy=0.01", "run.stop_when=never"}),
            std::vector<std::string>{});
}

TEST(OverturnMap, plans_that_make_no_sense_are_refused) {
  const auto refused = [](const std::string& scene, const std::string& x, const std::string& y, int ensemble,
                          const std::string& part) {
    try {
      plan_overturn(io::load_scene(scene), x, y, {.runs = ensemble, .spread = 0.05});
      ADD_FAILURE() << part;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused("portal-pushover", "", "", 1, "is not dynamic");
  refused("near-fault", "", "", 1, "--x KEY=FROM..TO:N is required");
  refused("free-rocking", "contact.friction=0..1:3", "contact.q=1..2:3", 4, "has no shake");
  refused("paper-a", "shake.1.amplitude=1..2:3", "", 1, "is the key of the x axis");
  refused("paper-a", "shake.1.duration=1..2:3", "", 1, "--x shake.1.duration=1 s: shake.table.duration: ");
}

}  // namespace
}  // namespace topple::study
