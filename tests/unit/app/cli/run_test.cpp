// What `topple run` says and keeps.
#include <pty.h>

#include <algorithm>
#include <cmath>

#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

class RunTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
    write_bytes("beam.toml", k_beam);
  }
  static std::vector<std::string> keys(const Json& object) {
    std::vector<std::string> names;
    for (const auto& [key, value] : object.items()) names.push_back(key);
    return names;
  }
  static void expect_keys(const Json& object, const std::vector<std::string>& wanted) {
    for (const std::string& key : wanted) EXPECT_TRUE(object.contains(key)) << key;
  }
  /// stderr of a call that has a terminal for it.
  static std::string on_a_terminal(const std::vector<std::string>& arguments) {
    int master = -1, terminal = -1;
    if (openpty(&master, &terminal, nullptr, nullptr, nullptr) != 0) return "no terminal";
    const int out = memory();
    const pid_t child = start(arguments, out, terminal);
    close(terminal);
    std::string text;
    char block[4096];
    for (ssize_t got; (got = read(master, block, sizeof block)) > 0;)
      text.append(block, static_cast<std::size_t>(got));
    EXPECT_EQ(wait_for(child), 0);
    close(master);
    close(out);
    return text;
  }
};

TEST_F(RunTest, the_summary_has_the_keys_of_the_contract) {
  const Ended ended = topple({"run", "s.toml", "--json", "-"});
  EXPECT_EQ(ended.code, 0);
  const Json s = json_of(ended.out);
  ASSERT_TRUE(s.is_object()) << ended.out;
  expect_keys(s, {"topple", "schema", "scene", "status", "simulated_s", "wall_s", "realtime_factor",
                  "integrator", "time_step_s", "uplift_threshold_deg", "steps", "rejected_steps",
                  "newton_iterations", "energy", "bodies", "probes", "static", "warnings"});
  expect_keys(s["energy"], {"input_J", "kinetic_J", "strain_J", "gravity_J", "contact_J", "dissipated_J",
                            "balance_error"});
  ASSERT_EQ(s["bodies"].size(), 1u);
  expect_keys(s["bodies"][0],
              {"name", "model", "overturned", "overturn_time_s", "first_uplift_s", "impacts", "peak_tilt_deg",
               "final_tilt_deg", "peak_slide_m", "final_slide_m", "peak_stress_Pa", "peak_yield_ratio",
               "hinges", "fractures", "peak_penetration_ratio"});
  ASSERT_EQ(s["probes"].size(), 1u);
  EXPECT_EQ(keys(s["probes"][0]), (std::vector<std::string>{"name", "final", "peak"}));
  EXPECT_EQ(keys(s["probes"][0]["final"]), (std::vector<std::string>{"displacement_m", "rotation_rad"}));
  EXPECT_EQ(keys(s["probes"][0]["peak"]), (std::vector<std::string>{"displacement_m", "time_s"}));
  EXPECT_EQ(s["topple"], TOPPLE_VERSION);
  EXPECT_EQ(s["schema"], 1);
  EXPECT_EQ(s["scene"], "s");
  EXPECT_EQ(s["status"], "completed");
  EXPECT_TRUE(s["bodies"][0]["overturn_time_s"].is_null());
  EXPECT_TRUE(s["bodies"][0]["peak_yield_ratio"].is_null());
  EXPECT_TRUE(s["static"].is_array());
}

TEST_F(RunTest, the_numbers_of_the_summary_agree_with_each_other) {
  const Json s = json_of(topple({"run", "s.toml", "--set", "cabinet.free.model=frame", "--json", "-"}).out);
  EXPECT_NEAR(s["simulated_s"], 0.3, 1e-9);
  EXPECT_NEAR(s["simulated_s"], s["steps"].get<double>() * s["time_step_s"].get<double>(), 1e-9);
  EXPECT_NEAR(s["realtime_factor"].get<double>() * s["wall_s"].get<double>(), 0.3, 1e-6);
  EXPECT_GE(s["newton_iterations"], s["steps"]);
  const Json& e = s["energy"];
  EXPECT_GT(e["input_J"], 0);
  EXPECT_NEAR(
      e["friction_J"].get<double>() + e["normal_damping_J"].get<double>() + e["numerical_J"].get<double>(),
      e["dissipated_J"], 1e-12);
  const Json& body = s["bodies"][0];
  EXPECT_GE(body["peak_tilt_deg"], body["final_tilt_deg"]);
  EXPECT_GE(body["peak_slide_m"], body["final_slide_m"]);
  EXPECT_GT(body["peak_stress_Pa"], 0);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(std::abs(s["probes"][0]["peak"]["displacement_m"][k].get<double>()),
              std::abs(s["probes"][0]["final"]["displacement_m"][k].get<double>()));
    EXPECT_LE(s["probes"][0]["peak"]["time_s"][k], s["simulated_s"]);
  }
}

TEST_F(RunTest, energy_that_came_in_is_somewhere) {
  const Json s = json_of(topple({"run", "beam.toml", "--json", "-"}).out),
             &e = s["energy"];  // begins without any
  const double there =
      e["kinetic_J"].get<double>() + e["strain_J"].get<double>() + e["contact_J"].get<double>();
  const double in = e["input_J"].get<double>(), out = e["dissipated_J"].get<double>();
  EXPECT_GT(there, 0);
  EXPECT_NEAR(there + e["gravity_J"].get<double>() + out, in, 1e-3 * in);
  EXPECT_LT(e["balance_error"], 1e-3);
}

TEST_F(RunTest, json_in_a_file_on_standard_output_and_in_the_recording_is_the_same) {
  ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5", "--json", "a.json"}).code, 0);
  const Json in_file = json_of(bytes_of("a.json"));
  EXPECT_EQ(in_file, info("a.h5")["summary"]);
  Json again = json_of(topple({"run", "s.toml", "--json", "-"}).out), once = in_file;
  for (Json* s : {&again, &once})
    for (const char* key : {"wall_s", "realtime_factor"}) s->erase(key);
  EXPECT_EQ(again, once);
}

/// Standard error says that the contacts of the scene are soft, and nothing else.
bool only_soft(const std::string& err) {
  return err.starts_with("topple: warning: contact.alpha = 50 kgf is soft: ") &&
         std::ranges::count(err, '\n') == 1;
}

TEST_F(RunTest, with_json_on_standard_output_warnings_go_to_stderr) {
  const Ended ended =
      topple({"run", "s.toml", "--set", "run.settle=false", "--set", "contact.alpha=1 kgf", "--json", "-"});
  EXPECT_EQ(ended.code, 0);
  const Json s = json_of(ended.out);
  ASSERT_TRUE(s.is_object()) << ended.out;
  ASSERT_EQ(s["warnings"].size(), 2u);
  std::string told;
  for (const Json& warning : s["warnings"]) told += "topple: warning: " + warning.get<std::string>() + "\n";
  EXPECT_EQ(ended.err, told);
}

TEST_F(RunTest, the_table_tells_what_the_summary_tells) {
  const Ended ended = topple({"run", "s.toml", "-o", "a.h5"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(only_soft(ended.err)) << ended.err;
  EXPECT_TRUE(ended.out.starts_with("s: completed after 0.3 s (")) << ended.out;
  EXPECT_NE(ended.out.find("300 steps"), std::string::npos);
  EXPECT_NE(ended.out.find("\nfree "), std::string::npos);
  EXPECT_NE(ended.out.find("\nprobe middle: "), std::string::npos);
  EXPECT_TRUE(ended.out.ends_with("recording: a.h5\n")) << ended.out;
}

TEST_F(RunTest, an_estimate_of_the_error_stands_in_summary_table_and_recording) {
  const Ended ended = topple({"run", "s.toml", "--estimate", "-o", "a.h5", "--json", "a.json"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(only_soft(ended.err)) << ended.err;
  EXPECT_NE(ended.out.find("\nerror of the time integration (step and its parts halved): peak tilt "),
            std::string::npos)
      << ended.out;
  const Json s = json_of(bytes_of("a.json")), &e = s["error_estimate"];
  ASSERT_TRUE(e.is_object());
  EXPECT_EQ(e["how"], "step and its parts halved");
  EXPECT_TRUE(e["overturn_time_s"].is_null());  // nothing falls
  EXPECT_GT(e["peak_tilt_deg"], 0);
  EXPECT_LT(e["peak_tilt_deg"], s["bodies"][0]["peak_tilt_deg"]);
  EXPECT_TRUE(e["disagreements"].empty());
  EXPECT_EQ(e["bodies"][0]["name"], "free");
  EXPECT_EQ(s, info("a.h5")["summary"]);

  const Json plain = json_of(topple({"run", "s.toml", "--json", "-"}).out);
  EXPECT_FALSE(plain.contains("error_estimate"));
  EXPECT_EQ(plain["bodies"], s["bodies"]);  // the run itself is the same
  const Json halved = json_of(topple({"run", "s.toml", "--set", "run.time_step=0.5 ms", "--json", "-"}).out);
  EXPECT_NEAR(e["peak_tilt_deg"].get<double>(),
              2 * std::abs(s["bodies"][0]["peak_tilt_deg"].get<double>() -
                           halved["bodies"][0]["peak_tilt_deg"].get<double>()),
              1e-3 * s["bodies"][0]["peak_tilt_deg"].get<double>());
}

TEST_F(RunTest, the_error_of_an_adaptive_run_is_that_of_its_tolerance) {
  const Ended ended = topple({"run", "s.toml", "--estimate", "--set", "run.time_step=auto"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(
      ended.out.find(
          "\nerror of the time integration (tolerance divided by 100, parts of a step by 4): peak tilt "),
      std::string::npos)
      << ended.out;
}

TEST_F(RunTest, what_takes_no_steps_of_time_has_no_error_of_them) {
  expect_one_line({"run", "portal-pushover", "--estimate"}, 2, "--estimate: statics take no steps of time");
  expect_one_line({"run", "verify/beams-frequencies", "--estimate"}, 2,
                  "--estimate: modes take no steps of time");
}

TEST_F(RunTest, progress_is_drawn_on_a_terminal_only_and_not_when_quiet) {
  const std::vector<std::string> call{"run",   "s.toml",
                                      "--set", "run.duration=3",
                                      "--set", "run.time_step=0.1 ms",
                                      "--set", "cabinet.free.model=frame"};
  std::vector<std::string> quiet = call;
  quiet.push_back("--quiet");
  EXPECT_EQ(topple(call).err.find('['), std::string::npos);
  EXPECT_NE(on_a_terminal(call).find("s simulated"), std::string::npos);
  EXPECT_TRUE(only_soft(on_a_terminal(quiet)));
}

TEST_F(RunTest, the_same_scene_gives_the_same_states) {
  for (const char* name : {"a.h5", "b.h5"}) ASSERT_EQ(topple({"run", "s.toml", "-o", name}).code, 0);
  const Json a = info("a.h5"), b = info("b.h5");
  EXPECT_EQ(a["last_state_hash"].get<std::string>().size(), 16u);
  EXPECT_EQ(a["last_state_hash"], b["last_state_hash"]);
  EXPECT_EQ(a["events"], b["events"]);
  ASSERT_EQ(topple({"run", "s.toml", "-o", "c.h5", "--set", "contact.friction=0.59"}).code, 0);
  EXPECT_NE(a["last_state_hash"], info("c.h5")["last_state_hash"]);
}

// An uplift is known late, and dated when the side let go.
TEST_F(RunTest, events_are_told_in_the_order_of_time) {
  ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml");
  const auto event = [](Event::Kind kind, std::int64_t step, double time) {
    return io::RecordedEvent{0, step, time, {kind, step, time, 0, 0}};
  };
  {
    io::Recorder recorder("b.h5", scene.name, scene.text, scene.setup.model);
    recorder.write({.frames = {io::Recording("a.h5").frame(0)},
                    .checkpoint = {},
                    .events = {event(Event::Kind::impact, 25, 0.025), event(Event::Kind::uplift, 30, 0.02)}});
    recorder.flush();
  }
  EXPECT_EQ(info("b.h5")["events"][0]["kind"], "uplift");
  const std::string told = topple({"info", "b.h5"}).out;
  EXPECT_LT(told.find("0.0200 s  free uplift"), told.find("0.0250 s  free impact")) << told;
}

TEST_F(RunTest, a_name_with_a_dot_is_kept_in_its_recording) {
  write_bytes("alpha-0.001.toml", k_shaken);
  ASSERT_EQ(topple({"run", "alpha-0.001.toml", "-o", "a.h5"}).code, 0);
  EXPECT_EQ(info("a.h5")["scene"], "alpha-0.001");
}

// Also where rigid is asked for and no change of a level tells.
TEST_F(RunTest, names_the_impulses_of_bodies_that_meet) {
  const std::string three =
      "[run]\nduration = 0.5\ntime_step = \"auto\"\nwant = [\"motion\"]\n"
      "[floor]\nwidth = \"60 mm\"\n";
  const auto block = [](const std::string& name, double x) {
    return "[[block]]\nname = \"" + name +
           "\"\nsize = [0.3, 0.6, 1.5]\nmass = 60\nmodel = \"rigid\"\nat = [" + std::to_string(x) + ", 0]\n";
  };
  write_bytes("row.toml", "topple = 1\n" + three + block("a", 0) + block("b", 0.31));
  const Ended ended = topple({"run", "row.toml"});
  EXPECT_NE(ended.out.find("TR-BDF2 on stiff contacts, impulses where bodies meet"), std::string::npos)
      << ended.out;
}

TEST_F(RunTest, threads_change_no_state) {
  const std::string at = "size = [\"380 mm\"";
  std::string first = k_shaken, second = k_cabinet;
  first.insert(first.find(at), "model = \"frame\"\n");
  second.insert(second.find(at), "model = \"frame\"\nat = [\"5 m\", 0]\n");
  second.replace(second.find("free"), 4, "other");
  write_bytes("two.toml", first + second);
  for (const char* jobs : {"1", "2", "3"}) {
    const std::string name = std::string("jobs-") + jobs + ".h5";
    ASSERT_EQ(topple({"run", "two.toml", "-o", name, "--jobs", jobs}).code, 0);
    EXPECT_EQ(info(name)["last_state_hash"], info("jobs-1.h5")["last_state_hash"]);
  }
  expect_one_line({"run", "two.toml", "--jobs", "0"}, 2, "--jobs: \"0\" is not a whole number in 1..256");
}

TEST_F(RunTest, the_phases_of_a_profile_make_up_the_time_of_the_steps) {
  const Ended ended = topple(
      {"run", "s.toml", "--set", "cabinet.free.model=frame", "-o", "a.h5", "--profile", "--json", "-"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json s = json_of(ended.out);
  ASSERT_TRUE(s.is_object()) << ended.out;
  const Json& profile = s["profile"];
  double sum = 0;
  for (const char* key : {"search_s", "models_s", "bodies_s", "forces_s", "tangent_s", "factor_s", "solve_s",
                          "energy_s", "observe_s", "record_s", "other_s"}) {
    ASSERT_TRUE(profile.contains(key)) << key;
    EXPECT_GE(profile[key], 0) << key;
    sum += profile[key].get<double>();
  }
  for (const char* key : {"factor_s", "observe_s", "record_s"}) EXPECT_GT(profile[key], 0) << key;
  EXPECT_EQ(profile["bodies_s"], 0);
  EXPECT_NEAR(sum, profile["total_s"], 1e-9);
  EXPECT_LE(profile["total_s"], s["wall_s"]);
  EXPECT_EQ(profile["steps"], s["steps"]);
  EXPECT_EQ(profile["threads"], 1);
  EXPECT_EQ(profile.size(), 14u);
  EXPECT_EQ(s, info("a.h5")["summary"]);
}

TEST_F(RunTest, a_profile_follows_the_table) {
  const std::string plain = topple({"run", "s.toml"}).out, with = topple({"run", "s.toml", "--profile"}).out;
  EXPECT_EQ(plain.find("factorisation"), std::string::npos);
  EXPECT_LT(with.find("\nprobe middle: "), with.find("\nfactorisation "));
  EXPECT_TRUE(with.ends_with("\nmeasured on one thread\n")) << with;
  EXPECT_FALSE(json_of(topple({"run", "s.toml", "--json", "-"}).out).contains("profile"));
  expect_one_line({"run", "s.toml", "--profile", "--jobs", "2"}, 2, "excludes");
  for (const char* analysis : {"static", "modes"}) {
    std::string text = k_beam;
    const std::size_t begin = text.find("duration"), end = text.find("[[material]]");
    text.replace(begin, end - begin, std::string("analysis = \"") + analysis + "\"\n");
    write_bytes("timeless.toml", text);
    expect_one_line({"run", "timeless.toml", "--profile"}, 2, "take no steps of time");
  }
}

TEST_F(RunTest, a_scene_may_come_through_a_pipe) {
  for (const char* command : {"run", "check", "info"}) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    ASSERT_EQ(write(ends[1], k_shaken.data(), k_shaken.size()), static_cast<ssize_t>(k_shaken.size()));
    close(ends[1]);
    const Ended ended = topple({command, "/dev/fd/" + std::to_string(ends[0])});
    EXPECT_EQ(ended.code, 0) << command << ": " << ended.err;
    close(ends[0]);
  }
}

TEST_F(RunTest, a_scene_is_described_with_what_is_set) {
  const auto mass = [&](const std::vector<std::string>& set) {
    std::vector<std::string> words{"info", "s.toml", "--json", "-"};
    words.insert(words.end(), set.begin(), set.end());
    const Ended ended = topple(words);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return Json::parse(ended.out)["bodies"][0]["mass_kg"].get<double>();
  };
  EXPECT_NEAR(mass({"--set", "cabinet.free.mass=50 kg"}), 50, 1e-9);
  EXPECT_NEAR(mass({"--set", "cabinet.free.mass=50 kg", "--set", "cabinet.free.mass=60"}), 60, 1e-9);
  expect_one_line({"info", "s.toml", "--set", "cabinet.free.mess=50"}, 2, "mess");
  ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5", "--set", "run.duration=0.01"}).code, 0);
  expect_one_line({"info", "a.h5", "--set", "run.duration=1"}, 2, "only a scene can be changed");
}

TEST_F(RunTest, overrides_are_part_of_the_recording) {
  ASSERT_EQ(
      topple({"run", "s.toml", "-o", "a.h5", "--set", "run.duration=0.1", "--set", "cabinet.free.mass=50 kg"})
          .code,
      0);
  const Json what = info("a.h5");
  EXPECT_EQ(what["duration_s"], 0.1);
  EXPECT_NEAR(what["bodies"][0]["mass_kg"], 50, 1e-9);
}

TEST_F(RunTest, a_recording_tells_the_energies_of_its_newest_instant) {
  const Ended ended = topple({"run", "s.toml", "-o", "a.h5", "--json", "-"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json energy = info("a.h5")["energy"], summary = json_of(ended.out)["energy"];
  for (const auto& [key, value] : energy.items())
    EXPECT_NEAR(value, summary[key].get<double>(), 1e-12 * (1 + std::abs(value.get<double>()))) << key;
  for (const char* key : {"plastic_J", "friction_J", "normal_damping_J", "numerical_J", "balance_error"})
    EXPECT_TRUE(energy.contains(key)) << key;
  const std::string told = topple({"info", "a.h5"}).out;
  EXPECT_NE(told.find("\nenergy: "), std::string::npos);
  EXPECT_NE(told.find(" s  free model elastic (stresses are wanted)\n"), std::string::npos) << told;
}

TEST_F(RunTest, a_name_that_is_not_utf_8_spoils_nothing) {
  write_bytes("\xff.toml", k_shaken);
  const Ended ended = topple({"run", "\xff.toml", "-o", "a.h5", "--json", "-"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(json_of(ended.out).is_object());
  EXPECT_EQ(info("a.h5")["status"], "completed");
}

TEST_F(RunTest, an_explicit_step_above_its_limit_is_told_and_the_first_instant_kept) {
  const Ended ended =
      topple({"run", "beam.toml", "--set", "run.integrator=central-difference", "-o", "a.h5", "--json", "-"});
  EXPECT_EQ(ended.code, 1);
  for (const char* part : {"body \"beam\", member \"member-0\" (element ",
                           "): the time integration is stable up to a time_step of ", ", met at 0 s"})
    EXPECT_NE(ended.err.find(part), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("a.h5 holds everything up to 0 s"), std::string::npos) << ended.err;
  EXPECT_EQ(json_of(ended.out)["status"], "diverged");
  const Json what = info("a.h5");
  EXPECT_EQ(what["status"], "diverged");
  EXPECT_EQ(what["frames"], 1);
  EXPECT_EQ(topple({"info", "a.h5", "--verify"}).code, 0);
}

TEST_F(RunTest, a_step_that_is_refused_is_told_and_what_was_right_is_kept) {
  std::string torn = k_beam;
  const std::string load = "[0, 0, \"-100 N\"]";
  torn.replace(torn.find(load), load.size(),
               "[-1e9, 0, -1], moment = [0, 1e9, 0], history = [[0.05, 0], [0.051, 1]]");
  write_bytes("torn.toml", torn);
  const Ended ended = topple({"run", "torn.toml", "-o", "a.h5", "--json", "-"});
  EXPECT_EQ(ended.code, 1);
  const Json s = json_of(ended.out), what = info("a.h5");
  EXPECT_EQ(s["status"], "diverged");
  const std::string message = s["message"];
  EXPECT_TRUE(
      message.starts_with("more than a tenth of the energy is unaccounted for after the step at 0.05"))
      << message;
  EXPECT_TRUE(ended.err.starts_with("topple: torn: " + message + "; a.h5 holds everything up to "))
      << ended.err;
  EXPECT_EQ(what["status"], "diverged");
  EXPECT_NEAR(what["recorded_s"], s["simulated_s"], 1e-12);
  EXPECT_NEAR(s["simulated_s"], 0.05, 1e-3);
  EXPECT_EQ(what["frames"], 6);
  EXPECT_EQ(topple({"info", "a.h5", "--verify"}).code, 0);
  const Ended adaptive = topple({"run", "torn.toml", "--set", "run.time_step=auto"});
  EXPECT_EQ(adaptive.code, 1);
  EXPECT_NE(adaptive.err.find("try a larger tolerance"), std::string::npos) << adaptive.err;
}

TEST_F(RunTest, what_a_summary_cannot_tell_is_warned_of) {
  EXPECT_NE(
      topple({"run", "breaking"}).err.find("fell through the floor or a wall with pieces that broke off"),
      std::string::npos);
}

// At 20 m/s a step of 1 ms leads an elastic cabinet deep into the blow before it becomes a frame.
TEST_F(RunTest, energy_that_a_change_of_models_put_in_is_warned_of) {
  write_bytes("thrown.toml",
              "topple = 1\n[run]\nduration = 0.04\nsettle = false\ngravity = [0, 0, 0]\n"
              "[[cabinet]]\nname = \"hit\"\nsize = [0.38, 0.88, 1.79]\nmass = 40\nsection = \"box 30x1\"\n"
              "material = \"steel\"\nshelves = 2\n[[block]]\nname = \"box\"\nsize = [0.2, 0.2, 0.2]\n"
              "mass = 5\nat = [-0.8, 0, 0.3]\nvelocity = [20, 0, 0]\n");
  const std::string words = "bodies that changed their model got ";
  EXPECT_NE(topple({"run", "thrown.toml"}).err.find(words), std::string::npos);
  const Ended frame = topple({"run", "thrown.toml", "--set", "cabinet.hit.model=frame"});
  EXPECT_EQ(frame.code, 0) << frame.err;
  EXPECT_EQ(frame.err.find(words), std::string::npos) << frame.err;
}

TEST_F(RunTest, a_body_with_nothing_to_stand_on_does_not_settle) {
  std::string text = k_shaken;
  text.replace(text.find("[floor]"), 7, "[[wall]]\nat = [-9, 0]\nnormal = [1, 0, 0]");
  write_bytes("falls.toml", text);
  for (const char* command : {"run", "render"}) {
    const Ended ended = *command == 'r' && command[1] == 'u'
                            ? topple({"run", "falls.toml", "-o", "a.h5"})
                            : topple({"render", "falls.toml", "--still", "a.png", "--at", "0"});
    EXPECT_EQ(ended.code, 1);
    for (const char* part : {"at 0 s: body \"free\"", " does not come to rest under gravity"})
      EXPECT_NE(ended.err.find(part), std::string::npos) << ended.err;
    EXPECT_EQ(ended.err.find("holds"), std::string::npos) << ended.err;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"beam.toml", "falls.toml", "s.toml"}));
}

}  // namespace
}  // namespace topple::app
