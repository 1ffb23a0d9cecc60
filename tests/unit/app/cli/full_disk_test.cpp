// Disks that fill up: exit code 1, one line, nothing half-written, and what was recorded before can be read.
#include "unit/app/program.h"
#include "unit/app/scenes.h"
#include "unit/app/small_disk.h"

namespace topple::app {
namespace {

class FullDiskTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
    ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
  }
  static void expect_readable(const std::string& recording) {
    const auto what = info(recording);
    EXPECT_EQ(what["status"], "interrupted");
    EXPECT_GT(what["frames"], 0);
    EXPECT_LT(what["recorded_s"], 9.0);
    EXPECT_EQ(topple({"export", recording, "--csv", "data"}).code, 0);
  }
  const std::vector<std::string> long_run_{
      "run", "s.toml", "--set", "run.duration=10", "--set", "run.output_rate=1000", "-o"};
};

TEST_F(FullDiskTest, a_recording_that_may_not_grow_keeps_what_it_has) {
  std::vector<std::string> call = long_run_;
  call.push_back("b.h5");
  expect_one_line(call, 1, "b.h5: cannot write the recording: File too large; it can be read up to ",
                  {.most_bytes = 400'000});
  expect_readable("b.h5");
}

TEST_F(FullDiskTest, a_recording_on_a_full_disk_keeps_what_it_has) {
  if (!mount_disk("disk", "400k")) GTEST_SKIP() << "may not mount a disk";
  std::vector<std::string> call = long_run_;
  call.push_back("disk/b.h5");
  expect_one_line(call, 1,
                  "disk/b.h5: cannot write the recording: No space left on device; it can be read up");
  expect_readable("disk/b.h5");
  unmount_disk("disk");
}

TEST_F(FullDiskTest, a_recording_that_cannot_be_begun_leaves_nothing) {
  expect_one_line({"run", "s.toml", "-o", "b.h5"}, 1, "b.h5: cannot write the recording: File too large",
                  {.most_bytes = 3000});
  EXPECT_FALSE(std::filesystem::exists("b.h5"));
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(FullDiskTest, pictures_appear_whole_or_not_at_all) {
  const Circumstances full{.most_bytes = 2000};
  expect_one_line({"render", "a.h5", "--still", "a.png", "--at", "0", "--size", "320x180"}, 1,
                  "a.png: cannot be written: File too large", full);
  EXPECT_FALSE(std::filesystem::exists("a.png"));
  expect_one_line({"render", "a.h5", "--png", "pictures", "--size", "320x180"}, 1,
                  ".png: cannot be written: ", full);
  EXPECT_TRUE(std::filesystem::is_empty("pictures"));
  EXPECT_EQ(files().size(), 3u);
}

TEST_F(FullDiskTest, a_video_appears_whole_or_not_at_all) {
  expect_one_line({"render", "a.h5", "--mp4", "a.mp4", "--size", "320x180", "--quiet"}, 1,
                  "a.mp4: ", {.most_bytes = 2000});
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(FullDiskTest, tables_appear_whole_or_not_at_all) {
  expect_one_line({"export", "a.h5", "--csv", "data"}, 1, ".csv: cannot be written: File too large",
                  {.most_bytes = 2000});
  EXPECT_TRUE(std::filesystem::is_empty("data"));
}

TEST_F(FullDiskTest, frames_for_vtk_appear_all_or_not_at_all) {
  expect_one_line({"export", "a.h5", "--vtk", "data"}, 1,
                  "data/frame-000000.vtp: cannot be written: File too large", {.most_bytes = 2000});
  EXPECT_TRUE(std::filesystem::is_empty("data"));
}

TEST_F(FullDiskTest, files_for_paraview_appear_whole_or_not_at_all) {
  const std::vector<std::string> before = files();
  for (const rlim_t bytes : {1000, 20'000, 100'000})
    expect_one_line({"export", "a.h5", "--xdmf", "a.xdmf"}, 1, "a.xdmf.h5: cannot be written: File too large",
                    {.most_bytes = bytes});
  EXPECT_EQ(files(), before);
  if (!mount_disk("disk", "100k")) GTEST_SKIP() << "may not mount a disk";
  expect_one_line({"export", "a.h5", "--xdmf", "disk/a.xdmf"}, 1,
                  "disk/a.xdmf.h5: cannot be written: No space left on device");
  EXPECT_TRUE(std::filesystem::is_empty("disk"));
  unmount_disk("disk");
}

TEST_F(FullDiskTest, a_summary_appears_whole_or_not_at_all) {
  const Ended ended =
      topple({"run", "chair", "--set", "run.duration=\"0.1 s\"", "--json", "b.json"}, {.most_bytes = 300});
  EXPECT_EQ(ended.code, 1);
  EXPECT_EQ(ended.err, "topple: b.json: cannot be written: File too large\n");
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(FullDiskTest, results_that_standard_output_does_not_take_are_a_failure) {
  const std::string short_run = "run.duration=\"0.1 s\"";
  for (const std::vector<std::string>& call : {std::vector<std::string>{"run", "chair", "--set", short_run},
                                               {"run", "chair", "--set", short_run, "--json", "-"},
                                               {"info", "a.h5"},
                                               {"check", "cantilever"},
                                               {"scenes"},
                                               {"furniture"},
                                               {"--help"}})
    expect_one_line(call, 1, "No space left on device", {.output = "/dev/full"});
}

}  // namespace
}  // namespace topple::app
