// Pictures and videos as files.
#pragma once

#include <memory>
#include <string>

#include "render/output/image.h"
#include "solver/io/host/staged_file.h"

namespace topple::app {

/// Writes a PNG file, which appears whole or not at all. Throws host::FileError.
void write_png(const host::Target& target, const render::Image& image);

/// Writes pictures of one size as an H.264 MP4 file, encoded by the program ffmpeg. The same pictures give
/// the same bytes. The file appears under its name only after finish() (staged_file.h): an existing one is
/// kept until then, and when writing fails or the writer is destroyed early.
class VideoWriter {
 public:
  /// Starts ffmpeg. width, height: px, even. frames_per_second: 1 to 1000. Throws std::runtime_error:
  /// on sizes and rates that will not do, when ffmpeg is not installed, when the folder cannot be
  /// written to.
  VideoWriter(const host::Target& target, int width, int height, int frames_per_second);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Adds a picture. Throws std::runtime_error on another size, or with ffmpeg's last line when it
  /// has stopped.
  void write(const render::Image& image);

  /// Waits for ffmpeg and puts the file in its place. Throws std::runtime_error with ffmpeg's last
  /// line when it failed.
  void finish();

 private:
  struct Child;
  std::string path_;  // as it was named
  int width_;
  int height_;
  std::unique_ptr<Child> child_;  // null when it has ended
};

}  // namespace topple::app
