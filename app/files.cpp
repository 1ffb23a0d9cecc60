#include "app/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "app/commands.h"

namespace topple::app {

void require_writable_folder(const std::string& folder, const std::string& what) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error))
    throw BadInput(what + ": cannot be written: there is no folder " + folder);
  // Asking for permission is not enough (read-only mounts, full quotas): try.
  std::string probe = folder + "/.topple-XXXXXX";
  const int file = mkstemp(probe.data());
  if (file < 0) throw BadInput(what + ": cannot be written: " + std::strerror(errno));
  close(file);
  unlink(probe.c_str());
}

void write_whole_file(const std::string& path, const std::string& content) {
  const std::string part = path + ".part-" + std::to_string(getpid());
  std::FILE* file = std::fopen(part.c_str(), "wb");
  bool good = file && std::fwrite(content.data(), 1, content.size(), file) == content.size();
  if (file && std::fclose(file) != 0) good = false;
  if (good && std::rename(part.c_str(), path.c_str()) == 0) return;
  const std::string cause = std::strerror(errno);
  std::remove(part.c_str());
  throw std::runtime_error(path + ": cannot be written: " + cause);
}

}  // namespace topple::app
