// Places that cannot be written to: refused before anything runs, with exit code 2.
#include "unit/app/program.h"
#include "unit/app/scenes.h"
#include "unit/app/small_disk.h"

namespace topple::app {
namespace {

constexpr const char* k_notes = "notes that nobody wants to lose\n";

class BadOutputTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
    ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
    before_ = files();
  }
  /// What has to do with one file.
  void expect_file_refused(const std::string& file, const std::string& part) {
    expect_one_line({"run", "s.toml", "-o", file}, 2, part);
    expect_one_line({"run", "s.toml", "--json", file}, 2, part);
    expect_one_line({"info", "a.h5", "--json", file}, 2, part);
    expect_one_line({"render", "a.h5", "--mp4", file}, 2, part);
    expect_one_line({"render", "a.h5", "--still", file, "--at", "0"}, 2, part);
    expect_one_line({"render", "s.toml", "--still", file, "--at", "0"}, 2, part);
  }
  void expect_folder_refused(const std::string& folder) {
    expect_one_line({"render", "a.h5", "--png", folder}, 2, folder + ": cannot be ");
    expect_one_line({"render", "s.toml", "--png", folder}, 2, folder + ": cannot be ");
    expect_one_line({"export", "a.h5", "--csv", folder}, 2, folder + ": cannot be ");
  }
  std::vector<std::string> before_;
};

TEST_F(BadOutputTest, a_missing_folder) {
  expect_file_refused("none/a", "none/a: cannot be written: there is no folder ");
  EXPECT_EQ(files(), before_);
}

TEST_F(BadOutputTest, a_file_in_the_way_of_a_folder) {
  expect_file_refused("s.toml/a", "s.toml/a: cannot be written: there is no folder ");
  expect_folder_refused("s.toml");
  expect_folder_refused("s.toml/folder");
  EXPECT_EQ(files(), before_);
}

TEST_F(BadOutputTest, a_folder_in_the_way_of_a_file) {
  std::filesystem::create_directory("folder");
  expect_file_refused("folder", "folder: cannot be written: is a folder");
  EXPECT_TRUE(std::filesystem::is_empty("folder"));
}

TEST_F(BadOutputTest, proc_where_even_root_makes_no_files) {
  expect_file_refused("/proc/a", "/proc/a: cannot be written: ");
  expect_folder_refused("/proc/a");
}

TEST_F(BadOutputTest, a_read_only_disk) {
  if (!mount_disk("disk", "64k", true)) GTEST_SKIP() << "may not mount a disk";
  expect_file_refused("disk/a", "disk/a: cannot be written: Read-only file system");
  expect_folder_refused("disk/folder");
  unmount_disk("disk");
}

TEST_F(BadOutputTest, a_device_is_not_replaced) {
  expect_one_line({"run", "s.toml", "-o", "/dev/null"}, 2,
                  "/dev/null: cannot be written: is not an ordinary");
  expect_one_line({"render", "a.h5", "--mp4", "/dev/null"}, 2, "/dev/null: cannot be written");
  expect_one_line({"render", "a.h5", "--still", "/dev/null", "--at", "0"}, 2, "/dev/null: cannot be written");
  EXPECT_EQ(topple({"run", "s.toml", "--json", "/dev/null"}).code, 0);  // text may go there
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(BadOutputTest, what_is_being_read_is_not_replaced) {
  const std::string scene = bytes_of("s.toml"), recording = bytes_of("a.h5");
  std::filesystem::create_symlink("s.toml", "link.toml");
  for (const char* name : {"s.toml", "./s.toml", "link.toml"}) {
    expect_one_line({"run", "s.toml", "-o", name}, 2, "is what is being read");
    expect_one_line({"run", "s.toml", "--json", name}, 2, "is what is being read");
    expect_one_line({"info", "s.toml", "--json", name}, 2, "is what is being read");
  }
  expect_one_line({"render", "a.h5", "--still", "a.h5", "--at", "0"}, 2, "is what is being read");
  expect_one_line({"render", "a.h5", "--mp4", "./a.h5"}, 2, "is what is being read");
  expect_one_line({"run", "s.toml", "-o", "b.h5", "--json", "./b.h5"}, 2, "is the recording");
  EXPECT_EQ(bytes_of("s.toml"), scene);
  EXPECT_EQ(bytes_of("a.h5"), recording);
}

TEST_F(BadOutputTest, a_file_of_another_kind_is_refused_also_through_a_link) {
  write_bytes("notes.txt", k_notes);
  std::filesystem::create_symlink("notes.txt", "link");
  for (const std::string name : {"notes.txt", "link"}) {
    const std::string found = name + ": holds text and is not replaced by ", how = " without --force\n";
    expect_one_line({"run", "s.toml", "-o", name}, 2, found + "HDF5 data" + how);
    expect_one_line({"run", "s.toml", "--json", name}, 2, found + "JSON" + how);
    expect_one_line({"render", "s.toml", "--still", name, "--at", "0"}, 2, found + "a PNG picture" + how);
    expect_one_line({"render", "a.h5", "--mp4", name}, 2, found + "an MP4 video" + how);
    expect_one_line({"info", "a.h5", "--json", name}, 2, found + "JSON" + how);
    expect_one_line({"export", "a.h5", "--xdmf", name}, 2, found + "an XDMF file" + how);
    expect_one_line({"report", "s.toml", "-o", name}, 2, found + "an HTML page" + how);
    expect_one_line({"view", "s.toml", "-o", name}, 2, found + "HDF5 data" + how);
  }
  EXPECT_EQ(bytes_of("notes.txt"), k_notes);
}

TEST_F(BadOutputTest, a_file_of_another_kind_in_a_folder_of_results_is_refused) {
  std::filesystem::create_directory("out");
  write_bytes("out/nodes.csv", k_notes);
  write_bytes("out/frame-000001.png", k_notes);
  write_bytes("out/frames.pvd", k_notes);
  write_bytes("out/elements.json", k_notes);
  write_bytes("out/overturn.rows", k_notes);
  const std::vector<std::string> before = files();
  const std::string found = ": holds text and is not replaced by ";
  expect_one_line({"export", "a.h5", "--csv", "out"}, 2, "out/nodes.csv" + found);
  expect_one_line({"export", "a.h5", "--vtk", "out"}, 2, "out/frames.pvd" + found);
  expect_one_line({"render", "a.h5", "--png", "out", "--size", "96x64"}, 2, "out/frame-000001.png" + found);
  expect_one_line({"study", "elements", "-o", "out"}, 2, "out/elements.json" + found);
  expect_one_line({"study", "overturn", "s.toml", "-o", "out", "--x", "shake.table.frequency=1..2:2", "--y",
                   "shake.table.amplitude=1..2:2"},
                  2, "out/overturn.rows" + found);
  EXPECT_EQ(bytes_of("out/overturn.rows"), k_notes);
  EXPECT_EQ(files(), before);
  EXPECT_EQ(topple({"export", "a.h5", "--csv", "out", "--force"}).code, 0);
  EXPECT_TRUE(bytes_of("out/nodes.csv").starts_with("time_s,"));
}

TEST_F(BadOutputTest, force_replaces_a_file_of_any_kind_and_a_link_stays_one) {
  write_bytes("notes.txt", k_notes);
  std::filesystem::create_symlink("notes.txt", "link");
  EXPECT_EQ(topple({"run", "s.toml", "-o", "link", "--force"}).code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink("link"));
  EXPECT_EQ(info("notes.txt")["status"], "completed");
  EXPECT_EQ(topple({"info", "a.h5", "--json", "notes.txt", "--force"}).code, 0);
  EXPECT_EQ(json_of(bytes_of("notes.txt"))["kind"], "recording");
  expect_one_line({"run", "s.toml", "--json", "s.toml", "--force"}, 2, "is what is being read");
}

TEST_F(BadOutputTest, records_of_the_scene_are_not_replaced) {
  const std::string samples = "time_s,ax_gal\n0,0\n0.01,1\n0.02,2\n0.03,1\n0.04,0\n";
  write_bytes("shake.csv", samples);
  write_bytes("r.toml", bytes_of("s.toml") + "[[shake]]\ntype = \"record\"\nfiles = [\"shake.csv\"]\n");
  expect_one_line({"run", "r.toml", "-o", "shake.csv"}, 2, "--output: shake.csv is a record of the scene");
  expect_one_line({"run", "r.toml", "--json", "./shake.csv"}, 2, "is a record of the scene");
  expect_one_line({"render", "r.toml", "--still", "shake.csv", "--at", "0"}, 2, "is a record of the scene");
  expect_one_line({"report", "r.toml", "-o", "shake.csv"}, 2, "is a record of the scene");
  EXPECT_EQ(bytes_of("shake.csv"), samples);
}

TEST_F(BadOutputTest, a_scene_cannot_be_drawn_without_a_place_for_its_recording) {
  const Circumstances nowhere{.set = {{"TMPDIR", "/proc/none"}}};
  expect_one_line({"render", "s.toml", "--still", "a.png", "--at", "0"}, 1, "TMPDIR", nowhere);
  EXPECT_EQ(files(), before_);
}

TEST_F(BadOutputTest, a_start_that_fails_leaves_an_older_recording_as_it_was) {
  const std::string older = bytes_of("a.h5");
  std::string unstable = k_shaken;
  unstable.replace(unstable.find("[floor]"), 7, "[[wall]]\nat = [-9, 0]\nnormal = [1, 0, 0]");
  write_bytes("falls.toml", unstable);
  EXPECT_EQ(topple({"run", "falls.toml", "-o", "a.h5"}).code, 1);
  EXPECT_EQ(bytes_of("a.h5"), older);
}

}  // namespace
}  // namespace topple::app
