// Recordings that are run again.
#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

class VerifyTest : public ProgramTest {
 protected:
  /// Two branches with edits, the second from 0.1 s of the first. `lie`: its last checkpoint gets another
  /// hash.
  static void record_branches(bool lie) {
    const io::Scene scene = io::parse_scene(k_shaken, "s");
    io::Recorder recorder("a.h5", scene.name, scene.text, scene.setup.model);
    topple::Run run(scene.setup);
    io::Observer observer;
    RunPoint fork = run.point();
    const auto go_on = [&](std::int32_t branch, const std::vector<Edit>& edits) {
      for (const Edit& edit : edits) {
        recorder.write(LoggedEdit{branch, run.state().step, run.state().time, edit});
        run.edit(edit);
      }
      recorder.write(observer.observe(run));
      while (!run.over()) {
        ASSERT_TRUE(run.advance().ok());
        recorder.write(observer.observe(run));
        if (run.state().step == 100) fork = run.point();
      }
      io::Observation last = observer.last(run);
      if (lie && branch == 1) ++last.checkpoint.value().hash;
      recorder.write(last);
    };
    go_on(0, {{.key = Edit::Key::alpha, .value = Vec3(2000, 0, 0)}});
    recorder.write(Branch{1, 0, 100});
    run = topple::Run(scene.setup, fork);
    observer = io::Observer(1);
    go_on(1, {{.key = Edit::Key::direction, .value = Vec3(1, 2, 0)},
              {.key = Edit::Key::integrator, .value = Vec3(1, 0, 0)},
              {.key = Edit::Key::want, .value = Vec3(1, 0, 0)},
              {.key = Edit::Key::on, .value = Vec3(1, 0, 0)}});
    recorder.finish("completed", "");
  }
};

TEST_F(VerifyTest, a_fresh_recording_has_the_same_hashes) {
  write_bytes("s.toml", k_shaken);
  ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
  const Ended ended = topple({"info", "a.h5", "--verify"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_TRUE(ended.out.ends_with("re-run: 2 checkpoints of 1 branch have the same state hashes\n"))
      << ended.out;
  const nlohmann::ordered_json json = json_of(topple({"info", "a.h5", "--verify", "--json", "-"}).out);
  EXPECT_EQ(
      json["verify"],
      json_of(R"({"checkpoints": 2, "branches": 1, "damaged": false, "same": true, "differences": []})"));
  EXPECT_FALSE(info("a.h5").contains("verify"));
}

TEST_F(VerifyTest, branches_and_edits_are_listed_and_run_again) {
  record_branches(false);
  const Ended ended = topple({"info", "a.h5", "--verify"});
  EXPECT_EQ(ended.code, 0) << ended.out;
  EXPECT_NE(ended.out.find("\n2 branches, 5 edits\n"), std::string::npos) << ended.out;
  EXPECT_TRUE(ended.out.ends_with("re-run: 4 checkpoints of 2 branches have the same state hashes\n"))
      << ended.out;
  const nlohmann::ordered_json json = info("a.h5");
  EXPECT_EQ(json["branches"], json_of(R"([{"id": 0, "parent": -1, "fork_step": 0},
                                          {"id": 1, "parent": 0, "fork_step": 100}])"));
  EXPECT_EQ(json["edits"], json_of(R"([
      {"branch": 0, "step": 0, "time_s": 0.0, "key": "contact.alpha", "value": 2000.0,
       "shown": "203.943 kgf"},
      {"branch": 1, "step": 100, "time_s": 0.10000000000000007, "key": "shake.1.direction",
       "value": [1.0, 2.0, 0.0], "shown": "[1, 2, 0]"},
      {"branch": 1, "step": 100, "time_s": 0.10000000000000007, "key": "run.integrator",
       "value": "generalized-alpha", "shown": "generalized-alpha"},
      {"branch": 1, "step": 100, "time_s": 0.10000000000000007, "key": "run.want",
       "value": ["motion", "stress"], "shown": "[motion, stress]"},
      {"branch": 1, "step": 100, "time_s": 0.10000000000000007, "key": "shake.1.on", "value": 1.0,
       "shown": "true"}])"));
  EXPECT_EQ(json["frames"], 31 + 21);
}

TEST_F(VerifyTest, what_is_drawn_and_exported_follows_the_newest_branch) {
  record_branches(false);
  ASSERT_EQ(topple({"export", "a.h5", "--csv", "data"}).code, 0);
  const std::string floor = bytes_of("data/floor.csv");
  EXPECT_EQ(std::count(floor.begin(), floor.end(), '\n'), 1 + 31);
  EXPECT_EQ(topple({"render", "a.h5", "--png", "pictures", "--fps", "10", "--size", "96x64"}).code, 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator("pictures"), {}), 4);  // 0 to 0.3 s once
}

TEST_F(VerifyTest, another_hash_is_told_with_its_branch_and_place) {
  record_branches(true);
  const Ended ended = topple({"info", "a.h5", "--verify"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_EQ(ended.err, "");
  EXPECT_TRUE(
      ended.out.ends_with("re-run: 3 checkpoints of 2 branches have the same state hashes\n"
                          "branch 1 differs first at 0.3 s (step 300): hash of the stored state\n"))
      << ended.out;
  const Ended json = topple({"info", "a.h5", "--verify", "--json", "a.json"});
  EXPECT_EQ(json.code, 1);
  EXPECT_EQ(json_of(bytes_of("a.json"))["verify"]["differences"][0]["step"], 300);
}

TEST_F(VerifyTest, the_element_that_differs_first_is_named_with_its_member_and_body) {
  {
    const io::Scene scene = io::parse_scene(k_shaken, "s");
    io::Recorder recorder("a.h5", scene.name, scene.text, scene.setup.model);
    topple::Run run(scene.setup);
    io::Observer observer;
    recorder.write(observer.observe(run));
    while (!run.over()) {
      ASSERT_TRUE(run.advance().ok());
      io::Observation now = observer.observe(run);
      if (!now.frames.empty() && run.step() == 120) now.frames[0].section_force[6 * 5] += 1;
      recorder.write(now);
    }
    recorder.write(observer.last(run));
    recorder.finish("completed", "");
  }
  const Ended ended = topple({"info", "a.h5", "--verify"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(
      ended.out.find("\nbranch 0 differs first at 0.12 s (step 120): section_force, body free, member "),
      std::string::npos)
      << ended.out;
  EXPECT_TRUE(ended.out.ends_with(" (element 5)\n")) << ended.out;
  const nlohmann::ordered_json json =
      json_of(topple({"info", "a.h5", "--verify", "--json", "-"}).out)["verify"]["differences"];
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0]["step"], 120);
  EXPECT_EQ(json[0]["element"], 5);
  EXPECT_EQ(json[0]["body"], "free");
}

TEST_F(VerifyTest, what_cannot_be_run_again_is_told) {
  write_bytes("s.toml", k_shaken);
  write_bytes("garbage.h5", std::string("\x89HDF\r\n\x1a\n", 8) + std::string(5000, 'x'));
  expect_one_line({"info", "s.toml", "--verify"}, 2,
                  "--verify: s.toml is a scene; only a recording can be run again");
  expect_one_line({"info", "garbage.h5", "--verify"}, 2, "garbage.h5: cannot read:");
  expect_one_line({"info", "none.h5", "--verify"}, 2, "none.h5");
}

TEST_F(VerifyTest, edits_that_the_scene_has_no_place_for_are_refused) {
  {
    const io::Scene scene = io::parse_scene(k_shaken, "s");
    io::Recorder recorder("a.h5", scene.name, scene.text, scene.setup.model);
    recorder.write(io::Observer().observe(topple::Run(scene.setup)));
    recorder.write(LoggedEdit{0, 0, 0, {.key = Edit::Key::amplitude, .index = 5, .value = Vec3(1, 0, 0)}});
    recorder.finish("completed", "");
  }
  const std::string part = "shake.6.amplitude: there is no such shake; the scene has 1";
  expect_one_line({"info", "a.h5", "--verify"}, 2, part);
  expect_one_line({"render", "a.h5", "--still", "a.png", "--at", "0"}, 2, part);
}

}  // namespace
}  // namespace topple::app
