#include "solver/io/host/process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace topple::host {
namespace {

std::system_error failure(int code, const std::string& what) {
  return {code, std::generic_category(), what};
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> list;
  list.reserve(words.size() + 1);
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  return list;
}

/// What happens to the descriptors of a child before it starts.
class Actions {
 public:
  Actions() { posix_spawn_file_actions_init(&list_); }
  ~Actions() { posix_spawn_file_actions_destroy(&list_); }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  void stream(int from, int to, int mode) {
    if (from >= 0)
      posix_spawn_file_actions_adddup2(&list_, from, to);
    else
      posix_spawn_file_actions_addopen(&list_, to, "/dev/null", mode, 0);
  }
  const posix_spawn_file_actions_t* list() const { return &list_; }

 private:
  posix_spawn_file_actions_t list_;
};

}  // namespace

void Descriptor::close() {
  if (number_ >= 0) ::close(std::exchange(number_, -1));
}

MemoryFile::MemoryFile(const char* name) : file_(memfd_create(name, MFD_CLOEXEC)) {
  if (file_.get() < 0) throw failure(errno, std::string("memory for ") + name);
}

void MemoryFile::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t now = ::write(descriptor(), text.data(), text.size());
    if (now < 0 && errno != EINTR) throw failure(errno, "memory for a stream");
    if (now > 0) text.remove_prefix(static_cast<std::size_t>(now));
  }
  lseek(descriptor(), 0, SEEK_SET);
}

std::string MemoryFile::content() const {
  struct stat status {};
  std::string text(fstat(descriptor(), &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0, '\0');
  std::size_t had = 0;
  while (had < text.size()) {
    const ssize_t now = pread(descriptor(), text.data() + had, text.size() - had, static_cast<off_t>(had));
    if (now == 0 || (now < 0 && errno != EINTR)) break;
    if (now > 0) had += static_cast<std::size_t>(now);
  }
  text.resize(had);
  return text;
}

std::string last_line(std::string_view text) {
  constexpr std::string_view k_blanks = " \t\r\n";
  const std::size_t end = text.find_last_not_of(k_blanks);
  if (end == std::string_view::npos) return {};
  text = text.substr(0, end + 1);
  const std::size_t before = text.find_last_of("\r\n");
  if (before != std::string_view::npos) text.remove_prefix(before + 1);
  return std::string(text.substr(text.find_first_not_of(k_blanks)));
}

std::string in_words(const Ended& ended) {
  return ended.signal != 0 ? "signal " + std::to_string(ended.signal)
                           : "exit status " + std::to_string(ended.code);
}

Process::Process(const std::string& program, const std::vector<std::string>& arguments,
                 const Streams& streams, const std::vector<std::string>& variables) {
  std::vector<std::string> words{program}, surroundings = variables;
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> list = pointers(surroundings);
  list.pop_back();
  for (char** one = environ; *one; ++one) list.push_back(*one);
  list.push_back(nullptr);
  Actions actions;
  actions.stream(streams.input, STDIN_FILENO, O_RDONLY);
  actions.stream(streams.output, STDOUT_FILENO, O_WRONLY);
  actions.stream(streams.errors, STDERR_FILENO, O_WRONLY);
  if (streams.extra >= 0)
    actions.stream(streams.extra, k_extra_stream, O_WRONLY);  // last: others may stand there
  const int failed =
      posix_spawnp(&number_, program.c_str(), actions.list(), nullptr, pointers(words).data(), list.data());
  if (failed != 0) throw failure(failed, program);
  running_ = true;
}

Process::~Process() {
  signal(SIGKILL);
  wait();
}

void Process::signal(int which) {
  if (running_) kill(number_, which);
}

Ended Process::wait() {
  while (running_ && !look(0)) {
  }
  return ended_;
}

std::optional<Ended> Process::poll() {
  return running_ ? look(WNOHANG) : ended_;
}

std::optional<Ended> Process::look(int options) {
  int status = 0;
  const pid_t found = waitpid(number_, &status, options);
  if (found == 0 || (found < 0 && errno == EINTR)) return std::nullopt;
  running_ = false;
  if (found < 0)
    ended_ = {.code = 1};  // somebody else has waited for it
  else if (WIFSIGNALED(status))
    ended_ = {.signal = WTERMSIG(status)};
  else
    ended_ = {.code = WEXITSTATUS(status)};
  return ended_;
}

}  // namespace topple::host
