#include "solver/study/common/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace topple::study {
namespace {

/// A stream of the child, in memory: neither side waits for the other, and none is hit by a broken pipe.
class MemoryFile {
 public:
  MemoryFile() : file_(memfd_create("gnuplot", MFD_CLOEXEC)) {
    if (file_ < 0) throw ChartError(std::string("no memory for a chart: ") + std::strerror(errno));
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void write(const std::string& text) {
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t now = ::write(file_, text.data() + sent, text.size() - sent);
      if (now < 0 && errno != EINTR)
        throw ChartError(std::string("no memory for a chart: ") + std::strerror(errno));
      if (now > 0) sent += static_cast<std::size_t>(now);
    }
    lseek(file_, 0, SEEK_SET);
  }
  std::string content() const {
    std::string text(static_cast<std::size_t>(std::max<off_t>(lseek(file_, 0, SEEK_END), 0)), '\0');
    const ssize_t read = pread(file_, text.data(), text.size(), 0);
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(read, 0)));
    return text;
  }
  int descriptor() const { return file_; }

 private:
  int file_;
};

/// The line that says what is wrong: gnuplot's last that is not empty.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  const std::size_t begin = text.find_last_of('\n');
  text = text.substr(begin == std::string::npos ? 0 : begin + 1);
  return text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
}

int wait_for_end(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

std::string run_gnuplot(const std::string& script) {
  MemoryFile input, output, errors;
  input.write(script);
  std::string name = "gnuplot", own_settings = "-d";
  char* argv[] = {name.data(), own_settings.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.descriptor(), STDERR_FILENO);
  pid_t process = -1;
  const int failed = posix_spawnp(&process, name.c_str(), &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0)
    throw ChartError(std::string("gnuplot: ") + std::strerror(failed) +
                     "; charts need the Debian package gnuplot-nox");
  const int status = wait_for_end(process);
  std::string chart = output.content();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !chart.empty()) return chart;
  const std::string line = last_line(errors.content());
  throw ChartError("gnuplot failed (" +
                   (WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status))
                                        : "exit status " + std::to_string(WEXITSTATUS(status))) +
                   ")" + (line.empty() ? "" : ": " + line));
}

std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    switch (c) {
      case '\n':
      case '\r':
        quoted += ' ';
        break;
      case '"':
        quoted += "\\042";
        break;
      case '\\':
        quoted += "\\134";
        break;
      case '`':
        quoted += "\\140";
        break;  // a command to run
      default:
        quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace topple::study
