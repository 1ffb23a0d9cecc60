#include "app/support/foreign_recording.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <vector>

namespace topple::app {
namespace {

namespace fs = std::filesystem;

enum Outcome { k_read = 0, k_refused = 2, k_too_much_memory = 3 };

constexpr rlim_t k_least_memory = rlim_t{1} << 30, k_memory_per_byte = 4;
constexpr rlim_t k_least_time = 10, k_bytes_per_second = 10'000'000;
constexpr rlim_t k_most_words = 4096;  // bytes of its answer

struct Limits {
  rlim_t memory, seconds;
};

Limits limits_for(const std::string& path) {
  std::error_code unknown;
  const std::uintmax_t size = fs::file_size(path, unknown);
  const rlim_t bytes = unknown ? 0 : size;
  return {.memory = k_least_memory + k_memory_per_byte * bytes,
          .seconds = k_least_time + bytes / k_bytes_per_second};
}

void limit(int resource, rlim_t most) {
  rlimit bound{};
  getrlimit(resource, &bound);
  bound.rlim_cur = bound.rlim_max = std::min(most, bound.rlim_max);
  setrlimit(resource, &bound);
}

void limit_this_process(const Limits& limits) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these reserve terabytes
  limit(RLIMIT_AS, limits.memory);
#endif
  limit(RLIMIT_CPU, limits.seconds);
  limit(RLIMIT_FSIZE, k_most_words);
  limit(RLIMIT_CORE, 0);
}

/// Whether it throws no InputError that came of too little memory: the owner of the file would have more.
template <typename Read>
bool within_memory(std::int64_t count, Read read) {
  for (std::int64_t i = 0; i < count; ++i) {
    errno = 0;
    try {
      read(i);
    } catch (const io::InputError&) {
      if (errno == ENOMEM) return false;
    }
  }
  return true;
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return number_; }

 private:
  int number_;
};

/// Starts the process with `answer` as its standard output and waits for it. Its wait status.
int run_apart(const std::string& program, const std::string& path, int answer) {
  std::string words[] = {program, std::string(k_read_apart), path};
  char* argv[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, answer, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = -1;
  const int failed = posix_spawn(&process, program.c_str(), &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error(program + ": " + std::strerror(failed));
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) throw std::runtime_error(std::string("a started process: ") + std::strerror(errno));
  return status;
}

std::string answer_in(int file) {
  std::string text(k_most_words, '\0');
  const ssize_t length = pread(file, text.data(), text.size(), 0);
  text.resize(length < 0 ? 0 : static_cast<std::size_t>(length));
  return text;
}

std::string how_it_ended(int status, const Limits& limits) {
  if (!WIFSIGNALED(status)) {
    return WEXITSTATUS(status) == k_too_much_memory
               ? fmt::format("it asks for more than {} MiB of memory", limits.memory >> 20)
               : fmt::format("reading it ended with exit code {}", WEXITSTATUS(status));
  }
  switch (const int signal = WTERMSIG(status)) {
    case SIGXCPU:
    case SIGKILL:
      return fmt::format("it takes more than {} s of processor time", limits.seconds);
    case SIGINT:
    case SIGTERM:
      return "interrupted";
    default:
      return fmt::format("it brings the HDF5 library to a crash ({})", strsignal(signal));
  }
}

}  // namespace

io::Recording open_foreign_recording(const std::string& path, const std::string& program) {
  const Descriptor answer(memfd_create("answer", MFD_CLOEXEC));
  if (answer < 0) throw std::runtime_error(std::string("memfd_create: ") + std::strerror(errno));
  const int status = run_apart(program, path, answer);
  if (WIFEXITED(status) && WEXITSTATUS(status) == k_read) return io::Recording(path);
  if (WIFEXITED(status) && WEXITSTATUS(status) == k_refused) throw io::InputError(answer_in(answer));
  throw io::InputError(fmt::format("{}: cannot read: {}", path, how_it_ended(status, limits_for(path))));
}

int read_apart(const std::string& path) {
  limit_this_process(limits_for(path));
  try {
    errno = 0;
    const io::Recording recording(path);
    return within_memory(recording.frame_count(), [&](std::int64_t i) { recording.frame(i); }) &&
                   within_memory(recording.checkpoint_count(),
                                 [&](std::int64_t i) { recording.checkpoint(i); })
               ? k_read
               : k_too_much_memory;
  } catch (const io::InputError& error) {
    if (errno == ENOMEM) return k_too_much_memory;
    const std::string_view words = error.what();
    return ::write(STDOUT_FILENO, words.data(), std::min<std::size_t>(words.size(), k_most_words)) < 0
               ? 1
               : k_refused;
  } catch (const std::bad_alloc&) {
    return k_too_much_memory;
  } catch (const std::length_error&) {  // of a vector that no memory could hold
    return k_too_much_memory;
  }
}

}  // namespace topple::app
