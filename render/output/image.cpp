#include "render/output/image.h"

#include <libdeflate.h>
#include <png.h>

#include <iterator>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace topple::render {
namespace {

/// Of libdeflate, 1 to 12: higher levels take longer and make these pictures little smaller.
constexpr int k_deflate_level = 2;

void append_number(std::vector<std::uint8_t>& bytes, std::uint32_t number) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

/// Length, type, data and checksum (PNG specification, 5.3).
void append_chunk(std::vector<std::uint8_t>& bytes, std::string_view type,
                  std::span<const std::uint8_t> data) {
  append_number(bytes, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = bytes.size();
  bytes.insert(bytes.end(), type.begin(), type.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  append_number(bytes, libdeflate_crc32(0, bytes.data() + begin, bytes.size() - begin));
}

/// Rows of differences from the pixel on the left, each behind the number of that filter. channels: of four.
std::vector<std::uint8_t> filtered(const Image& image, std::size_t channels) {
  constexpr std::uint8_t k_sub = 1;
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  std::vector<std::uint8_t> out(height * (1 + channels * width));
  std::uint8_t* to = out.data();
  for (std::size_t row = 0; row < height; ++row) {
    const std::uint8_t* from = image.rgba.data() + 4 * width * row;
    *to++ = k_sub;
    for (std::size_t c = 0; c < channels; ++c) *to++ = from[c];
    for (std::size_t i = 1; i < width; ++i)
      for (std::size_t c = 0; c < channels; ++c)
        *to++ = static_cast<std::uint8_t>(from[4 * i + c] - from[4 * (i - 1) + c]);
  }
  return out;
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(k_deflate_level), libdeflate_free_compressor);
  if (compressor == nullptr) throw std::bad_alloc();
  std::vector<std::uint8_t> out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
  return out;
}

bool is_opaque(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
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
  constexpr std::uint8_t k_signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::uint8_t k_perceptual = 0;  // intent of the sRGB colours
  const bool opaque = is_opaque(image);
  std::vector<std::uint8_t> header, bytes(std::begin(k_signature), std::end(k_signature));
  for (const int side : {image.width, image.height}) append_number(header, static_cast<std::uint32_t>(side));
  for (const int of : {8, opaque ? 2 : 6, 0, 0, 0})  // bits, RGB or RGBA, deflate, filters, not interlaced
    header.push_back(static_cast<std::uint8_t>(of));
  append_chunk(bytes, "IHDR", header);
  append_chunk(bytes, "sRGB", {&k_perceptual, 1});
  append_chunk(bytes, "IDAT", deflated(filtered(image, opaque ? 3 : 4)));
  append_chunk(bytes, "IEND", {});
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
