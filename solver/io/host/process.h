// Programs that are started, and what goes to and comes from them.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace topple::host {

/// A file descriptor that is closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { close(); }
  int get() const { return number_; }
  void close();

 private:
  int number_;
};

/// A stream of a child, in memory: neither side waits for the other, and none is hit by a broken pipe. Throws
/// std::system_error.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name);
  int descriptor() const { return file_.get(); }
  /// For a child to read from the start.
  void write(std::string_view text);
  std::string content() const;

 private:
  Descriptor file_;
};

/// The last line with words, without the blanks around it.
std::string last_line(std::string_view text);

/// How a process ended.
struct Ended {
  int code = 0;
  int signal = 0;  ///< that ended it; 0: none did
  bool good() const { return code == 0 && signal == 0; }
};
/// "exit status 3" or "signal 9".
std::string in_words(const Ended& ended);

inline constexpr int k_extra_stream = 3;  ///< number of Streams::extra in a child

/// Descriptors that become those of a child. -1: /dev/null, or nothing.
struct Streams {
  int input = -1, output = -1, errors = -1;
  int extra = -1;
};

/// A program at work in a process of its own, which is killed when its owner goes.
class Process {
 public:
  /// Looks for `program` in PATH unless it has a slash. `variables`: "NAME=VALUE", added to the environment.
  /// Throws std::system_error: "PROGRAM: No such file or directory".
  Process(const std::string& program, const std::vector<std::string>& arguments, const Streams& streams,
          const std::vector<std::string>& variables = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t number() const { return number_; }
  bool running() const { return running_; }
  void signal(int which);  ///< ignored when it has ended
  Ended wait();
  /// How it ended; nothing while it has not.
  std::optional<Ended> poll();

 private:
  std::optional<Ended> look(int options);

  pid_t number_ = -1;
  bool running_ = false;
  Ended ended_;
};

}  // namespace topple::host
