// Pictures as files: written as they are, read back with a decoder that shares nothing with the writer.
#pragma once

#include <stb_image.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "render/output/image.h"

namespace topple::render {

inline void write_png(const std::filesystem::path& path, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

inline Image read_png(const std::filesystem::path& path) {
  Image image;
  int channels = 0;
  unsigned char* pixels = stbi_load(path.c_str(), &image.width, &image.height, &channels, 4);
  if (pixels == nullptr) throw std::runtime_error(path.string() + ": " + stbi_failure_reason());
  image.rgba.assign(
      pixels, pixels + 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  stbi_image_free(pixels);
  return image;
}

}  // namespace topple::render
