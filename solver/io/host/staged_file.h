// Files that appear whole or not at all.
#pragma once

#include <sys/types.h>

#include <concepts>
#include <filesystem>
#include <string>
#include <string_view>

#include "solver/io/host/errors.h"
#include "solver/io/host/file_kind.h"

namespace topple::host {

/// Where a file goes.
struct Target {
  // NOLINTNEXTLINE(google-explicit-constructor): a path is one
  template <std::convertible_to<std::filesystem::path> Path>
  Target(const Path& to, bool anyway = false) : path(to), force(anyway) {}

  std::filesystem::path path;
  bool force;  ///< in place of a file of any kind
};

/// Where `path` leads: links are followed, also one that leads to no file yet.
std::filesystem::path behind_links(const std::filesystem::path& path);

/// Throws FileError unless nothing or an ordinary file that may be written is there, behind links; Refusal
/// when it is of another kind than `kind` and the target does not force it. An empty file is of every kind.
void expect_replaceable(const Target& target, FileKind kind);

/// A file under a name of its own beside the target, which gets the target's name at the end. A link stays a
/// link: the file that it leads to is looked at and replaced. What was not committed is gone with its owner.
/// Two that write to one target do not meet; the one that commits last is there in the end.
class StagedFile {
 public:
  /// Begins an empty file. Throws as expect_replaceable(), and FileError when it cannot be made.
  StagedFile(const Target& target, FileKind kind);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// The target as it was named.
  const std::filesystem::path& path() const { return target_.path; }
  /// Where to write: "PATH.part-PID-NUMBER".
  const std::filesystem::path& part() const { return part_; }
  /// Puts `content` there, all of it. Throws FileError.
  void write(std::string_view content) const;
  /// Gives the written and closed file its name, in place of an older one. Throws as expect_replaceable(),
  /// and FileError when it cannot be named.
  void commit();
  bool committed() const { return committed_; }

 private:
  const Target target_;
  const FileKind kind_;
  const std::filesystem::path place_;  ///< behind links
  std::filesystem::path part_;
  bool committed_ = false;
};

/// A folder that appears with all that is in it, as a file does. It replaces nothing but an empty folder.
class StagedFolder {
 public:
  explicit StagedFolder(std::filesystem::path path);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& part() const { return part_; }
  void commit();

 private:
  const std::filesystem::path path_;
  std::filesystem::path part_;
  bool committed_ = false;
};

/// Removes what a process that is gone was writing for `path`.
void remove_parts(const std::filesystem::path& path, pid_t process);

}  // namespace topple::host
