#include "app/support/files.h"

#include "app/support/errors.h"
#include "unit/app/program.h"

namespace topple::app {
namespace {

class FilesTest : public ProgramTest {};

TEST_F(FilesTest, a_file_is_written_whole_and_replaces_an_older_one) {
  write_whole_file("a.json", host::FileKind::any, "one");
  write_whole_file("a.json", host::FileKind::any, "two");
  EXPECT_EQ(bytes_of("a.json"), "two");
  EXPECT_EQ(files(), std::vector<std::string>{"a.json"});
}

TEST_F(FilesTest, a_link_stays_a_link) {
  write_bytes("target", "one");
  std::filesystem::create_symlink("target", "link");
  write_whole_file("link", host::FileKind::any, "two");
  EXPECT_TRUE(std::filesystem::is_symlink("link"));
  EXPECT_EQ(bytes_of("target"), "two");
}

TEST_F(FilesTest, a_failure_names_the_file_and_leaves_nothing) {
  try {
    write_whole_file("none/a.json", host::FileKind::any, "one");
    FAIL() << "written into a folder that does not exist";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "none/a.json: cannot be written: No such file or directory");
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(FilesTest, trying_a_folder_leaves_nothing_in_it) {
  std::filesystem::create_directory("folder");
  EXPECT_NO_THROW(require_writable_folder("folder", "folder/a"));
  EXPECT_TRUE(std::filesystem::is_empty("folder"));
  EXPECT_THROW(require_writable_folder("none", "none/a"), BadInput);
}

TEST_F(FilesTest, one_file_is_known_under_all_its_names) {
  write_bytes("a", "");
  std::filesystem::create_symlink("a", "link");
  std::filesystem::create_hard_link("a", "other");
  for (const char* name : {"a", "./a", "link", "other"}) EXPECT_TRUE(same_file("a", name)) << name;
  EXPECT_TRUE(same_file("new", "./new"));
  EXPECT_TRUE(same_file("new", std::filesystem::absolute("new").string()));
  EXPECT_FALSE(same_file("a", "new"));
  EXPECT_FALSE(same_file("", ""));
}

}  // namespace
}  // namespace topple::app
