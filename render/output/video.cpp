#include "render/output/video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace topple::render {
namespace {

class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~FileDescriptor() { close(); }
  int get() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

/// Last line with words of what the child wrote to its error output.
std::string last_line(int file) {
  std::string text;
  std::array<char, 4096> block;
  off_t at = 0;
  for (ssize_t got; (got = pread(file, block.data(), block.size(), at)) > 0; at += got) {
    text.append(block.data(), static_cast<std::size_t>(got));
  }
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.pop_back();
  const std::size_t line = text.find_last_of("\r\n");
  return line == std::string::npos ? text : text.substr(line + 1);
}

std::vector<std::string> ffmpeg_arguments(const std::filesystem::path& output, int width, int height,
                                          int rate) {
  // One thread and no version text or date in the file: the same bytes on every run.
  return {"ffmpeg",
          "-hide_banner",
          "-nostdin",
          "-xerror",  // or a trailer that a full disk swallows passes for success
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgba",
          "-video_size",
          std::to_string(width) + "x" + std::to_string(height),
          "-framerate",
          std::to_string(rate),
          "-i",
          "pipe:0",
          "-an",
          "-c:v",
          "libx264",
          "-preset",
          "veryfast",
          "-crf",
          "20",
          "-vf",
          "scale=out_color_matrix=bt709:out_range=tv",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-pix_fmt",
          "yuv420p",
          "-threads",
          "1",
          "-fflags",
          "+bitexact",
          "-flags:v",
          "+bitexact",
          "-map_metadata",
          "-1",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "file:" + output.string()};
}

}  // namespace

struct VideoWriter::Child {
  pid_t process = -1;
  FileDescriptor pictures;  // to its standard input
  FileDescriptor errors;    // its error output, in memory: it can never block on it
  std::filesystem::path partial;

  ~Child() {
    pictures.close();
    if (process > 0) {
      kill(process, SIGTERM);
      wait_for_end();
    }
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
  }

  int wait_for_end() {
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    process = -1;
    return status;
  }

  /// Closes the input and waits. Empty when ffmpeg is content, else why it is not.
  std::string end() {
    pictures.close();
    const int status = wait_for_end();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    const std::string line = last_line(errors.get());
    return "ffmpeg failed (" +
           (WIFEXITED(status) ? "exit status " + std::to_string(WEXITSTATUS(status))
                              : "signal " + std::to_string(WTERMSIG(status))) +
           ")" + (line.empty() ? "" : ": " + line);
  }
};

VideoWriter::VideoWriter(std::filesystem::path path, int width, int height, int frames_per_second)
    : path_(std::move(path)), width_(width), height_(height), child_(std::make_unique<Child>()) {
  if (width <= 0 || height <= 0 || width % 2 != 0 || height % 2 != 0) {
    throw std::runtime_error("video of " + std::to_string(width) + " x " + std::to_string(height) +
                             " px: H.264 needs even sides");
  }
  if (frames_per_second < 1 || frames_per_second > 1000) {
    throw std::runtime_error("video with " + std::to_string(frames_per_second) +
                             " pictures a second is outside 1..1000");
  }
  child_->partial = path_;
  child_->partial += ".part" + std::to_string(getpid());

  // A socket and not a pipe: a write to an ffmpeg that has gone is then an error of the call instead
  // of a SIGPIPE to the whole program.
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw std::runtime_error(path_.string() + ": no connection to ffmpeg: " + std::strerror(errno));
  }
  FileDescriptor child_input(ends[0]);
  child_->pictures = FileDescriptor(ends[1]);
  child_->errors = FileDescriptor(memfd_create("ffmpeg-errors", MFD_CLOEXEC));

  std::vector<std::string> arguments = ffmpeg_arguments(child_->partial, width, height, frames_per_second);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, child_input.get(), STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, child_->errors.get(), STDERR_FILENO);
  const int failed = posix_spawnp(&child_->process, "ffmpeg", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    child_->process = -1;
    throw std::runtime_error(path_.string() + ": cannot write a video: ffmpeg: " + std::strerror(failed) +
                             "; install the Debian package ffmpeg");
  }
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const Image& image) {
  if (child_ == nullptr) throw std::runtime_error(path_.string() + ": the video has ended");
  if (image.width != width_ || image.height != height_) {
    throw std::runtime_error(path_.string() + ": a picture of " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " px in a video of " + std::to_string(width_) +
                             " x " + std::to_string(height_));
  }
  std::size_t sent = 0;
  while (sent < image.rgba.size()) {
    const ssize_t now =
        send(child_->pictures.get(), image.rgba.data() + sent, image.rgba.size() - sent, MSG_NOSIGNAL);
    if (now > 0) {
      sent += static_cast<std::size_t>(now);
    } else if (errno != EINTR) {
      const std::string why = child_->end();
      child_.reset();
      throw std::runtime_error(path_.string() + ": " + (why.empty() ? "ffmpeg stopped early" : why));
    }
  }
}

void VideoWriter::finish() {
  if (child_ == nullptr) return;
  if (const std::string why = child_->end(); !why.empty()) {
    child_.reset();
    throw std::runtime_error(path_.string() + ": " + why);
  }
  std::error_code error;
  std::filesystem::rename(child_->partial, path_, error);
  child_.reset();
  if (error) throw std::runtime_error(path_.string() + ": cannot write the video: " + error.message());
}

}  // namespace topple::render
