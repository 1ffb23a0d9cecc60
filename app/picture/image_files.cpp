#include "app/picture/image_files.h"

#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "solver/io/host/process.h"

namespace topple::app {
namespace {

std::vector<std::string> ffmpeg_arguments(const std::filesystem::path& output, int width, int height,
                                          int rate) {
  // One thread and no version text or date in the file: the same bytes on every run.
  return {"-hide_banner",
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

void write_png(const host::Target& target, const render::Image& image) {
  const std::vector<std::uint8_t> bytes = render::encode_png(image);
  host::StagedFile file(target, host::FileKind::png);
  file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  file.commit();
}

struct VideoWriter::Child {
  explicit Child(const host::Target& target) : file(target, host::FileKind::mp4), errors("ffmpeg-errors") {}

  host::StagedFile file;
  host::MemoryFile errors;    // its error output: it can never block on it
  host::Descriptor pictures;  // to its standard input
  std::optional<host::Process> process;

  /// Closes the input and waits. Empty when ffmpeg is content, else why it is not.
  std::string end() {
    pictures.close();
    const host::Ended ended = process->wait();
    if (ended.good()) return {};
    const std::string line = host::last_line(errors.content());
    return "ffmpeg failed (" + in_words(ended) + ")" + (line.empty() ? "" : ": " + line);
  }
};

VideoWriter::VideoWriter(const host::Target& target, int width, int height, int frames_per_second)
    : path_(target.path.string()), width_(width), height_(height) {
  if (width <= 0 || height <= 0 || width % 2 != 0 || height % 2 != 0) {
    throw std::runtime_error("video of " + std::to_string(width) + " x " + std::to_string(height) +
                             " px: H.264 needs even sides");
  }
  if (frames_per_second < 1 || frames_per_second > 1000) {
    throw std::runtime_error("video with " + std::to_string(frames_per_second) +
                             " pictures a second is outside 1..1000");
  }
  child_ = std::make_unique<Child>(target);

  // A socket and not a pipe: a write to an ffmpeg that has gone is then an error of the call instead
  // of a SIGPIPE to the whole program.
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw std::runtime_error(path_ + ": no connection to ffmpeg: " + std::strerror(errno));
  }
  const host::Descriptor input(ends[0]);
  child_->pictures = host::Descriptor(ends[1]);
  try {
    child_->process.emplace("ffmpeg", ffmpeg_arguments(child_->file.part(), width, height, frames_per_second),
                            host::Streams{.input = input.get(), .errors = child_->errors.descriptor()});
  } catch (const std::system_error& error) {
    throw std::runtime_error(path_ + ": cannot write a video: " + error.what() +
                             "; install the Debian package ffmpeg");
  }
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const render::Image& image) {
  if (child_ == nullptr) throw std::runtime_error(path_ + ": the video has ended");
  if (image.width != width_ || image.height != height_) {
    throw std::runtime_error(path_ + ": a picture of " + std::to_string(image.width) + " x " +
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
      throw std::runtime_error(path_ + ": " + (why.empty() ? "ffmpeg stopped early" : why));
    }
  }
}

void VideoWriter::finish() {
  if (child_ == nullptr) return;
  if (const std::string why = child_->end(); !why.empty()) {
    child_.reset();
    throw std::runtime_error(path_ + ": " + why);
  }
  const std::unique_ptr<Child> done = std::move(child_);
  done->file.commit();
}

}  // namespace topple::app
