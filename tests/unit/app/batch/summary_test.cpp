#include "app/batch/summary.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/batch/ways_summary.h"
#include "app/support/terms.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

class SummaryTest : public ::testing::Test {
 protected:
  SummaryTest() : scene_(io::parse_scene(k_shaken, "s.toml")), run_(scene_.setup) {
    for (int i = 0; i < 50; ++i) EXPECT_TRUE(run_.advance().ok());
  }
  io::Scene scene_;
  topple::Run run_;
};

TEST_F(SummaryTest, numbers_are_those_of_the_run) {
  const Json s = summary(scene_, run_, "interrupted", 0.5);
  EXPECT_EQ(s["status"], "interrupted");
  EXPECT_EQ(s["simulated_s"], run_.state().time);
  EXPECT_EQ(s["wall_s"], 0.5);
  EXPECT_DOUBLE_EQ(s["realtime_factor"], run_.state().time / 0.5);
  EXPECT_EQ(s["steps"], 50);
  const EnergyLedger& e = run_.state().energy;
  EXPECT_EQ(s["energy"]["dissipated_J"], e.dissipated());
  const BodyOutcome& body = run_.outcome().bodies()[0];
  EXPECT_DOUBLE_EQ(s["bodies"][0]["peak_tilt_deg"], body.peak_tilt * 180 / k_pi);
  EXPECT_EQ(s["bodies"][0]["peak_stress_Pa"], body.peak_stress);
  EXPECT_EQ(s["probes"][0]["final"]["displacement_m"][0], run_.probes()[0].displacement.x());
  EXPECT_FALSE(s.contains("message"));
}

TEST_F(SummaryTest, energies_add_up_to_the_balance_error) {
  const Json s = summary(scene_, run_, "completed", 1);
  const auto energy = [&](const char* key) { return s["energy"][key].get<double>(); };
  const EnergyLedger& e = run_.state().energy;
  const double unexplained = energy("kinetic_J") + energy("strain_J") + energy("contact_J") +
                             energy("gravity_J") + energy("dissipated_J") - energy("input_J") - e.start_total;
  EXPECT_NEAR(std::abs(unexplained), energy("balance_error") * e.largest, 1e-9 * e.largest);
}

TEST(Summary, anchors_say_what_they_held_and_whether_they_broke) {
  const io::Scene scene = io::parse_scene(k_shaken + k_straps, "s.toml");
  topple::Run run(scene.setup);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(run.advance().ok());
  const Json s = summary(scene, run, "interrupted", 0.5);
  ASSERT_EQ(s["anchors"].size(), 2u);
  const Json &weak = s["anchors"][0], &strong = s["anchors"][1];
  EXPECT_EQ(weak["name"], "weak");
  EXPECT_EQ(weak["body"], "free");
  EXPECT_EQ(weak["type"], "strap");
  EXPECT_EQ(weak["strength_N"], 1);
  EXPECT_EQ(weak["broke"], true);
  EXPECT_EQ(weak["in_place"], false);
  EXPECT_EQ(weak["peak_force_N"], run.outcome().anchors()[0].peak_force);  // also beyond the strength
  EXPECT_EQ(weak["final_force_N"], 0);
  EXPECT_EQ(weak["break_time_s"], *run.outcome().anchors()[0].broke);
  EXPECT_TRUE(strong["strength_N"].is_null());
  EXPECT_TRUE(strong["break_time_s"].is_null());
  EXPECT_EQ(strong["broke"], false);
  EXPECT_GT(strong["peak_force_N"], 1);
  EXPECT_EQ(s["energy"]["anchor_J"], run.state().energy.anchor);
  EXPECT_EQ(s["energy"]["released_J"], run.state().energy.released);
  const std::string table = summary_table(s);
  EXPECT_NE(table.find("anchor weak: greatest force"), std::string::npos) << table;
  EXPECT_NE(table.find("broke at"), std::string::npos) << table;
}

TEST_F(SummaryTest, what_does_not_exist_is_null) {
  Json s = summary(scene_, run_, "completed", 0);
  EXPECT_TRUE(s["realtime_factor"].is_null());
  EXPECT_TRUE(s["bodies"][0]["overturn_time_s"].is_null());
  EXPECT_TRUE(summary(scene_, run_, "completed", NAN)["wall_s"].is_null());
  s["bodies"][0]["peak_stress_Pa"] = nullptr;  // of a rigid body
  s["energy"]["balance_error"] = nullptr;
  EXPECT_NE(summary_table(s).find(" -\n"), std::string::npos);
}

TEST(Summary, contact_is_told_where_something_can_touch) {
  const auto told = [](const std::string& text) {
    const io::Scene scene = io::parse_scene(text, "s.toml", {"run.duration=10 ms"});
    topple::Run run(scene.setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    return summary_table(summary(scene, run, "completed", 1));
  };
  EXPECT_NE(told(k_shaken).find("\ncontact: coulomb, "), std::string::npos);
  EXPECT_EQ(told(k_beam).find("contact: "), std::string::npos) << told(k_beam);
}

TEST_F(SummaryTest, iterations_are_told_where_there_were_some) {
  Json s = summary(scene_, run_, "completed", 1);
  s["newton_iterations"] = 7;
  EXPECT_NE(summary_table(s).find(" rejected, 7 iterations\n"), std::string::npos) << summary_table(s);
  s["newton_iterations"] = 0;
  EXPECT_NE(summary_table(s).find(" rejected\n"), std::string::npos) << summary_table(s);
}

TEST_F(SummaryTest, bodies_that_were_computed_alike_share_a_line) {
  Json s = summary(scene_, run_, "completed", 0);
  Json body = s["bodies"][0];
  body["models"] = Json::array({{{"from_s", 0},
                                 {"model", "rigid"},
                                 {"reason", "it is asked for"},
                                 {"integrator", body["integrator"]},
                                 {"error_of", "motion"},
                                 {"error_estimate", 0.01}}});
  s["bodies"] = Json::array();
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    body["name"] = name;
    body["models"][0]["error_estimate"] = *name == 'b' ? 0.02 : 0.01;
    s["bodies"].push_back(body);
  }
  const std::string table = summary_table(s);
  EXPECT_NE(table.find("\na, c, d and 2 more: rigid from 0.000 s"), std::string::npos) << table;
  EXPECT_NE(table.find("\nb: rigid from 0.000 s"), std::string::npos) << table;
}

TEST_F(SummaryTest, a_run_that_goes_on_from_a_state_says_from_when_it_counts) {
  while (run_.time() < 0.05) ASSERT_TRUE(run_.advance().ok());
  topple::Run on(scene_.setup, run_.state(), run_.parameters());
  const Json s = summary(scene_, on, "completed", 0);
  EXPECT_EQ(s["counted_from_s"], run_.time());
  EXPECT_NE(s["warnings"].dump().find("counted from"), std::string::npos) << s["warnings"];
  EXPECT_FALSE(summary(scene_, run_, "completed", 0).contains("counted_from_s"));
}

TEST_F(SummaryTest, a_static_run_has_no_seconds) {
  Json s = summary(scene_, run_, "completed", 0);
  s["analysis"] = "static";
  s["static"] = Json::array();
  s["simulated_s"] = 1;
  Json& body = s["bodies"][0];
  body["overturned"] = true;
  body["overturn_time_s"] = 0.9958;
  body["final_tilt_deg"] = 8.3;
  const std::string table = summary_table(s);
  EXPECT_NE(table.find("of path   of path"), std::string::npos) << table;
  EXPECT_EQ(table.find("longer run"), std::string::npos) << table;
}

TEST_F(SummaryTest, of_loads_on_what_cannot_fall_no_tilt_is_told) {
  Json s = summary(scene_, run_, "completed", 0);
  s["analysis"] = "static";
  s["static"] = Json::array();
  EXPECT_NE(summary_table(s).find("peak tilt"), std::string::npos);
  s["bodies"][0]["critical_tilt_deg"] = nullptr;
  s["bodies"][0]["peak_stress_Pa"] = 354.97e6;
  const std::string table = summary_table(s);
  EXPECT_EQ(table.find("tilt"), std::string::npos) << table;
  EXPECT_EQ(table.find("overturned"), std::string::npos) << table;
  EXPECT_NE(table.find("peak stress\n"), std::string::npos) << table;
  EXPECT_NE(table.find("     354.97\n"), std::string::npos) << table;
}

TEST_F(SummaryTest, what_is_beyond_its_critical_angle_as_the_run_ends_may_come_back) {
  Json s = summary(scene_, run_, "completed", 0);
  s["simulated_s"] = 10;
  Json& body = s["bodies"][0];
  body["overturned"] = true;
  body["overturn_time_s"] = 9.993;
  body["final_tilt_deg"] = 11.67;
  EXPECT_NE(summary_table(s).find("beyond its critical angle for the last 0.007 s alone"), std::string::npos);
  body["overturn_time_s"] = 8.9;
  EXPECT_EQ(summary_table(s).find("for the last"), std::string::npos);
  body["overturn_time_s"] = 9.5;
  body["final_tilt_deg"] = 85;
  EXPECT_EQ(summary_table(s).find("for the last"), std::string::npos);
}

TEST_F(SummaryTest, what_a_slight_change_may_topple_is_told) {
  Json s = summary(scene_, run_, "completed", 0);
  s["simulated_s"] = 10;
  Json& body = s["bodies"][0];
  body["overturned"] = false;
  body["peak_critical_share"] = 0.79;
  EXPECT_EQ(summary_table(s).find("a slight change"), std::string::npos);
  body["peak_critical_share"] = 0.95;
  EXPECT_NE(summary_table(s).find(
                "free: came to 95 % of its critical angle, so that a slight change may topple it"),
            std::string::npos)
      << summary_table(s);
  body["overturned"] = true;
  body["peak_tilt_deg"] = body["final_tilt_deg"] = 90;
  body["overturn_time_s"] = 5.05;
  body["impact_times_s"] = Json::array();
  for (int k = 0; k < 10; ++k) body["impact_times_s"].push_back(0.5 * k);
  EXPECT_EQ(summary_table(s).find("a slight change"), std::string::npos);
  body["impact_times_s"].push_back(5.);
  body["impact_times_s"].push_back(6.);  // it lies
  EXPECT_NE(
      summary_table(s).find("free: overturned after 11 impacts, so that a slight change may keep it upright"),
      std::string::npos)
      << summary_table(s);
}

TEST_F(SummaryTest, a_stopper_that_is_not_in_place_is_told_so) {
  const Wedge away{"stop", 0};
  EXPECT_EQ(wedge_line(describe_wedge(scene_.setup.model, away)),
            "fixing stop: stopper of " + scene_.setup.model.bodies[0].name + ", not in place");
}

TEST_F(SummaryTest, models_that_come_again_and_again_are_told_once) {
  Json s = summary(scene_, run_, "completed", 0);
  Json& models = s["bodies"][0]["models"];
  models = Json::array();
  const auto add = [&](double from, const char* model, const char* reason, const Json& error) {
    models.push_back({{"from_s", from},
                      {"model", model},
                      {"reason", reason},
                      {"integrator", "central-difference"},
                      {"error_of", "stress"},
                      {"error_estimate", error}});
  };
  add(0, "elastic", "stresses are wanted", 1e-3);
  for (int k = 0; k < 3; ++k) {
    add(1 + k, "frame", "it strikes", nullptr);
    add(1.5 + k, "elastic", "calm again", k == 1 ? 4e-3 : 2e-3);
  }
  const std::string table = summary_table(s);
  EXPECT_NE(table.find("free: elastic from 0.000 s (stresses are wanted; "), std::string::npos) << table;
  EXPECT_NE(table.find("free: frame from 1.000 s, 3 times (it strikes)\n"), std::string::npos) << table;
  EXPECT_NE(table.find("free: elastic from 1.500 s, 3 times (calm again; "), std::string::npos) << table;
  EXPECT_NE(table.find("0.4 %"), std::string::npos) << table;
  EXPECT_EQ(table.find("frame from 2.000"), std::string::npos) << table;
}

TEST_F(SummaryTest, an_estimate_of_a_model_is_of_the_time_before_impacts) {
  Json s = summary(scene_, run_, "completed", 0);
  Json& body = s["bodies"][0];
  body["models"] = Json::array({{{"from_s", 0},
                                 {"model", "elastic"},
                                 {"reason", "it bends too much for a rigid body"},
                                 {"error_of", "motion"},
                                 {"error_estimate", 4e-4}}});
  body["impacts"] = 0;
  body["first_beyond_critical_s"] = 0.5;
  EXPECT_NE(
      summary_table(s).find("off from a frame by about 0.04 % until it lifts; leaning enlarges that)\n"),
      std::string::npos)
      << summary_table(s);
  body["models"][0]["error_estimate"] = 4e-9;  // its steps' errors are greater
  EXPECT_NE(summary_table(s).find("by less than 0.1 % until it lifts"), std::string::npos)
      << summary_table(s);
  body["models"][0]["error_estimate"] = 4e-4;
  body["impacts"] = 78;
  EXPECT_NE(summary_table(s).find("by about 0.04 % until it lifts; leaning and landing enlarge that)\n"),
            std::string::npos);
  body["peak_pinch_ratio"] = 0.3;
  EXPECT_NE(summary_table(s).find("until it lifts; leaning and knocks against other bodies enlarge that)\n"),
            std::string::npos);
  body["peak_pinch_ratio"] = 0;
  // that of stresses counts blows
  body["models"][0]["error_of"] = "stress";
  EXPECT_NE(summary_table(s).find(
                "; but for friction at its feet its stresses are off from a frame's by about 0.04 %)\n"),
            std::string::npos);
  body["models"][0]["error_estimate"] = 1;
  EXPECT_NE(summary_table(s).find("; what its blows do to its stresses is not known)\n"), std::string::npos);
  body["models"][0]["error_estimate"] = 4e-4;
  body["models"][0]["error_of"] = "motion";
  // contacts that stand for a hard floor give, of which the estimate of a block knows nothing
  body["models"][0]["model"] = "planar";
  s["contact"]["stands_for_hard_floor"] = true;
  EXPECT_NE(summary_table(s).find("; not counting how far its contacts give way, it is off from a frame by "
                                  "about 0.04 % until it lands"),
            std::string::npos)
      << summary_table(s);
  s["contact"]["stands_for_hard_floor"] = false;
  EXPECT_EQ(summary_table(s).find("contacts give way"), std::string::npos);
  // it has fallen before it becomes that
  body["overturn_time_s"] = 2;
  body["models"][0]["from_s"] = 2.5;
  EXPECT_EQ(summary_table(s).find("off from a frame"), std::string::npos) << summary_table(s);
}

TEST(Terms, a_share_of_a_strength_is_rounded_and_never_whole_before_it_is) {
  EXPECT_EQ(percent_of(1659, 2000), "83 %");
  EXPECT_EQ(percent_of(178, 20000), "0.9 %");
  EXPECT_EQ(percent_of(0, 20000), "0 %");
  EXPECT_EQ(percent_of(1999, 2000), ">99 %");
  EXPECT_EQ(percent_of(2000, 2000), "100 %");
}

TEST_F(SummaryTest, an_error_of_time_integration_that_is_the_least_one_is_an_upper_bound) {
  Json s = summary(scene_, run_, "completed", 0);
  s["error_estimate"] = error_estimate(scene_.setup, run_.outcome(), run_.outcome());
  EXPECT_NE(summary_table(s).find("peak tilt less than 0.00057 deg, base moved less than 0.1 mm"),
            std::string::npos)
      << summary_table(s);
  s["error_estimate"]["bodies"][0]["peak_tilt_deg"] = 0.0006;
  EXPECT_NE(summary_table(s).find("peak tilt 0.0006 deg, "), std::string::npos);
}

TEST(Summary, the_stated_error_of_what_an_anchor_bore_stands_beside_its_force) {
  const io::Scene scene = io::parse_scene(k_shaken + k_straps, "s.toml", {"anchor.weak.on=false"});
  const auto ended = [](const topple::Setup& setup) {
    topple::Run run(setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    return run;
  };
  topple::Run run = ended(scene.setup), finer = ended(study::compared(scene.setup));
  Json s = summary(scene, run, "completed", 1);
  EXPECT_EQ(summary_table(s).find(" ± "), std::string::npos);
  s["error_estimate"] = error_estimate(scene.setup, run.outcome(), finer.outcome());
  const Json& errors = s["error_estimate"]["anchors"];
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0]["name"], "weak");
  EXPECT_TRUE(errors[0]["peak_force_N"].is_null());
  const double force = run.outcome().anchors()[1].peak_force, other = finer.outcome().anchors()[1].peak_force;
  const double stated = std::max(2 * std::abs(force - other), 5e-4 * force);
  EXPECT_DOUBLE_EQ(errors[1]["peak_force_N"].get<double>(), stated);
  EXPECT_NE(
      summary_table(s).find(fmt::format("anchor strong: greatest force {:.4g} ± {:.2g} N", force, stated)),
      std::string::npos)
      << summary_table(s);
}

TEST_F(SummaryTest, of_a_run_that_ended_early_the_table_says_until_when) {
  while (!run_.over()) ASSERT_TRUE(run_.advance().ok());
  const auto table = [&](const char* status) {
    Json s = summary(scene_, run_, status, 1);
    s["simulated_s"] = 5.46;
    return summary_table(s);
  };
  EXPECT_EQ(table("completed").find("until"), std::string::npos) << table("completed");
  for (const auto& [status, words] :
       {std::pair("stopped", "where the run stopped"), std::pair("diverged", "where the run diverged"),
        std::pair("interrupted", "where the run was interrupted")}) {
    const std::size_t told = table(status).find(std::string("all that follows is until 5.46 s, ") + words);
    EXPECT_LT(told, table(status).find("\nbody ")) << table(status);
  }
}

TEST(Summary, advice_on_steps_is_what_changes_them) {
  const auto is_advised = [](const std::string& words, std::vector<std::string> changes) {
    const io::Scene scene = io::parse_scene(k_shaken, "s.toml", changes);
    topple::Run begun(scene.setup);
    EXPECT_TRUE(begun.advance().ok());
    State state = begun.state();
    state.energy.numerical = state.energy.largest = 1;  // J
    topple::Run run(scene.setup, state, begun.parameters());
    const Json warnings = summary(scene, run, "stopped", 1)["warnings"];
    EXPECT_NE(warnings.dump().find("the time integration took"), std::string::npos) << warnings;
    return std::ranges::any_of(warnings, [&](const Json& warning) {
      return warning.get<std::string>().find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(is_advised("try time_step = \"auto\" or a smaller one", {}));
  EXPECT_TRUE(is_advised("try a smaller tolerance", {"run.time_step=auto"}));
  // its steps follow its limit alone: the run has as many at every tolerance
  EXPECT_TRUE(is_advised("try a fixed time_step below the mean one",
                         {"run.time_step=auto", "run.integrator=central-difference"}));
}

TEST_F(SummaryTest, an_estimate_without_a_verdict_is_words_and_no_number) {
  io::Scene strong =
      io::parse_scene(k_shaken, "s.toml", {"shake.table.amplitude=900 gal", "run.duration=2 s"});
  strong.setup.run.duration = 2;
  topple::Run falls(strong.setup);
  while (!falls.over()) ASSERT_TRUE(falls.advance().ok());
  ASSERT_TRUE(falls.outcome().bodies()[0].beyond_since);
  Json s = summary(scene_, run_, "completed", 0.5);
  s["error_estimate"] = error_estimate(scene_.setup, run_.outcome(), falls.outcome());
  const Json& e = s["error_estimate"];
  for (const char* key : {"overturn_time_s", "peak_tilt_deg", "peak_slide_m", "peak_stress_Pa"})
    EXPECT_TRUE(e[key].is_null() && e["bodies"][0][key].is_null()) << key;
  ASSERT_EQ(e["disagreements"].size(), 1u);
  const std::string words = e["disagreements"][0];
  EXPECT_TRUE(words.starts_with("free does not overturn, but at ")) << words;
  EXPECT_NE(summary_table(s).find(
                "error of the time integration (step and its parts halved): the verdict itself is open: " +
                words + "\n"),
            std::string::npos);
  EXPECT_EQ(error_estimate(scene_.setup, falls.outcome(), run_.outcome())["disagreements"][0]
                .get<std::string>()
                .find("free overturns at "),
            0u);
}

TEST_F(SummaryTest, bodies_that_may_meet_have_a_speed_up_to_which_no_step_is_cut) {
  EXPECT_TRUE(summary(scene_, run_, "completed", 1)["safe_closing_speed_m_s"].is_null());
  const io::Scene two = io::load_scene("paper-a");
  topple::Run run(two.setup);
  double thinnest = 1e300;
  for (const Member& member : two.setup.model.members)
    thinnest = std::min(thinnest, two.setup.model.sections[member.section].width);
  EXPECT_DOUBLE_EQ(summary(two, run, "completed", 1)["safe_closing_speed_m_s"], thinnest / 2 / 1e-3);
}

TEST(Summary, a_step_longer_than_the_samples_of_a_record_is_told) {
  const auto warnings = [](const char* step) {
    const io::Scene scene = io::load_scene("near-fault", {step});
    topple::Run run(scene.setup);
    EXPECT_TRUE(run.advance().ok());
    return summary(scene, run, "stopped", 0.5)["warnings"].dump();
  };
  EXPECT_NE(warnings("run.time_step=25 ms").find("time_step 25 ms is longer than the 10 ms"),
            std::string::npos)
      << warnings("run.time_step=25 ms");
  EXPECT_EQ(warnings("run.time_step=10 ms").find("time_step"), std::string::npos);
  EXPECT_EQ(warnings("run.time_step=auto").find("time_step"), std::string::npos);
}

TEST(Summary, what_no_material_and_no_floor_does_is_told) {
  const auto warnings = [](const char* scene_name, std::vector<std::string> changes) {
    const io::Scene scene = io::load_scene(scene_name, changes);
    topple::Run run(scene.setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    return summary(scene, run, "completed", 0.5)["warnings"].dump();
  };
  // it lands at 4.4 s with more than 1 % of Young's modulus
  const std::string landed =
      warnings("near-fault", {"run.duration=5 s", "cabinet.1.base=edges", "run.want=[\"stress\"]"});
  EXPECT_NE(landed.find("the stress in body \\\"free\\\", "), std::string::npos) << landed;
  EXPECT_NE(landed.find("\\\"steel\\\" has no `yield`"), std::string::npos) << landed;
  EXPECT_NE(landed.find("here 2050 MPa"), std::string::npos) << landed;  // of 205 GPa
  EXPECT_EQ(warnings("near-fault", {"run.duration=1 s"}), "[]");
  const std::string bare = warnings("paper-a", {"shake.1.amplitude=190", "run.duration=10 ms"});
  EXPECT_NE(bare.find("shake 1 has 1.9e+04 gal, 19.4 times gravity; a number without a unit is in m/s^2"),
            std::string::npos)
      << bare;
}

TEST(Summary, the_method_of_what_was_computed_is_named) {
  const auto head = [](const char* model) {
    const io::Scene scene = io::load_scene("paper-a", {"cabinet.free.model=" + std::string(model),
                                                       "cabinet.walled.model=rigid", "run.duration=10 ms"});
    topple::Run run(scene.setup);
    return summary_table(summary(scene, run, "completed", 0.5));
  };
  EXPECT_NE(head("rigid").find("\ncentral differences, TR-BDF2 on stiff contacts, step 0.001 s"),
            std::string::npos)
      << head("rigid");
  EXPECT_NE(head("frame").find(
                "\ngeneralized-alpha (frames), central differences, TR-BDF2 on stiff contacts, step"),
            std::string::npos)
      << head("frame");
}

TEST(Summary, each_body_says_what_moved_it_and_from_which_angle_uplift_counts) {
  const io::Scene scene = io::load_scene(
      "paper-a", {"cabinet.free.model=elastic", "cabinet.walled.model=frame", "run.duration=10 ms"});
  topple::Run run(scene.setup);
  const auto s = summary(scene, run, "completed", 0.5);
  EXPECT_EQ(s["bodies"][0]["integrator"], "central-difference");
  EXPECT_EQ(s["bodies"][1]["integrator"], "generalized-alpha");
  EXPECT_EQ(s["integrator"], "central-difference, generalized-alpha");
  EXPECT_DOUBLE_EQ(s["uplift_threshold_deg"], 0.05);
}

TEST_F(SummaryTest, the_table_has_a_line_for_each_body_and_probe) {
  const std::string table = summary_table(summary(scene_, run_, "completed", 0.5));
  EXPECT_NE(table.find("\nfree "), std::string::npos) << table;
  EXPECT_NE(table.find("\nprobe middle: "), std::string::npos) << table;
}

TEST_F(SummaryTest, plastic_energy_is_told_where_steel_flowed) {
  Json s = summary(scene_, run_, "completed", 0.5);
  EXPECT_EQ(summary_table(s).find("plastic"), std::string::npos);
  s["energy"]["plastic_J"] = 12.5;
  EXPECT_NE(summary_table(s).find("J dissipated (12.5 J of it by plastic flow), balance error"),
            std::string::npos);
}

TEST_F(SummaryTest, what_the_stress_of_a_section_that_flows_is_stands_beside_its_hinges) {
  Json s = summary(scene_, run_, "completed", 0.5);
  EXPECT_EQ(summary_table(s).find("N/A + M/W"), std::string::npos);
  s["bodies"][0]["hinges"] = 2;
  EXPECT_NE(summary_table(s).find("free: 2 plastic hinges (where a section flows its stress is told as if "
                                  "elastic, N/A + M/W, and may be above yield)\n"),
            std::string::npos)
      << summary_table(s);
  s["bodies"][0]["peak_stress_Pa"] = nullptr;
  EXPECT_NE(summary_table(s).find("free: 2 plastic hinges\n"), std::string::npos);
}

TEST_F(SummaryTest, columns_stay_in_line_under_long_names) {
  Json s = summary(scene_, run_, "completed", 0.5);
  s["bodies"][0]["name"] = "a cabinet with a grown-up näme";
  s["probes"] = Json::array();
  const std::string table = summary_table(s), header = table.substr(table.find("\nbody") + 1);
  const std::string row = header.substr(header.find("a cabinet"));
  EXPECT_EQ(header.find('\n') + 1, row.find('\n')) << table;  // one byte more for the umlaut
}

TEST_F(SummaryTest, text_that_is_not_utf_8_does_not_spoil_the_json) {
  scene_.name = "a\xff";
  const std::string text = json_text(summary(scene_, run_, "completed", 1), 2);
  EXPECT_EQ(Json::parse(text)["scene"], "a\xef\xbf\xbd");
}

TEST(Summary, says_who_gets_out_before_and_after) {
  const auto ways_past = [](const char* gap) {
    // two solid pieces across a room of 4 m by 2 m; their surfaces lie 10 mm outside
    const std::string text = std::string("topple = 1\n[run]\nduration = 0.02\n[floor]\n") +
                             "[[wall]]\nname = \"right\"\nat = [0, -1]\nnormal = [0, 1, 0]\n"
                             "[[wall]]\nname = \"left\"\nat = [0, 1]\nnormal = [0, -1, 0]\n"
                             "[[wall]]\nname = \"front\"\nat = [2, 0]\nnormal = [-1, 0, 0]\n"
                             "[[block]]\nname = \"a\"\nsize = [0.3, 0.7, 0.5]\nmass = 30\nwidth = 0.02\n"
                             "at = [0, -0.6]\n[[block]]\nname = \"b\"\nsize = [0.3, 0.7, 0.5]\nmass = 30\n"
                             "width = 0.02\nat = [0, " +
                             gap +
                             "]\n[[door]]\nname = \"door\"\nwall = \"front\"\nat = 0\nwidth = 0.8\n"
                             "[[place]]\nname = \"desk\"\nat = [-1, 0]\n";
    const io::Scene scene = io::parse_scene(text, "s.toml");
    topple::Run run(scene.setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    return summary(scene, run, "completed", 1);
  };
  // a ends at -0.24, b begins 0.36 before its middle
  const Json open = ways_past("0.63"), closed = ways_past("0.61");
  EXPECT_EQ(open["ways"][0]["open"], true);
  EXPECT_NEAR(open["ways"][0]["widest_m"].get<double>(), 0.51, 1e-5);  // blocks settle by less
  EXPECT_NEAR(open["ways"][0]["length_m"].get<double>(), 3, 1e-3);
  EXPECT_EQ(closed["ways"][0]["open"], false);
  EXPECT_NEAR(closed["ways"][0]["before"]["widest_m"].get<double>(), 0.49, 1e-12);
  EXPECT_EQ(closed["ways"][0]["length_m"], nullptr);
  EXPECT_EQ(closed["ways"][0]["blocked_by"], (Json{"a", "b"}));
  EXPECT_NE(
      summary_table(closed).find("place desk: no way to door for a person of 0.5 m, 0.490 m left, blocked "
                                 "by a, b, as before the shake\n"),
      std::string::npos)
      << summary_table(closed);
  EXPECT_NE(summary_table(open).find("place desk: way to door open, widest 0.51 m, shortest 3.0 m long\n"),
            std::string::npos)
      << summary_table(open);
}

TEST(Ways, what_was_closed_before_is_told_as_the_same_where_it_is) {
  Json way{{"place", "desk"},         {"door", "door"},
           {"open", false},           {"widest_m", 0.45},
           {"caught", false},         {"blocked_by", {"a"}},
           {"hit_by", Json::array()}, {"before", {{"open", false}, {"widest_m", 0.45}, {"caught", false}}}};
  EXPECT_NE(ways_in_words(Json{way}, 0.5).find(", as before the shake"), std::string::npos);
  way["caught"] = true;
  way["widest_m"] = 0.;
  EXPECT_EQ(ways_in_words(Json{way}, 0.5),
            "place desk: cannot leave, blocked where they are by a, closed before the shake, too\n");
}

TEST(Letters, a_letter_of_several_bytes_is_one_and_so_is_a_byte_that_is_none) {
  EXPECT_EQ(letters(""), 0u);
  EXPECT_EQ(letters("caf\xc3\xa9"), 4u);
  EXPECT_EQ(letters("\xe6\x9c\xac\xe6\xa3\x9a"), 2u);
  EXPECT_EQ(letters("a\xff.toml"), 7u);
}

}  // namespace
}  // namespace topple::app
