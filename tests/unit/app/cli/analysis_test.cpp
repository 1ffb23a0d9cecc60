// Static runs and natural modes from the command line.
#include <fmt/format.h>

#include "unit/app/program.h"
#include "unit/app/scenes.h"

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
  EXPECT_NE(topple({"run", "push.toml", "--quiet"}).out.find("load factor 0.25 to 1 in 4 steps: converged\n"),
            std::string::npos);
}

TEST_F(AnalysisTest, static_run_that_is_to_end_at_an_instability_ends_there_and_keeps_what_converged) {
  write_bytes("pull.toml", loaded(-1e5, "stop_at = \"instability\"\n"));  // far beyond Euler's load, 8.2 kN
  const Ended ended = topple({"run", "pull.toml", "-o", "pull.h5", "--json", "s.json", "--quiet"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const Json s = Json::parse(bytes_of("s.json"));
  EXPECT_EQ(s["status"], "stopped");
  ASSERT_FALSE(s["static"].empty());
  EXPECT_EQ(s["static"].back()["converged"], false);
  EXPECT_EQ(s["static"].back()["loss"], "buckling");
  EXPECT_NE(ended.out.find("not stable, the path ends"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.err.find("diverged"), std::string::npos) << ended.err;
  EXPECT_EQ(topple({"info", "pull.h5", "--verify"}).code, 0);
}

TEST_F(AnalysisTest, static_run_that_goes_on_tells_what_is_not_stable_and_warns_of_it) {
  write_bytes("pull.toml", loaded(-1e5));
  const Ended ended = topple({"run", "pull.toml", "--json", "-", "--quiet"});
  EXPECT_EQ(ended.code, 0);
  const Json s = Json::parse(ended.out);
  EXPECT_EQ(s["static"].front()["stable"], false);  // 10 kN
  EXPECT_EQ(s["static"].front()["loss"], "buckling");
  EXPECT_GE(s["static"].front()["negative_pivots"], 1);
  EXPECT_NE(ended.err.find("from load factor 0.1 on the equilibrium is not stable"), std::string::npos)
      << ended.err;
}

// 26.3 kN is Euler's load of a bar of 40 x 10 mm between clamped ends 1 m apart: a half wave of 0.5 m.
TEST_F(AnalysisTest, a_column_of_too_few_elements_to_buckle_is_told) {
  const auto told = [&](const char* elements, const char* force) {
    write_bytes("column.toml",
                std::string("topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\n") + R"(
[[material]]
name = "steel"
young = "200 GPa"
poisson = 0.3
density = "7850 kg/m^3"
[[section]]
name = "bar"
shape = "solid"
size = ["40 mm", "10 mm"]
[[frame]]
name = "column"
nodes = [[0, 0, 0], [0, 0, 1]]
supports = [{ node = 0, fix = "xyzXYZ" }, { node = 1, fix = "xyXYZ" }]
members = [{ nodes = [0, 1], section = "bar", material = "steel", elements = )" +
                    elements + " }]\nloads = [{ node = 1, force = [0, 0, " + force + "] }]\n");
    return topple({"run", "column.toml", "--quiet"}).err;
  };
  const std::string half = told("2", "-26300");
  EXPECT_NE(half.find("member \"member-0\" of \"column\" bears 26.3 kN on 2 elements, 1.0 in a half wave"),
            std::string::npos)
      << half;
  EXPECT_NE(half.find("elements = 16 is"), std::string::npos) << half;
  EXPECT_EQ(told("16", "-26300").find("half wave"), std::string::npos);
  EXPECT_EQ(told("2", "26300").find("half wave"), std::string::npos);  // pulled
  EXPECT_EQ(told("2", "-700").find("half wave"), std::string::npos);   // 6.1 elements
}

// The tip of a mast of 1 m is drawn aside: a hinge bends at its foot, until the mast would have to be longer.
TEST_F(AnalysisTest, a_path_beyond_the_reach_of_what_yields_is_told) {
  const auto told = [&](const char* to) {
    write_bytes("mast.toml",
                std::string("topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\n") +
                    "load_steps = 40\ncontrol = { body = \"mast\", node = 1, dof = \"x\", to = " + to +
                    R"( }
[[material]]
name = "steel"
young = "205 GPa"
poisson = 0.3
density = "7850 kg/m^3"
yield = "235 MPa"
[[section]]
name = "bar"
shape = "solid"
size = ["20 mm", "20 mm"]
[[frame]]
name = "mast"
nodes = [[0, 0, 0], [0, 0, 1]]
members = [{ nodes = [0, 1], section = "bar", material = "steel", elements = 4, up = [1, 0, 0] }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = [100, 0, 0] }]
)");
    return topple({"run", "mast.toml", "--quiet"}).err;
  };
  const std::string beyond = told("1.5");
  EXPECT_NE(beyond.find("element 0 of member \"member-0\" of \"mast\" became"), std::string::npos) << beyond;
  EXPECT_NE(beyond.find("% longer, which no steel does"), std::string::npos) << beyond;
  EXPECT_EQ(told("0.8").find("longer"), std::string::npos);
}

// When its weaker column breaks, hinges of a portal unload; the other column carries Mp/h = 812 N alone, and
// 4 % more where it leans by 300 mm and is 954 mm high. At whatever load step it broke.
TEST_F(AnalysisTest, a_portal_goes_on_when_a_column_breaks_whatever_its_steps_are) {
  const auto material = [](const char* name, const char* more) {
    return "[[material]]\nname = \"" + std::string(name) +
           "\"\nyoung = \"205 GPa\"\npoisson = 0.3\ndensity = 7850\nyield = \"235 MPa\"\n" + more;
  };
  for (const char* steps : {"20", "40", "100", "200"}) {
    write_bytes("portal.toml",
                "topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\nload_steps = " +
                    std::string(steps) + "\ncontrol = { node = 1, dof = \"x\", to = \"300 mm\" }\n" +
                    material("tough", "") + material("brittle", "fracture_strain = 0.003\n") + R"(
[[frame]]
name = "portal"
nodes = [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "solid 24", material = "tough", up = [1, 0, 0] },
           { nodes = [1, 2], section = "solid 20", material = "tough" },
           { nodes = [2, 3], section = "solid 20", material = "brittle", up = [1, 0, 0] }]
supports = [{ node = 0, fix = "xyzXYZ" }, { node = 3, fix = "xyzXYZ" }, { node = 1, fix = "yXZ" }, { node = 2, fix = "yXZ" }]
loads = [{ node = 1, force = [100, 0, 0] }]
)");
    const Ended ended = topple({"run", "portal.toml", "--json", "-", "--quiet"});
    ASSERT_EQ(ended.code, 0) << steps << ended.err;
    const Json s = Json::parse(ended.out);
    EXPECT_EQ(s["bodies"][0]["fractures"], 1);
    EXPECT_NEAR(s["static"].back()["factor"].get<double>(), 8.451, 1e-3) << steps;
  }
}

class FailureTest : public AnalysisTest {
 protected:
  /// An arm of steel that yields at 235 MPa, its first node held in `fix`, `mass` at the other.
  static std::string arm(const std::string& run, const std::string& fix, const std::string& mass) {
    std::string library = k_library;
    library.insert(library.find("[[section]]"), "yield = \"235 MPa\"\n");
    return "topple = 1\n[run]\n" + run + library + R"(
[[frame]]
name = "arm"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "post", material = "steel" }]
supports = [{ node = 0, fix = ")" +
           fix + "\" }]\nmasses = [{ node = 1, mass = \"" + mass +
           "\" }]\nloads = [{ node = 1, force = [0, 0, -10] }]\n";
  }
  /// Fails with exit 1, says `parts`, and leaves an older recording alone.
  void expect_no_start(const std::string& scene, const std::vector<std::string>& parts) {
    write_bytes("arm.toml", scene);
    write_bytes("a.h5", k_older_recording);
    const Ended ended = topple({"run", "arm.toml", "-o", "a.h5", "--json", "-", "--quiet"});
    EXPECT_EQ(ended.code, 1) << ended.err;
    for (const std::string& part : parts) EXPECT_NE(ended.err.find(part), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("body \"arm\", member \"member-0\" (element "), std::string::npos) << ended.err;
    EXPECT_EQ(Json::parse(ended.out)["status"], "diverged");
    EXPECT_EQ(bytes_of("a.h5"), k_older_recording);
  }
};

TEST_F(FailureTest, yield_stress_of_zero_is_bad_input) {
  for (const char* zero : {"yield = 0", "yield = \"0 MPa\""}) {
    std::string text = arm("duration = 0.1\n", "xyzXYZ", "1 kg");
    text.replace(text.find("yield = \"235 MPa\""), 17, zero);
    write_bytes("arm.toml", text);
    expect_one_line({"run", "arm.toml"}, 2, "material.steel.yield: ");
    expect_one_line({"check", "arm.toml"}, 2, " is outside 1e-06..1e+07 MPa");
  }
}

TEST_F(FailureTest, a_mechanism_in_a_static_run_is_told) {
  expect_no_start(arm("analysis = \"static\"\ngravity = [0, 0, 0]\n", "xyz", "1 kg"),
                  {"is a mechanism before it carries anything: a part may be free to move"});
  expect_no_start(arm("analysis = \"static\"\n", "xyz", "1 kg"),
                  {"before the first step, at 0 s", "does not come to rest under gravity"});
}

// A load on the middle of the beam, where two members of one section meet and flow at once. Its peak is that
// of the path by displacement, whose steps of 2 mm miss it by 0.3 %.
TEST_F(FailureTest, a_portal_comes_to_its_collapse_load_by_loads_as_by_displacement) {
  const auto portal = [](const std::string& run, const std::string& force) {
    return "topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\nload_steps = 50\n" + run + R"(
[[section]]
name = "col"
shape = "solid"
size = ["40 mm", "40 mm"]
[[section]]
name = "beam"
shape = "solid"
size = ["30 mm", "30 mm"]
[[frame]]
name = "p"
nodes = [[0, 0, 0], [0, 0, 1.2], [1, 0, 1.2], [2, 0, 1.2], [2, 0, 0]]
members = [{ nodes = [0, 1], section = "col", material = "steel" }, { nodes = [1, 2], section = "beam", material = "steel" },
           { nodes = [2, 3], section = "beam", material = "steel" }, { nodes = [3, 4], section = "col", material = "steel" }]
supports = [{ node = 0, fix = "xyzXYZ" }, { node = 4, fix = "xyzXYZ" }, { node = 1, fix = "yXZ" },
            { node = 2, fix = "yXZ" }, { node = 3, fix = "yXZ" }]
loads = [{ node = 1, force = [)" +
           force + ", 0, 0] }, { node = 2, force = [0, 0, -" + force + "] }]\n";
  };
  write_bytes("loads.toml", portal("", "6500"));
  write_bytes("way.toml",
              portal("control = { body = \"p\", node = 1, dof = \"x\", to = \"100 mm\" }", "6500"));
  double most[2] = {0, 0};
  for (int k = 0; k < 2; ++k) {
    const Ended ended = topple({"run", k == 0 ? "loads.toml" : "way.toml", "--json", "-", "--quiet"});
    EXPECT_EQ(ended.code, k == 0 ? 1 : 0) << ended.err;
    const Json summary = Json::parse(ended.out);
    for (const auto& step : summary["static"])
      if (step["converged"]) most[k] = std::max(most[k], step["factor"].get<double>());
  }
  EXPECT_GT(most[1], 0.87);
  EXPECT_NEAR(most[0], most[1], 5e-3 * most[1]);
}

// Held in all directions but that of its load.
TEST_F(FailureTest, a_frame_that_nothing_holds_is_told_to_be_free) {
  std::string slides = arm("analysis = \"static\"\ngravity = [0, 0, 0]\n", "yzXYZ", "1 kg");
  slides.replace(slides.find("[0, 0, -10]"), 11, "[10, 0, 0]");
  expect_no_start(slides, {"is a mechanism before it carries anything: a part may be free to move"});
}

TEST_F(FailureTest, a_section_that_breaks_under_loads_that_stay_is_told) {
  const Ended ended = topple({"run", "portal-pushover", "--json", "-", "--quiet", "--set",
                              "material.steel.fracture_strain=1e-3", "--set",
                              "run={ analysis = \"static\", gravity = [0, 0, 0], load_steps = 40 }", "--set",
                              "frame.portal.loads=[{ node = 1, force = [1900, 0, 0] }]"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.err.find("member \"member-0\" (element 0) breaks there, and what is left does not carry"),
            std::string::npos)
      << ended.err;
  EXPECT_EQ(Json::parse(ended.out)["static"].back()["loss"], "fracture");
}

TEST_F(FailureTest, a_scene_that_collapses_under_its_own_weight_is_told) {
  expect_no_start(arm("analysis = \"static\"\n", "xyzXYZ", "100 kg"),
                  {"before the first step, at 0 s", "can alpha and the steel carry it"});
  expect_no_start(arm("duration = 0.1\n", "xyzXYZ", "100 kg"),
                  {"before the first step, at 0 s", "does not come to rest under gravity"});
}

// A moment that is greater than what a post of lead bears winds it up until it tears.
TEST_F(FailureTest, an_element_that_winds_up_tears_and_the_run_goes_on) {
  write_bytes("post.toml", R"(topple = 1
[run]
duration = 2
time_step = "auto"
gravity = [0, 0, 0]
settle = false
[[material]]
name = "lead"
young = "16 GPa"
poisson = 0.44
density = 11340
yield = "1 MPa"
[[section]]
name = "bar"
shape = "solid"
size = ["20 mm", "20 mm"]
[[frame]]
name = "post"
nodes = [[0, 0, 0], [0, 0, 1]]
members = [{ nodes = [0, 1], section = "bar", material = "lead" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
masses = [{ node = 1, mass = 1, inertia = [1, 1, 1] }]
loads = [{ node = 1, moment = [0, 5, 0] }]
)");
  for (const char* set : {"run.time_step=auto", "run.time_step=1e-3", "material.lead.fracture_strain=0.05"}) {
    const Ended tears = topple({"run", "post.toml", "--quiet", "--set", set});
    EXPECT_EQ(tears.code, 0) << tears.err;
    EXPECT_NE(tears.out.find(" broken section"), std::string::npos) << tears.out;
  }
}

// It falls for 0.1 s before it meets the floor; sixty-four parts of a step of 50 ms are still too long there.
TEST_F(FailureTest, a_step_far_too_long_is_told_and_what_converged_stays_readable) {
  const Ended ended = topple({"run", TOPPLE_SOURCE_DIR "/assets/scenes/failures/fast-impact.toml", "--set",
                              "cabinet.cabinet.at=[0, 0, 1]", "-o", "a.h5", "--json", "-", "--quiet"});
  EXPECT_EQ(ended.code, 1);
  const std::string message = Json::parse(ended.out)["message"];
  for (const char* part :
       {"more than a tenth of the energy is unaccounted for after the step at 0.096",
        " s, which is not taken: body \"cabinet\", member \"", "(element ", "try a smaller time_step"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_NE(ended.err.find("a.h5 holds everything up to 0.05 s"), std::string::npos) << ended.err;
  EXPECT_EQ(topple({"info", "a.h5", "--verify"}).code, 0);
}

// A contact that passes from one member to another at 2.343 s leaves 0.025 J unexplained, 1.13 times what the
// tolerance allows, in a step of any size.
TEST_F(FailureTest, a_jump_of_energy_that_no_step_resolves_ends_no_run) {
  write_bytes("row.toml",
              "topple = 1\nfloor = {}\nrun = { duration = 4 }\ncontact = { friction = 0.5 }\n"
              "shake = [{ type = \"sine\", frequency = 0.8, amplitude = 3.5 }]\n"
              "section = [{ name = \"post\", shape = \"box\", size = [0.03, 0.03], thickness = 0.001 }]\n"
              "material = [{ name = \"brittle\", young = \"205 GPa\", poisson = 0.3, density = 7850, "
              "yield = \"235 MPa\", fracture_strain = 0.01 }]\n"
              "cabinet = [{ name = \"low\", size = [0.38, 0.88, 1.3], mass = 60, material = \"brittle\", "
              "section = \"post\", at = [0, 0] },\n"
              "{ name = \"tall\", size = [0.38, 0.88, 1.79], mass = 80, material = \"brittle\", "
              "section = \"post\", at = [0.44, 0] },\n"
              "{ name = \"heavy\", size = [0.45, 0.88, 1.6], mass = 150, material = \"brittle\", "
              "section = \"post\", at = [0.92, 0.1] }]\n");
  const Ended ended = topple({"run", "row.toml", "--json", "-", "--quiet"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_LT(Json::parse(ended.out)["energy"]["balance_error"], 5e-3);
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

// Two halves of a cantilever, 1 m each, whose yield stresses are a million apart: it carries Mp/l of the
// weaker at its own clamp. Bent down by 1 mm the arm is shorter by 1e-6.
TEST_F(AnalysisTest, strengths_a_million_apart_side_by_side_come_to_the_collapse_load) {
  const auto material = [](const char* name, const char* yield) {
    return "[[material]]\nname = \"" + std::string(name) +
           "\"\nyoung = \"205 GPa\"\npoisson = 0.3\ndensity = 7850\nyield = \"" + yield + "\"\n";
  };
  const std::string beam = R"(
[[section]]
name = "bar"
shape = "solid"
size = ["20 mm", "20 mm"]
[[frame]]
name = "beam"
nodes = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
members = [{ nodes = [0, 1], section = "bar", material = "first" }, { nodes = [1, 2], section = "bar", material = "second" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 2, force = [0, 0, -1] }]
)";
  const double modulus = 2e-6;  // b h^2 / 4, m^3
  for (const auto& [first, second, load] : {std::tuple("235 MPa", "235 Pa", 235 * modulus / 1),
                                            std::tuple("235 Pa", "235 MPa", 235 * modulus / 2)}) {
    write_bytes("beam.toml",
                "topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\n"
                "control = { node = 2, dof = \"z\", to = \"-1 mm\" }\n" +
                    material("first", first) + material("second", second) + beam);
    const Ended ended = topple({"run", "beam.toml", "--json", "-", "--quiet"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_NEAR(Json::parse(ended.out)["static"].back()["factor"].get<double>(), load, 2e-6 * load) << first;
  }
}

TEST_F(AnalysisTest, scene_that_asks_for_modes_is_not_recorded) {
  write_bytes("s.toml", loaded(-1));
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

// gamma > 2 beta: stable up to 1/sqrt(gamma/2 - beta)/2 = 2.236 times the limit of central differences.
TEST_F(AnalysisTest, newmark_that_is_stable_up_to_a_step_tells_that_step_and_keeps_to_it) {
  write_bytes("beam.toml", k_beam);
  const auto run = [](std::vector<std::string> more) {
    std::vector<std::string> words{"run", "beam.toml", "--set", "run.duration=0.02", "--json", "-"};
    words.insert(words.end(), more.begin(), more.end());
    return topple(words);
  };
  const Json explicit_run =
      Json::parse(run({"--set", "run.integrator=central-difference", "--set", "run.time_step=auto"}).out);
  const double limit = std::sqrt(5.) * explicit_run["explicit_limit_s"].get<double>();
  const std::vector<std::string> newmark{"--set", "run.integrator=newmark", "--set", "run.gamma=0.6"};
  std::vector<std::string> adaptive = newmark, fixed = newmark;
  adaptive.insert(adaptive.end(), {"--set", "run.time_step=auto"});
  fixed.insert(fixed.end(), {"--set", fmt::format("run.time_step={}", 0.99 * limit)});
  const Json of_adaptive = Json::parse(run(adaptive).out), of_fixed = Json::parse(run(fixed).out);
  EXPECT_NEAR(of_fixed["explicit_limit_s"].get<double>(), limit, 1e-6 * limit);
  EXPECT_NEAR(of_adaptive["explicit_limit_s"].get<double>(), limit, 1e-6 * limit);
  EXPECT_LE(of_adaptive["time_step_s"].get<double>(), 0.9 * limit);
}

}  // namespace
}  // namespace topple::app
