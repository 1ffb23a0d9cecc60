#include "app/picture/drawing_processes.h"

#include <malloc.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "app/support/interrupt.h"
#include "solver/io/host/process.h"

namespace topple::app {
namespace {

constexpr int k_most_processes = 8;  // some 100 MB each
constexpr int k_worth_it = 8;        // pictures a process: to open one takes about as long as to draw two

/// Before each answer, and before what an exception said.
struct Header {
  std::int64_t size;
  bool failed;
};

void send(int to, const void* bytes, std::size_t size) {
  for (const char* from = static_cast<const char*>(bytes); size > 0;) {
    const ssize_t sent = write(to, from, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) _exit(1);  // nobody listens
    from += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void send_answer(int to, const void* bytes, std::size_t size, bool failed) {
  const Header header{static_cast<std::int64_t>(size), failed};
  send(to, &header, sizeof header);
  send(to, bytes, size);
}

/// What one of the processes does: every `step`-th picture.
[[noreturn]] void draw_some(int first, int step, int count, const std::function<DrawPicture()>& open,
                            int to) {
  try {
    const DrawPicture draw = open();
    for (int i = first; i < count; i += step) {
      const std::vector<std::uint8_t> answer = draw(i);
      send_answer(to, answer.data(), answer.size(), false);
    }
  } catch (const std::exception& error) {
    const std::string what = error.what();
    send_answer(to, what.data(), what.size(), true);
  }
  _exit(0);  // what the parent has open is the parent's to close
}

/// Reaps them; those that still draw end with the picture that they are at, so that no file is half written.
/// Forked, and not programs as those of host::Process: they go on with what `open` holds in memory (scene,
/// rows, settings), which no command line could name, and must not be killed in the middle of a file.
class Processes {
 public:
  Processes() = default;
  ~Processes() {
    for (Process& process : all_) process.from.close();
    for (const Process& process : all_)
      while (waitpid(process.id, nullptr, 0) < 0 && errno == EINTR) {
      }
  }
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  void start(int number, int step, int count, const std::function<DrawPicture()>& open) {
    int ends[2];
    if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "drawing: pipe");
    host::Descriptor from(ends[0]);
    const host::Descriptor to(ends[1]);
    const pid_t parent = getpid(), id = fork();
    if (id < 0) throw std::system_error(errno, std::generic_category(), "drawing: fork");
    if (id == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(1);
      for (Process& other : all_) other.from.close();
      from.close();
      draw_some(number, step, count, open, to.get());
    }
    all_.push_back({id, std::move(from)});
  }

  /// False: interrupted.
  bool receive(int number, std::vector<std::uint8_t>& answer) {
    const int from = all_[static_cast<std::size_t>(number) % all_.size()].from.get();
    Header header;
    if (!read_all(from, &header, sizeof header)) return false;
    answer.resize(static_cast<std::size_t>(header.size));
    if (!read_all(from, answer.data(), answer.size())) return false;
    if (header.failed) throw std::runtime_error(std::string(answer.begin(), answer.end()));
    return true;
  }

 private:
  struct Process {
    pid_t id;
    host::Descriptor from;
  };

  static bool read_all(int from, void* bytes, std::size_t size) {
    for (char* to = static_cast<char*>(bytes); size > 0;) {
      if (interrupted()) return false;
      const ssize_t got = read(from, to, size);
      if (got < 0 && errno == EINTR) continue;
      if (interrupted()) return false;  // as the processes that draw are
      if (got <= 0) throw std::runtime_error("drawing: a process that draws was killed");
      to += got;
      size -= static_cast<std::size_t>(got);
    }
    return true;
  }

  std::vector<Process> all_;
};

// What pictures take up stays the process's: to get it anew from the kernel takes longer than to read a
// picture.
void keep_memory() {
  constexpr int most_mapped = 32 << 20, most_kept = 1 << 30;  // bytes; no more can be set
  mallopt(M_MMAP_THRESHOLD, most_mapped);
  mallopt(M_TRIM_THRESHOLD, most_kept);
}

}  // namespace

void draw_pictures(int count, const std::function<DrawPicture()>& open,
                   const std::function<void(int, std::vector<std::uint8_t>)>& take) {
  keep_memory();
  const int cores = static_cast<int>(std::thread::hardware_concurrency()),
            wanted = std::min({cores, k_most_processes, count / k_worth_it});
  if (wanted < 2) {
    const DrawPicture draw = open();
    for (int i = 0; i < count && !interrupted(); ++i) take(i, draw(i));
    return;
  }
  Processes processes;
  for (int k = 0; k < wanted; ++k) processes.start(k, wanted, count, open);
  std::vector<std::uint8_t> answer;
  for (int i = 0; i < count && processes.receive(i, answer); ++i) take(i, std::move(answer));
}

}  // namespace topple::app
