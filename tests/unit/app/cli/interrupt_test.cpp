// Ctrl+C: files are closed, what was kept is said, exit code 130.
#include <chrono>
#include <thread>

#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

class InterruptTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
  }
  /// Starts the program, sends `signal` when `file` exists (or a little later), and waits for its end.
  static Ended interrupt(const std::vector<std::string>& arguments, const std::string& file,
                         int signal = SIGINT) {
    const int out = memory(), err = memory();
    const pid_t child = start(arguments, out, err);
    for (int i = 0; i < 3000 && !std::filesystem::exists(file); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(std::filesystem::exists(file));
    kill(child, signal);
    Ended ended;
    ended.code = wait_for(child);
    ended.out = content(out);
    ended.err = content(err);
    close(out);
    close(err);
    return ended;
  }
};

TEST_F(InterruptTest, a_run_closes_its_recording_and_says_what_it_holds) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove("a.h5");
    const Ended ended = interrupt(
        {"run", "s.toml", "--set", "run.duration=3600", "-o", "a.h5", "--json", "-"}, "a.h5", signal);
    EXPECT_EQ(ended.code, 130);
    EXPECT_TRUE(ended.err.starts_with("topple: interrupted at ")) << ended.err;
    EXPECT_NE(ended.err.find(" s; a.h5 holds everything up to "), std::string::npos) << ended.err;
    const auto result = json_of(ended.out), what = info("a.h5");
    EXPECT_EQ(result["status"], "interrupted");
    EXPECT_EQ(what["status"], "interrupted");
    EXPECT_EQ(what["summary"], result);
    EXPECT_NEAR(what["recorded_s"], result["simulated_s"], 1e-12);
    EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "s.toml"}));
  }
}

TEST_F(InterruptTest, a_scene_that_is_being_run_for_its_pictures_leaves_nothing) {
  // the first picture's folder is made before the run
  const Ended ended =
      interrupt({"render", "s.toml", "--set", "run.duration=3600", "--png", "pictures"}, "pictures");
  EXPECT_EQ(ended.code, 130);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(ended.err.find("holds"), std::string::npos) << ended.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"pictures", "s.toml"}));
}

TEST_F(InterruptTest, a_sequence_keeps_its_whole_pictures) {
  ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
  const Ended ended =
      interrupt({"render", "a.h5", "--png", "p", "--fps", "1000", "--size", "640x360"}, "p/frame-000001.png");
  EXPECT_EQ(ended.code, 130);
  EXPECT_EQ(ended.err, "topple: interrupted; the pictures drawn so far are in p\n");
  const std::vector<std::string> names = files();
  EXPECT_LT(names.size(), 300u);
  for (const std::string& name : names) {
    if (!name.starts_with("p/")) continue;
    EXPECT_TRUE(bytes_of(name).ends_with("IEND\xae\x42\x60\x82")) << name;
  }
}

TEST_F(InterruptTest, an_export_leaves_nothing_half_written) {
  ASSERT_EQ(topple({"run", "s.toml", "--set", "run.duration=20", "-o", "a.h5"}).code, 0);
  for (const char* format : {"--csv", "--vtk"}) {
    const Ended ended = interrupt({"export", "a.h5", format, "out"}, "out");
    EXPECT_EQ(ended.code, 130);
    EXPECT_EQ(ended.err, "topple: interrupted; out is not written\n");
    EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "out", "s.toml"}));
    std::filesystem::remove("out");
  }
}

TEST_F(InterruptTest, a_video_is_not_left_half_written) {
  ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
  const int out = memory(), err = memory();
  const pid_t child =
      start({"render", "a.h5", "--mp4", "a.mp4", "--fps", "1000", "--size", "1280x720"}, out, err);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 130);
  close(out);
  close(err);
  EXPECT_EQ(files(), (std::vector<std::string>{"a.h5", "s.toml"}));
}

}  // namespace
}  // namespace topple::app
