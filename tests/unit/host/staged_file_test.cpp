#include "solver/io/host/staged_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <set>

#include "tests/unit/render/scratch.h"

namespace topple::host {
namespace {

using render::file_bytes;
using render::Scratch;

constexpr const char* k_text = "notes that nobody wants to lose\n";

std::string error_of(auto action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

void write(const Target& target, FileKind kind, std::string_view content) {
  StagedFile file(target, kind);
  file.write(content);
  file.commit();
}

std::ptrdiff_t files_in(const Scratch& scratch) {
  return std::distance(std::filesystem::directory_iterator(scratch.path()), {});
}

TEST(StagedFiles, an_older_file_is_there_until_the_new_one_is_whole) {
  const Scratch scratch;
  const std::filesystem::path path = scratch / "a.json";
  write(path, FileKind::json, "{}");
  {
    StagedFile file(path, FileKind::json);
    file.write("{1}");
    EXPECT_EQ(file_bytes(path), "{}");
  }
  EXPECT_EQ(file_bytes(path), "{}");
  EXPECT_EQ(files_in(scratch), 1);
  write(path, FileKind::json, "{2}");
  EXPECT_EQ(file_bytes(path), "{2}");
  EXPECT_EQ(files_in(scratch), 1);
}

TEST(StagedFiles, two_writers_of_one_target_do_not_meet) {
  const Scratch scratch;
  const std::filesystem::path path = scratch / "a.json";
  {
    StagedFile one(path, FileKind::json), other(path, FileKind::json);
    EXPECT_NE(one.part(), other.part());
    one.write("{1}");
    other.write("{2}");
    one.commit();
    EXPECT_EQ(file_bytes(path), "{1}");
    other.commit();
  }
  EXPECT_EQ(file_bytes(path), "{2}");
  EXPECT_EQ(files_in(scratch), 1);
}

TEST(StagedFiles, what_a_dead_process_left_is_not_written_to) {
  const Scratch scratch;
  const std::filesystem::path path = scratch / "a.json";
  std::filesystem::path next;
  {
    const StagedFile file(path, FileKind::json);
    const std::string name = file.part().string();
    const std::size_t number = name.rfind('-') + 1;
    next = name.substr(0, number) + std::to_string(std::stoi(name.substr(number)) + 1);
  }
  std::ofstream(next) << "left";
  write(path, FileKind::json, "{}");
  EXPECT_EQ(file_bytes(next), "left");
}

TEST(StagedFiles, the_parts_of_a_dead_process_can_be_removed) {
  const Scratch scratch;
  const pid_t child = fork();
  if (child == 0) {
    new StagedFile(scratch / "a.json", FileKind::json);
    new StagedFolder(scratch / "a.json");
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  const StagedFile own(scratch / "a.json", FileKind::json), others(scratch / "b.json", FileKind::json);
  EXPECT_EQ(files_in(scratch), 4);
  remove_parts(scratch / "a.json", child);
  EXPECT_EQ(files_in(scratch), 2);
  EXPECT_TRUE(std::filesystem::exists(own.part()));
}

TEST(StagedFiles, a_new_file_has_the_permissions_of_any) {
  const Scratch scratch;
  std::ofstream(scratch / "usual") << "{}";
  write(scratch / "a.json", FileKind::json, "{}");
  EXPECT_EQ(std::filesystem::status(scratch / "a.json").permissions(),
            std::filesystem::status(scratch / "usual").permissions());
}

TEST(StagedFiles, a_file_of_another_kind_is_not_replaced_unasked) {
  const Scratch scratch;
  const std::filesystem::path path = scratch / "notes.txt";
  std::ofstream(path) << k_text;
  EXPECT_THROW(StagedFile(path, FileKind::hdf5), Refusal);
  EXPECT_EQ(error_of([&] { StagedFile(path, FileKind::hdf5); }),
            path.string() + ": holds text and is not replaced by HDF5 data without --force");
  EXPECT_EQ(file_bytes(path), k_text);
  EXPECT_EQ(files_in(scratch), 1);
  write({path, true}, FileKind::json, "{}");
  EXPECT_EQ(file_bytes(path), "{}");
}

TEST(StagedFiles, a_file_of_another_kind_that_came_meanwhile_is_not_replaced) {
  const Scratch scratch;
  const std::filesystem::path path = scratch / "a.json";
  {
    StagedFile file(path, FileKind::json);
    file.write("{}");
    std::ofstream(path) << k_text;
    EXPECT_THROW(file.commit(), Refusal);
  }
  EXPECT_EQ(file_bytes(path), k_text);
  EXPECT_EQ(files_in(scratch), 1);
}

TEST(StagedFiles, an_empty_file_is_of_every_kind) {
  const Scratch scratch;
  std::ofstream(scratch / "a").close();
  EXPECT_EQ(error_of([&] { write(scratch / "a", FileKind::json, "{}"); }), "");
}

TEST(StagedFiles, what_a_link_leads_to_is_looked_at_and_replaced) {
  const Scratch scratch;
  std::ofstream(scratch / "notes.txt") << k_text;
  std::filesystem::create_symlink("notes.txt", scratch / "link");
  EXPECT_THROW(write(scratch / "link", FileKind::json, "{}"), Refusal);
  EXPECT_EQ(file_bytes(scratch / "notes.txt"), k_text);
  write({scratch / "link", true}, FileKind::json, "{}");
  EXPECT_TRUE(std::filesystem::is_symlink(scratch / "link"));
  EXPECT_EQ(file_bytes(scratch / "notes.txt"), "{}");
}

TEST(StagedFiles, a_link_to_no_file_yet_is_followed) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch / "folder");
  std::filesystem::create_symlink("folder/a.json", scratch / "link");
  write(scratch / "link", FileKind::json, "{}");
  EXPECT_TRUE(std::filesystem::is_symlink(scratch / "link"));
  EXPECT_EQ(file_bytes(scratch / "folder/a.json"), "{}");
}

TEST(StagedFiles, folders_and_devices_are_not_replaced_even_by_force) {
  const Scratch scratch;
  const std::string folder = scratch.path().string();
  EXPECT_EQ(error_of([&] {
              StagedFile({folder, true}, FileKind::json);
            }),
            folder + ": cannot be written: is a folder");
  EXPECT_EQ(error_of([&] {
              StagedFile({"/dev/null", true}, FileKind::json);
            }),
            "/dev/null: cannot be written: is not an ordinary file");
}

TEST(StagedFolders, a_folder_appears_with_what_is_in_it) {
  const Scratch scratch;
  {
    StagedFolder dropped(scratch / "folder");
    std::ofstream(dropped.part() / "a") << "a";
    StagedFolder folder(scratch / "folder");
    std::ofstream(folder.part() / "b") << "b";
    EXPECT_FALSE(std::filesystem::exists(scratch / "folder"));
    folder.commit();
  }
  EXPECT_EQ(file_bytes(scratch / "folder/b"), "b");
  EXPECT_EQ(files_in(scratch), 1);
}

TEST(StagedFolders, a_folder_with_something_in_it_is_not_replaced) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch / "folder");
  std::ofstream(scratch / "folder/a") << "a";
  {
    StagedFolder folder(scratch / "folder");
    EXPECT_THROW(folder.commit(), FileError);
  }
  EXPECT_EQ(file_bytes(scratch / "folder/a"), "a");
  EXPECT_EQ(files_in(scratch), 1);
}

}  // namespace
}  // namespace topple::host
