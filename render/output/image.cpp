#include "render/output/image.h"

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace topple::render {
namespace {

/// Level 3 with the SUB filter: a third of the default's time for nearly its size.
constexpr int k_zlib_level = 3;

struct Sink {
  std::vector<std::uint8_t>* bytes;
  char error[128];
};

void on_write(png_structp png, png_bytep data, png_size_t size) {
  auto* sink = static_cast<Sink*>(png_get_io_ptr(png));
  sink->bytes->insert(sink->bytes->end(), data, data + size);
}

void on_flush(png_structp) {}

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto* sink = static_cast<Sink*>(png_get_error_ptr(png));
  std::snprintf(sink->error, sizeof sink->error, "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

/// Everything between setjmp and a jump lives in the caller: no destructor may be jumped over.
bool encode_rows(png_structp png, png_infop info, Sink& sink, int width, int height,
                 const std::vector<std::uint8_t>& pixels, int channels) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, &sink, on_write, on_flush);
  png_set_compression_level(png, k_zlib_level);
  png_set_filter(png, 0, PNG_FILTER_SUB);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               channels == 4 ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  const std::size_t stride = static_cast<std::size_t>(channels) * static_cast<std::size_t>(width);
  for (int row = 0; row < height; ++row) {
    png_write_row(png, pixels.data() + stride * static_cast<std::size_t>(row));
  }
  png_write_end(png, nullptr);
  return true;
}

bool is_opaque(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

std::vector<std::uint8_t> without_alpha(const Image& image) {
  std::vector<std::uint8_t> rgb(image.rgba.size() / 4 * 3);
  for (std::size_t i = 0, j = 0; i < image.rgba.size(); i += 4, j += 3) {
    std::memcpy(rgb.data() + j, image.rgba.data() + i, 3);
  }
  return rgb;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
  if (image.width <= 0 || image.height <= 0 ||
      image.rgba.size() !=
          4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    throw std::runtime_error("picture of " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " pixels with " +
                             std::to_string(image.rgba.size()) + " bytes cannot be a PNG");
  }
  const bool opaque = is_opaque(image);
  const std::vector<std::uint8_t> rgb = opaque ? without_alpha(image) : std::vector<std::uint8_t>();
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.rgba.size() / 8);
  Sink sink{&bytes, {}};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, on_error, on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const bool done = info != nullptr && encode_rows(png, info, sink, image.width, image.height,
                                                   opaque ? rgb : image.rgba, opaque ? 3 : 4);
  if (png != nullptr) png_destroy_write_struct(&png, &info);
  if (!done) throw std::runtime_error(std::string("libpng: ") + sink.error);
  return bytes;
}

std::optional<Image> load_png(const std::filesystem::path& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&png, path.c_str())) return std::nullopt;
  png.format = PNG_FORMAT_RGBA;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.rgba.resize(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr)) return std::nullopt;
  return image;
}

}  // namespace topple::render
