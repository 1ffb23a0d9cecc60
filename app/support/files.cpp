#include "app/support/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "app/support/errors.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

bool is_special(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// Where a new content goes: a link stays a link, its target is replaced.
fs::path behind_links(const std::string& path) {
  std::error_code error;
  const fs::path full = fs::absolute(path, error);
  const fs::path real = error ? full : fs::weakly_canonical(full, error);
  return error ? fs::path(path) : real;
}

}  // namespace

void require_writable_folder(const std::string& folder, const std::string& what) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw BadInput(what + ": cannot be written: there is no folder " + folder);
  // Asking for permission is not enough (read-only mounts, full quotas): try.
  std::string probe = folder + "/.topple-XXXXXX";
  const int file = mkstemp(probe.data());
  if (file < 0) throw BadInput(what + ": cannot be written: " + std::strerror(errno));
  close(file);
  unlink(probe.c_str());
}

void require_writable_file(const std::string& option, const std::string& path, const std::string& source) {
  if (path.empty()) throw BadInput(option + ": the name is empty");
  std::error_code error;
  if (fs::is_directory(path, error)) throw BadInput(path + ": cannot be written: is a folder");
  if (is_special(path)) throw BadInput(path + ": cannot be written: is not an ordinary file");
  if (same_file(path, source))
    throw BadInput(option + ": " + path + " is what is being read; choose another name");
  const fs::path target = behind_links(path);
  require_writable_folder(fs::absolute(target).parent_path().string(), path);
  if (fs::exists(target, error) && access(target.c_str(), W_OK) != 0)
    throw BadInput(path + ": cannot be written: " + std::strerror(errno));
}

void require_writable_text(const std::string& option, const std::string& path, const std::string& source) {
  if (!is_special(path)) require_writable_file(option, path, source);
}

void require_no_record(const std::string& option, const std::string& path, const std::string& source,
                       const io::Scene& scene) {
  for (const io::SceneFile& file : scene.files)
    if (same_file(path, (fs::path(source).parent_path() / file.name).string()))
      throw BadInput(option + ": " + path + " is a record of the scene; choose another name");
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) || (!a.empty() && !b.empty() && behind_links(a) == behind_links(b));
}

void write_whole_file(const std::string& path, const std::string& content) {
  const bool special = is_special(path);
  const std::string target = special ? path : behind_links(path).string();
  const std::string part = special ? path : target + ".part-" + std::to_string(getpid());
  std::FILE* file = std::fopen(part.c_str(), "wb");
  bool good = file && std::fwrite(content.data(), 1, content.size(), file) == content.size();
  int cause = errno;
  if (file && std::fclose(file) != 0 && good) good = false, cause = errno;
  if (good && (special || std::rename(part.c_str(), target.c_str()) == 0)) return;
  if (good) cause = errno;
  if (!special) std::remove(part.c_str());
  throw std::runtime_error(path + ": cannot be written: " + std::strerror(cause));
}

TemporaryFile::TemporaryFile() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error) throw std::runtime_error("TMPDIR is no folder; a scene is recorded there before it is drawn");
  path_ = (folder / "topple-XXXXXX").string();
  const int file = mkstemp(path_.data());
  if (file < 0) throw std::runtime_error(path_ + ": cannot be created: " + std::strerror(errno));
  close(file);
}

TemporaryFile::~TemporaryFile() {
  unlink(path_.c_str());
}

}  // namespace topple::app
