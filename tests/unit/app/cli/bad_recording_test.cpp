// Files that are no recordings, or no longer.
#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

class BadRecordingTest : public ProgramTest {
 protected:
  void record() {
    write_bytes("s.toml", k_shaken);
    ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
  }
  static void expect_refused(const std::string& name, const std::string& part) {
    const std::vector<std::string> before = files();
    expect_one_line({"info", name}, 2, part);
    expect_one_line({"info", name, "--json", "-"}, 2, part);
    expect_one_line({"render", name, "--png", "pictures"}, 2, part);
    expect_one_line({"render", name, "--still", "a.png", "--at", "0"}, 2, part);
    expect_one_line({"render", name, "--mp4", "a.mp4"}, 2, part);
    expect_one_line({"view", name, "-o", "b.h5"}, 2, part);
    expect_one_line({"export", name, "--csv", "data"}, 2, part);
    expect_one_line({"export", name, "--xdmf", "a.xdmf"}, 2, part);
    expect_one_line({"recover", name}, 2, part);
    EXPECT_EQ(files(), before);
  }
};

TEST_F(BadRecordingTest, a_recording_cut_at_any_length_is_refused) {
  record();
  const std::string whole = bytes_of("a.h5");
  for (const std::size_t length : {std::size_t{1}, std::size_t{7}, std::size_t{100}, std::size_t{2000},
                                   whole.size() / 2, whole.size() - 1}) {
    SCOPED_TRACE(length);
    write_bytes("cut.h5", whole.substr(0, length));
    expect_refused("cut.h5", "cut.h5");
  }
  write_bytes("cut.h5", whole.substr(0, whole.size() / 2));
  expect_refused("cut.h5", "cut.h5: cannot read: the file is cut off; its end is missing");
}

TEST_F(BadRecordingTest, a_changed_byte_is_told_or_does_not_matter) {
  record();
  const std::string whole = bytes_of("a.h5");
  // HDF5 itself loses the memory of object headers that it finds damaged
  const Circumstances leaking{.set = {{"ASAN_OPTIONS", "detect_leaks=0"}}};
  for (std::size_t at = 50; at < whole.size(); at += whole.size() / 23) {
    SCOPED_TRACE(at);
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x55);
    write_bytes("changed.h5", changed);
    const Ended ended = topple({"export", "changed.h5", "--csv", "data"}, leaking);
    EXPECT_TRUE(ended.code == 0 || ended.code == 2) << ended.code << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), ended.code == 2) << ended.err;
  }
}

TEST_F(BadRecordingTest, what_is_not_a_recording_is_told) {
  write_bytes("text.h5", "hello\n");
  std::filesystem::create_directory("folder");
  expect_one_line({"export", "text.h5", "--csv", "data"}, 2, "text.h5: is not a recording (an HDF5 file)");
  expect_one_line({"export", "folder", "--csv", "data"}, 2, "folder: is a folder, not a recording");
  expect_one_line({"export", "none.h5", "--csv", "data"}, 2, "none.h5: No such file or directory");
  expect_one_line({"export", "paper-a", "--csv", "data"}, 2, "paper-a: is a scene, not a recording");
  expect_one_line({"info", "text.h5"}, 2, "text.h5:1:");
  EXPECT_FALSE(std::filesystem::exists("data"));
}

TEST_F(BadRecordingTest, a_recording_is_not_taken_for_a_scene) {
  record();
  for (const char* command : {"run", "check"})
    expect_one_line({command, "a.h5"}, 2, "a.h5: is a recording (an HDF5 file), not a scene");
  expect_one_line({"render", "a.h5", "--png", "p", "--set", "run.duration=1"}, 2,
                  "--set: a.h5 is a recording; only a scene can be changed");
}

TEST_F(BadRecordingTest, a_recording_whose_scene_gives_another_model_now_is_refused) {
  const io::Scene scene = io::parse_scene(k_shaken, "s.toml");
  std::string other = k_shaken;
  other.replace(other.find("mass = "), 0, "shelves = 1\n");
  {
    const topple::Run run(scene.setup);
    io::Recorder recorder("a.h5", scene.name, other, scene.setup.model);
    io::Observer observer;
    recorder.write(observer.observe(run));
    recorder.finish("completed", "{}");
  }
  const std::string part = "the scene in the recording gives another model";
  expect_one_line({"render", "a.h5", "--still", "a.png", "--at", "0"}, 2, part);
  expect_one_line({"render", "a.h5", "--mp4", "a.mp4"}, 2, part);
  expect_one_line({"view", "a.h5", "-o", "b.h5"}, 2, part);
  expect_one_line({"export", "a.h5", "--csv", "data"}, 2, part);
  expect_one_line({"export", "a.h5", "--xdmf", "a.xdmf"}, 2, part);
  EXPECT_FALSE(std::filesystem::exists("a.xdmf.h5"));
  EXPECT_FALSE(std::filesystem::exists("a.png"));
  EXPECT_FALSE(std::filesystem::exists("a.mp4"));
}

}  // namespace
}  // namespace topple::app
