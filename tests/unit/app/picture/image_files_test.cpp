#include "app/picture/image_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "tests/unit/render/scratch.h"

namespace topple::app {
namespace {

using render::file_bytes;
using render::Scratch;

render::Image flat(int width, int height, std::uint8_t grey) {
  return {width, height, std::vector<std::uint8_t>(4 * static_cast<std::size_t>(width * height), grey)};
}

void write_video(const std::filesystem::path& path) {
  VideoWriter video(path, 64, 48, 25);
  for (int i = 0; i < 12; ++i) video.write(flat(64, 48, static_cast<std::uint8_t>(20 * i)));
  video.finish();
}

std::string error_of(auto action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

/// Another PATH while it lives.
class WithPath {
 public:
  explicit WithPath(const std::string& path) : old_(std::getenv("PATH")) { setenv("PATH", path.c_str(), 1); }
  ~WithPath() { setenv("PATH", old_.c_str(), 1); }
  WithPath(const WithPath&) = delete;
  WithPath& operator=(const WithPath&) = delete;

 private:
  std::string old_;
};

TEST(Png, a_file_holds_the_bytes_of_the_picture) {
  const Scratch scratch;
  write_png(scratch / "a.png", flat(8, 6, 90));
  const std::vector<std::uint8_t> bytes = render::encode_png(flat(8, 6, 90));
  EXPECT_EQ(file_bytes(scratch / "a.png"), std::string(bytes.begin(), bytes.end()));
}

TEST(Png, error_names_path_and_reason_and_leaves_nothing_behind) {
  const Scratch scratch;
  const std::string error = error_of([&] { write_png(scratch / "no-such-folder/a.png", flat(3, 3, 90)); });
  EXPECT_NE(error.find("no-such-folder/a.png"), std::string::npos) << error;
  EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
}

TEST(Video, same_pictures_give_the_same_file) {
  const Scratch scratch;
  write_video(scratch / "a.mp4");
  write_video(scratch / "b.mp4");
  const std::string bytes = file_bytes(scratch / "a.mp4");
  EXPECT_GT(bytes.size(), 500u);
  EXPECT_EQ(bytes.substr(4, 4), "ftyp");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));  // plays before it is loaded
  EXPECT_TRUE(bytes == file_bytes(scratch / "b.mp4"));
}

TEST(Video, missing_ffmpeg_names_the_package) {
  const Scratch scratch;
  const WithPath nothing(scratch.path().string());
  const std::string error = error_of([&] { VideoWriter(scratch / "a.mp4", 64, 48, 25); });
  EXPECT_NE(error.find("install the Debian package ffmpeg"), std::string::npos) << error;
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
}

TEST(Video, existing_file_is_kept_until_the_new_one_is_whole) {
  const Scratch scratch;
  std::ofstream(scratch / "a.mp4") << "....ftypold";
  {
    VideoWriter video(scratch / "a.mp4", 64, 48, 25);
    video.write(flat(64, 48, 9));
  }
  EXPECT_EQ(file_bytes(scratch / "a.mp4"), "....ftypold");
  write_video(scratch / "a.mp4");
  EXPECT_EQ(file_bytes(scratch / "a.mp4").substr(4, 4), "ftyp");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 1);
}

TEST(Video, ffmpeg_that_fails_is_reported_with_its_last_line) {
  const Scratch scratch;
  {
    std::ofstream script(scratch / "ffmpeg");
    script << "#!/bin/sh\necho first >&2\necho 'no room for this' >&2\nexit 3\n";
  }
  std::filesystem::permissions(scratch / "ffmpeg", std::filesystem::perms::owner_all);
  const WithPath broken(scratch.path().string());
  const std::string error = error_of([&] {
    VideoWriter video(scratch / "a.mp4", 640, 480, 25);
    for (int i = 0; i < 50; ++i) video.write(flat(640, 480, 9));  // until the socket says that it has gone
    video.finish();
  });
  EXPECT_NE(error.find("exit status 3): no room for this"), std::string::npos) << error;
}

TEST(Video, folder_that_does_not_exist_is_reported) {
  const Scratch scratch;
  const std::string error = error_of([&] { write_video(scratch / "no-such-folder/a.mp4"); });
  EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
}

TEST(Video, sizes_and_rates_are_checked) {
  const Scratch scratch;
  EXPECT_NE(error_of([&] { VideoWriter(scratch / "a.mp4", 63, 48, 25); }).find("even"), std::string::npos);
  EXPECT_NE(error_of([&] { VideoWriter(scratch / "a.mp4", 64, 48, 0); }).find("1..1000"), std::string::npos);
  VideoWriter video(scratch / "a.mp4", 64, 48, 25);
  EXPECT_NE(error_of([&] { video.write(flat(32, 48, 9)); }).find("32 x 48"), std::string::npos);
}

}  // namespace
}  // namespace topple::app
