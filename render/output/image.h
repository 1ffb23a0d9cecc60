// Pictures in memory, and as the bytes of PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace topple::render {

/// Rows from top to bottom, four bytes (red, green, blue, alpha; sRGB) a pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< 4 * width * height bytes

  bool operator==(const Image&) const = default;
};

/// The PNG file's bytes; the same image gives the same bytes. Alpha is left out when all of it is
/// opaque. Throws std::runtime_error on an image without pixels or whose size does not fit its bytes.
std::vector<std::uint8_t> encode_png(const Image& image);

/// Reads a PNG file; nothing when there is none that can be read.
std::optional<Image> load_png(const std::filesystem::path& path);

}  // namespace topple::render
