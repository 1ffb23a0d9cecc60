// topple compare: what differs, in what is said and in what happens.
#include <regex>

#include "app/batch/summary.h"
#include "solver/io/recording/recording.h"
#include "unit/app/live.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

class CompareTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
  }
  static void record(const std::string& name, const std::string& change) {
    EXPECT_EQ(topple({"run", "s.toml", "--set", change, "-o", name, "--quiet"}).code, 0);
  }
  static void record_edited(const std::string& name, const std::vector<Edit>& edits) {
    const io::Scene scene = io::load_scene("s.toml");
    topple::Run run(scene.setup);
    io::Recorder recorder({name, false}, scene.name, scene.text, scene.setup.model);
    for (const Edit& edit : edits) {
      run.edit(edit);
      recorder.write(LoggedEdit{.edit = edit});
    }
    io::Observer observer;
    recorder.write(observer.observe(run));
    while (!run.over() && run.advance().ok()) recorder.write(observer.observe(run));
    recorder.finish("completed", summary(scene, run, "completed", 1).dump());
  }
};

TEST_F(CompareTest, a_scene_does_not_differ_from_its_recording) {
  record("a.h5", "run.duration=0.3 s");
  const Ended ended = topple({"compare", "s.toml", "a.h5", "--json", "-"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const Json result = json_of(ended.out);
  EXPECT_TRUE(result["parameters"].empty()) << result["parameters"];
  ASSERT_EQ(result["bodies"].size(), 1u);
  EXPECT_EQ(result["bodies"][0]["a"], result["bodies"][0]["b"]);
  EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "s.toml"}));
}

TEST_F(CompareTest, what_differs_stands_with_both_values_and_units) {
  record("weak.h5", "shake.table.amplitude=0.1 g");
  const Ended ended = topple({"compare", "s.toml", "weak.h5", "--json", "both.json"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const Json result = json_of(bytes_of("both.json"));
  ASSERT_EQ(result["parameters"].size(), 1u) << result["parameters"];
  EXPECT_EQ(result["parameters"][0]["key"], "shake.table.amplitude");
  EXPECT_EQ(result["parameters"][0]["a"], "400 gal");
  EXPECT_EQ(result["parameters"][0]["b"], "98.0665 gal");
  const Json &a = result["bodies"][0]["a"], &b = result["bodies"][0]["b"];
  EXPECT_GT(a["peak_tilt_deg"], b["peak_tilt_deg"]);
  EXPECT_EQ(a["peak_tilt_deg"],
            json_of(topple({"run", "s.toml", "--json", "-"}).out)["bodies"][0]["peak_tilt_deg"]);
  for (const char* part : {"shake.table.amplitude  400 gal", "A: s.toml", "B: weak.h5",
                           "free: peak tilt, deg", "free: overturns at, s   no", "free: peak stress, MPa"})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part << "\n" << ended.out;
}

TEST_F(CompareTest, what_was_changed_before_the_first_step_is_what_the_run_began_with) {
  record("weak.h5", "shake.table.amplitude=0.1 g");
  record_edited("edited.h5", {{Edit::Key::amplitude, 0, Vec3(0.980665, 0, 0)}});
  const Ended ended = topple({"compare", "weak.h5", "edited.h5"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("no parameter differs"), std::string::npos) << ended.out;
}

TEST_F(CompareTest, a_pull_before_the_first_step_stands_among_the_edits_as_no_scene_can_say_it) {
  record_edited("edited.h5",
                {{Edit::Key::amplitude, 0, Vec3(0.980665, 0, 0)}, {Edit::Key::pull, 4, Vec3(100, 0, 0)}});
  const Ended ended = topple({"compare", "s.toml", "edited.h5"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("shake.table.amplitude  400 gal"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("pull = [100 N, 0 N, 0 N] from 0.000 s on"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find("edit 2"), std::string::npos) << ended.out;
}

// As after R and the end of the window.
TEST_F(CompareTest, the_branch_that_is_compared_is_named_with_how_long_it_ran) {
  const auto scene = std::make_shared<const io::Scene>(io::load_scene("s.toml"));
  LiveRun run(LiveSource{.scene = scene, .recording = {}, .output = "left.h5"});
  Player player(scene, run);
  const auto until = [&](auto done) { return eventually([&] { player.update(0.01); }, done); };
  ASSERT_TRUE(until([&] { return player.can_edit(); }));
  player.step(1);
  ASSERT_TRUE(until([&] { return player.time() > 0 && player.can_edit(); }));
  player.restart();
  ASSERT_TRUE(until([&] { return player.history().branches.size() == 2 && player.can_edit(); }));
  run.close("stopped");
  const Ended ended = topple({"compare", "s.toml", "left.h5"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find(" B: left.h5, branch 1\n"), std::string::npos) << ended.out;
  EXPECT_TRUE(std::regex_search(ended.out, std::regex("\nsimulated, s +0\\.300 +0\\.000\n"))) << ended.out;
}

TEST_F(CompareTest, what_was_changed_while_it_ran_stands_with_its_value_and_its_time) {
  record("weak.h5", "shake.table.amplitude=0.1 g");
  const io::Scene scene = io::load_scene("s.toml");
  topple::Run run(scene.setup);
  io::Recorder recorder({"edited.h5", false}, scene.name, scene.text, scene.setup.model);
  io::Observer observer;
  recorder.write(observer.observe(run));
  while (run.time() < 0.1 && run.advance().ok()) recorder.write(observer.observe(run));
  const Edit weaker{Edit::Key::amplitude, 0, Vec3(0.980665, 0, 0)};
  recorder.write(LoggedEdit{0, run.step(), run.time(), weaker});
  run.edit(weaker);
  while (!run.over() && run.advance().ok()) recorder.write(observer.observe(run));
  recorder.finish("completed", summary(scene, run, "completed", 1).dump());
  const Ended ended = topple({"compare", "edited.h5", "weak.h5"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const std::string::size_type edit = ended.out.find("edit 1 while it ran");
  ASSERT_NE(edit, std::string::npos) << ended.out;
  const std::string line = ended.out.substr(edit, ended.out.find('\n', edit) - edit);
  EXPECT_NE(line.find("shake.1.amplitude = 98.0665 gal from 0.1"), std::string::npos) << line;
  EXPECT_TRUE(line.ends_with(" -")) << line;
}

// Of a bar with Mp = 50 N m at its foot, bent by its tip at 1 m.
// load.
TEST_F(CompareTest, static_runs_have_their_greatest_load_and_their_hinges) {
  const auto bar = [](const char* force) {
    return std::string("topple = 1\n[run]\nanalysis = \"static\"\ngravity = [0, 0, 0]\nload_steps = 2\n") +
           R"(
[[material]]
name = "steel"
young = "200 GPa"
poisson = 0.3
density = "7850 kg/m^3"
yield = "200 MPa"
[[section]]
name = "bar"
shape = "solid"
size = ["10 mm", "10 mm"]
[[frame]]
name = "bar"
nodes = [[0, 0, 0], [0, 0, 1]]
supports = [{ node = 0, fix = "xyzXYZ" }]
members = [{ nodes = [0, 1], section = "bar", material = "steel" }]
loads = [{ node = 1, force = [)" +
           force + ", 0, 0] }]\n";
  };
  write_bytes("elastic.toml", bar("10"));
  write_bytes("plastic.toml", bar("70"));  // Mp = 50 N m
  const Ended ended = topple({"compare", "elastic.toml", "plastic.toml", "--quiet", "--json", "c.json"});
  const Json c = json_of(bytes_of("c.json"));
  EXPECT_EQ(c["a"]["greatest_load_factor"], 1);
  EXPECT_EQ(c["bodies"][0]["a"]["hinges"], 0);
  EXPECT_GE(c["bodies"][0]["b"]["hinges"], 1);
  EXPECT_NE(ended.out.find("greatest load factor   1 "), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("bar: hinges"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find("fractures"), std::string::npos) << ended.out;
}

TEST_F(CompareTest, anchors_that_are_not_in_place_are_said_to_be_so) {
  write_bytes("strap.toml", k_shaken + k_straps);
  EXPECT_EQ(topple({"run", "strap.toml", "--set", "anchor.weak.on=false", "--set", "anchor.strong.on=false",
                    "-o", "away.h5", "--quiet"})
                .code,
            0);
  const Ended ended = topple({"compare", "strap.toml", "away.h5"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* name : {"weak", "strong"}) {
    const std::size_t line = ended.out.find(std::string(name) + " on free: greatest force, N");
    ASSERT_NE(line, std::string::npos) << ended.out;
    EXPECT_NE(ended.out.substr(line, ended.out.find('\n', line) - line).find("not in place"),
              std::string::npos)
        << ended.out;
  }
}

TEST_F(CompareTest, what_stands_beside_a_piece_has_no_yaw_of_its_own) {
  const std::string room =
      "topple = 1\nfloor = {}\nwall = [{ at = [-0.6, 0], normal = [1, 0, 0] }]\n"
      "run = { duration = 0.1, want = [\"motion\"] }\n"
      "furniture = [{ kind = \"cabinet\", name = \"a\", against = \"wall-1\" },\n"
      "{ kind = \"cabinet\", name = \"b\", ";
  write_bytes("beside.toml", room + "beside = \"a\" }]\n");
  write_bytes("at.toml", room + "at = [0.5, 2], yaw = \"90 deg\" }]\n");
  const Ended ended = topple({"compare", "beside.toml", "at.toml", "--json", "-"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const Json result = json_of(ended.out);
  int found = 0;
  for (const Json& parameter : result["parameters"]) {
    if (parameter["key"] != "furniture.b.yaw") continue;
    ++found;
    EXPECT_TRUE(parameter["a"].is_null()) << parameter;
    EXPECT_EQ(parameter["b"], "90 deg");
  }
  EXPECT_EQ(found, 1);
}

TEST_F(CompareTest, bodies_of_one_side_have_a_dash_on_the_other) {
  const Ended ended = topple({"compare", "s.toml", "free-rocking", "--json", "-"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const Json result = json_of(ended.out);
  ASSERT_EQ(result["bodies"].size(), 2u);
  EXPECT_EQ(result["bodies"][0]["name"], "free");
  EXPECT_TRUE(result["bodies"][0]["b"].is_null());
  EXPECT_TRUE(result["bodies"][1]["a"].is_null());
}

TEST_F(CompareTest, the_video_holds_both_until_the_longer_one_ends) {
  record("short.h5", "run.duration=0.1 s");
  const Ended ended = topple({"compare", "s.toml", "short.h5", "--mp4", "both.mp4", "--quiet"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(ended.out.ends_with("\nvideo: both.mp4\n")) << ended.out;
  EXPECT_EQ(bytes_of("both.mp4").substr(4, 4), "ftyp");
  EXPECT_EQ(files(), (std::vector<std::string>{"both.mp4", "s.toml", "short.h5"}));
  ASSERT_EQ(std::system(
                "ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 both.mp4 >n"),
            0);
  EXPECT_EQ(std::stoi(bytes_of("n")), 10);  // 0.3 s at 30 a second, both ends
}

TEST_F(CompareTest, a_part_of_the_video_is_asked_for_by_its_times) {
  record("a.h5", "run.duration=0.3 s");
  const std::vector<std::string> both{"compare", "a.h5", "a.h5", "--mp4", "both.mp4", "--quiet"};
  const auto with = [&](std::vector<std::string> times) {
    times.insert(times.begin(), both.begin(), both.end());
    return topple(times);
  };
  EXPECT_EQ(with({"--from", "0.1", "--to", "0.2"}).code, 0);
  const Ended turned = with({"--from", "0.2", "--to", "0.1", "--force"}),
              late = with({"--from", "3", "--force"});
  EXPECT_EQ(turned.code, 2);
  EXPECT_NE(turned.err.find("--from: 0.2 s is after --to, 0.1 s"), std::string::npos) << turned.err;
  EXPECT_EQ(late.code, 2);
  EXPECT_NE(late.err.find("nothing lies between 3 and 0.3 s"), std::string::npos) << late.err;
  EXPECT_EQ(bytes_of("both.mp4").substr(4, 4), "ftyp");
  EXPECT_EQ(topple({"compare", "a.h5", "a.h5", "--from", "0.1"}).code, 2);
  ASSERT_EQ(std::system(
                "ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 both.mp4 >n"),
            0);
  EXPECT_EQ(std::stoi(bytes_of("n")), 4);  // 0.1 s at 30 a second, both ends
}

// Rigid bodies have no stresses that colour them, and are shown as the others.
TEST_F(CompareTest, rigid_bodies_of_A_are_blue_in_the_video) {
  record("rigid.h5", "run.want=['motion']");
  EXPECT_EQ(topple({"compare", "rigid.h5", "rigid.h5", "--mp4", "both.mp4", "--quiet"}).code, 0);
  ASSERT_EQ(std::system("ffmpeg -v error -y -i both.mp4 -frames:v 1 -f rawvideo -pix_fmt rgb24 p.rgb"), 0);
  const std::string rgb = bytes_of("p.rgb");
  int blue = 0;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
    blue += static_cast<unsigned char>(rgb[i + 2]) > static_cast<unsigned char>(rgb[i]) + 60;
  EXPECT_GT(blue, 2000);
}

TEST_F(CompareTest, without_ffmpeg_there_is_no_video_and_one_line) {
  const Ended ended =
      topple({"compare", "s.toml", "s.toml", "--mp4", "both.mp4", "--quiet"}, {.set = {{"PATH", "/none"}}});
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.err.find("ffmpeg"), std::string::npos) << ended.err;
  EXPECT_EQ(files(), std::vector<std::string>{"s.toml"});
}

}  // namespace
}  // namespace topple::app
