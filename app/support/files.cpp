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

void require_writable_file(const std::string& option, const host::Target& target, host::FileKind kind,
                           const std::string& source) {
  const std::string path = target.path.string();
  if (path.empty()) throw BadInput(option + ": the name is empty");
  if (same_file(path, source))
    throw BadInput(option + ": " + path + " is what is being read; choose another name");
  try {
    host::expect_replaceable(target, kind);
  } catch (const host::FileError& error) {
    throw BadInput(error.what());
  }
  require_writable_folder(host::behind_links(path).parent_path().string(), path);
}

void require_writable_text(const std::string& option, const host::Target& target, host::FileKind kind,
                           const std::string& source) {
  if (!is_special(target.path)) require_writable_file(option, target, kind, source);
}

void require_no_record(const std::string& option, const std::string& path, const std::string& source,
                       const io::Scene& scene) {
  for (const io::SceneFile& file : scene.files)
    if (same_file(path, (fs::path(source).parent_path() / file.name).string()))
      throw BadInput(option + ": " + path + " is a record of the scene; choose another name");
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) ||
         (!a.empty() && !b.empty() && host::behind_links(a) == host::behind_links(b));
}

void write_whole_file(const host::Target& target, host::FileKind kind, const std::string& content) {
  if (!is_special(target.path)) {
    host::StagedFile file(target, kind);
    file.write(content);
    return file.commit();
  }
  std::FILE* const file = std::fopen(target.path.c_str(), "wb");
  bool good = file && std::fwrite(content.data(), 1, content.size(), file) == content.size();
  int cause = errno;
  if (file && std::fclose(file) != 0 && good) good = false, cause = errno;
  if (!good) throw host::FileError(target.path.string() + ": cannot be written: " + std::strerror(cause));
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
