#include "app/support/foreign_recording.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "solver/io/host/process.h"

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

std::string how_it_ended(const host::Ended& ended, const Limits& limits) {
  if (ended.signal == 0) {
    return ended.code == k_too_much_memory
               ? fmt::format("it asks for more than {} MiB of memory", limits.memory >> 20)
               : fmt::format("reading it ended with exit code {}", ended.code);
  }
  switch (ended.signal) {
    case SIGXCPU:
    case SIGKILL:
      return fmt::format("it takes more than {} s of processor time", limits.seconds);
    case SIGINT:
    case SIGTERM:
      return "interrupted";
    default:
      return fmt::format("it brings the HDF5 library to a crash ({})", strsignal(ended.signal));
  }
}

}  // namespace

io::Recording open_foreign_recording(const std::string& path, const std::string& program) {
  const host::MemoryFile answer("answer");
  host::Process process(program, {std::string(k_read_apart), path}, {.output = answer.descriptor()});
  const host::Ended ended = process.wait();
  if (ended.good()) return io::Recording(path);
  if (ended.signal == 0 && ended.code == k_refused)
    throw io::InputError(answer.content().substr(0, k_most_words));
  throw io::InputError(fmt::format("{}: cannot read: {}", path, how_it_ended(ended, limits_for(path))));
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
