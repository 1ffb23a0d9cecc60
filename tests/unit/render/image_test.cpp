#include "render/output/image.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/render/read_png.h"
#include "tests/unit/render/scratch.h"

namespace topple::render {
namespace {

Image pattern(int width, int height, bool opaque) {
  Image image{width, height, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < width * height; ++i) {
    for (int channel = 0; channel < 4; ++channel) {
      state = state * 1664525u + 1013904223u;
      image.rgba.push_back(channel == 3 && opaque ? 255 : static_cast<std::uint8_t>(state >> 24));
    }
  }
  return image;
}

TEST(Png, another_decoder_reads_what_was_written) {
  const Scratch scratch;
  for (const bool opaque : {true, false}) {
    for (const int width : {1, 7, 64}) {
      const Image image = pattern(width, 13, opaque);
      write_png(scratch / "a.png", image);
      EXPECT_EQ(read_png(scratch / "a.png"), image) << "width " << width << " opaque " << opaque;
    }
  }
}

TEST(Png, same_image_gives_same_bytes) {
  EXPECT_EQ(encode_png(pattern(33, 21, true)), encode_png(pattern(33, 21, true)));
}

TEST(Png, image_without_pixels_is_refused) {
  EXPECT_THROW(encode_png(Image{}), std::runtime_error);
  EXPECT_THROW(encode_png(Image{4, 4, {1, 2, 3}}), std::runtime_error);
}

}  // namespace
}  // namespace topple::render
