// Static runs and natural modes from the command line.
#include "program.h"
#include "scenes.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

class AnalysisTest : public ProgramTest {
 protected:
  // A post of 30 mm under a tip load in N.
  static std::string loaded(double force, const std::string& run = "") {
    return "topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\n" + run + k_library + R"(
[[frame]]
name = "beam"
nodes = [[0, 0, 0], [0, 0, 1]]
members = [{ nodes = [0, 1], section = "post", material = "steel", elements = 8 }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = [0, 0, )" +
           std::to_string(force) + "] }]\n";
  }
};

TEST_F(AnalysisTest, static_run_reports_and_records_each_load_step) {
  write_bytes("push.toml", loaded(-1e3, "load_steps = 4\n"));
  const Ended ended = topple({"run", "push.toml", "-o", "push.h5", "--json", "-", "--quiet"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json s = Json::parse(ended.out);
  EXPECT_EQ(s["status"], "completed");
  ASSERT_EQ(s["static"].size(), 4u);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(s["static"][k]["factor"], (k + 1) / 4.);
    EXPECT_EQ(s["static"][k]["converged"], true);
  }
  const Json r = Json::parse(topple({"info", "push.h5", "--json", "-"}).out);
  EXPECT_EQ(r["frames"], 5);  // the unloaded one first
}

TEST_F(AnalysisTest, static_run_without_equilibrium_fails_and_keeps_what_converged) {
  write_bytes("pull.toml", loaded(-1e5));  // far beyond Euler's load, 8.2 kN
  const Ended ended = topple({"run", "pull.toml", "-o", "pull.h5", "--json", "-", "--quiet"});
  EXPECT_EQ(ended.code, 1);
  const Json s = Json::parse(ended.out);
  EXPECT_EQ(s["status"], "diverged");
  ASSERT_FALSE(s["static"].empty());
  EXPECT_EQ(s["static"].back()["converged"], false);
  for (const char* part : {"body \"beam\"", "element ", "load factor ", "pull.h5 holds everything"})
    EXPECT_NE(ended.err.find(part), std::string::npos) << ended.err;
  EXPECT_EQ(topple({"info", "pull.h5"}).code, 0);
}

TEST_F(AnalysisTest, modes_of_a_free_cabinet_begin_with_six_rigid_ones) {
  write_bytes("s.toml", k_shaken);
  const Ended ended = topple({"modes", "s.toml", "--count", "8", "--json", "-"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json body = Json::parse(ended.out)["bodies"][0];
  ASSERT_EQ(body["modes"].size(), 8u);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(body["modes"][k]["frequency_Hz"] == 0, k < 6);
  EXPECT_NE(topple({"modes", "s.toml"}).out.find("rigid"), std::string::npos);
  expect_one_line({"modes", "s.toml", "--count", "0"}, 2, "--count: \"0\" is not a whole number in 1..1000");
}

TEST_F(AnalysisTest, scene_that_asks_for_modes_is_not_recorded) {
  write_bytes("s.toml", loaded(0));
  expect_one_line({"run", "s.toml", "--set", "run.analysis=modes", "-o", "a.h5"}, 2,
                  "modes are not recorded");
  EXPECT_EQ(topple({"run", "s.toml", "--set", "run.analysis=modes"}).code, 0);
}

TEST_F(AnalysisTest, adaptive_and_newmark_runs_say_so) {
  write_bytes("beam.toml", k_beam);
  const Ended automatic = topple({"run", "beam.toml", "--set", "run.time_step=auto", "--json", "-"});
  ASSERT_EQ(automatic.code, 0) << automatic.err;
  EXPECT_EQ(Json::parse(automatic.out)["adaptive"], true);
  const Ended newmark = topple({"run", "beam.toml", "--set", "run.integrator=newmark", "--json", "-"});
  EXPECT_EQ(Json::parse(newmark.out)["integrator"], "newmark");
  const Ended explicit_run = topple({"run", "beam.toml", "--set", "run.integrator=central-difference",
                                     "--set", "run.time_step=auto", "--json", "-"});
  const Json s = Json::parse(explicit_run.out);
  EXPECT_NEAR(s["time_step_s"], 0.9 * s["explicit_limit_s"].get<double>(),
              0.01 * s["explicit_limit_s"].get<double>());  // the last step is a part of one
}

}  // namespace
}  // namespace topple::app
