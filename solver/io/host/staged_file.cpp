#include "solver/io/host/staged_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace topple::host {
namespace {

namespace fs = std::filesystem;

constexpr int k_most_links = 40;

[[noreturn]] void fail(const fs::path& path, const std::string& cause) {
  throw FileError(path.string() + ": cannot be written: " + cause);
}

std::string part_names(const fs::path& path, pid_t process) {
  return path.string() + ".part-" + std::to_string(process) + "-";
}

/// `make`: makes what does not exist yet, or sets errno. The name under which it did.
template <typename Make>
fs::path make_part(const fs::path& shown, const fs::path& place, Make make) {
  static std::atomic<unsigned> number = 0;
  for (;;) {
    const std::string name = part_names(place, getpid()) + std::to_string(number++);
    if (make(name.c_str())) return name;
    if (errno != EEXIST) fail(shown, std::strerror(errno));
  }
}

bool make_file(const char* name) {
  const int file = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  return file >= 0 && close(file) == 0;
}

bool make_folder(const char* name) {
  return mkdir(name, 0777) == 0;
}

void give_name(const fs::path& part, const fs::path& place, const fs::path& shown) {
  if (std::rename(part.c_str(), place.c_str()) != 0) fail(shown, std::strerror(errno));
}

}  // namespace

fs::path behind_links(const fs::path& path) {
  std::error_code error;
  fs::path at = fs::absolute(path, error);
  for (int i = 0; i < k_most_links && fs::is_symlink(at, error); ++i) {
    const fs::path next = fs::read_symlink(at, error);
    if (error) return path;
    at = at.parent_path() / next;
  }
  const fs::path real = fs::weakly_canonical(at, error);
  return error ? path : real;
}

void expect_replaceable(const Target& target, FileKind kind) {
  std::error_code ignored;
  const fs::path& path = target.path;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status)) fail(path, "is a folder");
  if (!fs::is_regular_file(status)) fail(path, "is not an ordinary file");
  if (access(path.c_str(), W_OK) != 0) fail(path, std::strerror(errno));
  if (target.force || kind == FileKind::any) return;
  const FileKind found = kind_of(path);
  if (found != FileKind::any && found != kind)
    throw Refusal(path.string() + ": holds " + std::string(in_words(found)) + " and is not replaced by " +
                  std::string(in_words(kind)) + " without --force");
}

StagedFile::StagedFile(const Target& target, FileKind kind)
    : target_(target), kind_(kind), place_(behind_links(target.path)) {
  expect_replaceable(target_, kind_);
  part_ = make_part(path(), place_, make_file);
}

StagedFile::~StagedFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(part_, ignored);
}

void StagedFile::write(std::string_view content) const {
  std::FILE* const file = std::fopen(part_.c_str(), "wb");
  if (!file) fail(path(), std::strerror(errno));
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  const int cause = errno;
  const bool closed = std::fclose(file) == 0;
  if (!written) fail(path(), std::strerror(cause));
  if (!closed) fail(path(), std::strerror(errno));
}

void StagedFile::commit() {
  expect_replaceable(target_, kind_);
  give_name(part_, place_, path());
  committed_ = true;
}

StagedFolder::StagedFolder(fs::path path)
    : path_(std::move(path)), part_(make_part(path_, behind_links(path_), make_folder)) {}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(part_, ignored);
}

void StagedFolder::commit() {
  give_name(part_, behind_links(path_), path_);
  committed_ = true;
}

void remove_parts(const fs::path& path, pid_t process) {
  const std::string names = part_names(behind_links(path), process);
  std::error_code error;
  for (fs::directory_iterator it(fs::path(names).parent_path(), error), end; !error && it != end;
       it.increment(error)) {
    std::error_code ignored;
    if (it->path().string().starts_with(names)) fs::remove_all(it->path(), ignored);
  }
}

}  // namespace topple::host
