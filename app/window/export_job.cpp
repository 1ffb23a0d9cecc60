#include "app/window/export_job.h"

#include <fcntl.h>
#include <pty.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
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

constexpr int k_looks = 200;  // times 10 ms, with a process that was asked to end

}  // namespace

// Its standard error is a terminal, so that it tells its progress ten times a second.
ExportJob::ExportJob(const std::string& program, const std::vector<std::string>& arguments,
                     std::string result, std::string partial)
    : result_(std::move(result)), partial_(std::move(partial)) {
  int other = -1;
  if (openpty(&terminal_, &other, nullptr, nullptr, nullptr) != 0)
    throw std::runtime_error(std::string("no terminal for the export: ") + std::strerror(errno));
  fcntl(terminal_, F_SETFL, O_NONBLOCK);
  fcntl(terminal_, F_SETFD, FD_CLOEXEC);
  fcntl(other, F_SETFD, FD_CLOEXEC);
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, other, STDERR_FILENO);
  const int failed = posix_spawn(&process_, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(other);
  if (failed != 0) {
    process_ = -1;
    ::close(terminal_);
    throw std::runtime_error(program + ": " + std::strerror(failed));
  }
  was_ = process_;
}

ExportJob::~ExportJob() {
  cancel();
  for (int i = 0; i < k_looks && !done(); ++i) {
    update();
    if (!done()) usleep(10000);
  }
  if (!done()) {
    kill(process_, SIGKILL);
    int status = 0;
    waitpid(process_, &status, 0);
    end(status);
  }
  ::close(terminal_);
}

void ExportJob::cancel() {
  if (done() || cancelled_) return;
  cancelled_ = true;
  kill(process_, SIGINT);
}

bool ExportJob::update() {
  if (done()) return false;
  const std::string before = line_;
  int status = 0;
  const bool ended = waitpid(process_, &status, WNOHANG) == process_;
  read_lines();
  if (ended) end(status);
  return ended || line_ != before;
}

void ExportJob::read_lines() {
  char bytes[4096];
  for (ssize_t n = 0; (n = read(terminal_, bytes, sizeof bytes)) > 0;)
    unread_.append(bytes, static_cast<std::size_t>(n));
  for (std::size_t end = 0; (end = unread_.find_first_of("\r\n")) != std::string::npos;
       unread_.erase(0, end + 1))
    take_line(unread_.substr(0, end));
  // A bar has no end of its line until it is drawn again.
  if (unread_.ends_with("left")) take_line(unread_);
}

void ExportJob::take_line(const std::string& line) {
  const std::size_t bar = line.rfind("] ");
  double now = 0, all = 0;
  if (bar != std::string::npos && std::sscanf(line.c_str() + bar + 2, "%lf of %lf", &now, &all) == 2 &&
      all > 0) {
    part_ = now / all;
    line_ = line.substr(bar + 2);
  } else if (const std::size_t said = line.find("topple: "); said != std::string::npos) {
    last_words_ = line.substr(said + std::strlen("topple: "));
  }
}

void ExportJob::end(int status) {
  process_ = -1;
  const bool good = WIFEXITED(status) && WEXITSTATUS(status) == k_done;
  if (good && !partial_.empty()) {
    std::error_code error;
    fs::rename(partial_, result_, error);
    if (error) failure_ = result_ + ": cannot be written: " + error.message();
  } else if (!good) {
    failure_ = !last_words_.empty()  ? last_words_
               : WIFSIGNALED(status) ? std::string("ended by signal ") + strsignal(WTERMSIG(status))
                                     : "ended with code " + std::to_string(WEXITSTATUS(status));
  }
  if (!failure_.empty()) remove_partial();
}

void ExportJob::remove_partial() {
  std::error_code ignored;
  if (!partial_.empty())
    fs::remove_all(partial_, ignored);
  else
    fs::remove(result_ + ".part" + std::to_string(was_), ignored);
}

}  // namespace topple::app
