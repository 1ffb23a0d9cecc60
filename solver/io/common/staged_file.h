// Files that appear whole or not at all.
#pragma once

#include <filesystem>

namespace topple::io {

/// A place for a file and a name beside it under which the file is written first. What was not published is
/// gone with its owner.
class StagedFile {
 public:
  explicit StagedFile(const std::filesystem::path& path) : path_(path), part_(path.string() + ".part") {}
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Where to write: "PATH.part".
  const std::filesystem::path& part() const { return part_; }
  /// Gives the written and closed file its name, in place of an older one. Throws WriteError (errors.h).
  void publish();

 private:
  std::filesystem::path path_, part_;
  bool published_ = false;
};

}  // namespace topple::io
